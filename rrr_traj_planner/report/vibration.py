# Copyright 2026 rrr_traj_planner developers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Residual vibration of plans side by side: a table and a figure over frequency."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.trajectory.residual_vibration import DAMPING, residual_vibration
from rrr_traj_planner.report import drawing
from rrr_traj_planner.report.attempts import Planned
from rrr_traj_planner.report.picture import Picture
from rrr_traj_planner.report.tables import Table
from rrr_traj_planner.report.theme import DASHES, SERIES

TEXT = (f'What a flexible mode of {100.0 * DAMPING:g} % damping keeps after the end of the '
        'motion: its largest deflection, as the acceleration that would bend it as far. The '
        "largest of the three joints'.")

IN_TABLE = (8.0, 16.0, 24.0, 32.0, 48.0, 64.0)  # Hz

# The figure's frequencies [Hz], in equal ratios of 0.4 %, and how many of them on either side
# count: single frequencies would show lobes, which are narrower than a structure is known.
IN_FIGURE, BESIDE = np.geomspace(4.0, 100.0, 801), 12
FLOOR = 1e-5  # lower end of the figure, over the largest value


def vibration_of(of: Planned, frequencies: Sequence[float] | Array) -> Array:
    """
    Return the residual vibration of a plan.

    Parameters
    ----------
    of : Planned
        The plan.
    frequencies : sequence of float
        Of the modes [Hz], m of them.

    Returns
    -------
    ndarray, shape (m,)
        The largest of the joints' [rad/s^2].

    """
    return np.asarray(residual_vibration(
        of.plan.trajectory, of.moving_knots, frequencies).max(axis=1))


def vibration_table(plans: Sequence[Planned], name: str) -> Table:
    """
    Return the table of motion times and residual vibrations.

    Parameters
    ----------
    plans : sequence of Planned
        The plans.
    name : str
        See `Table`.

    Returns
    -------
    Table
        A row for each plan.

    """
    heads = ('planner', 'total time [s]', *(f'at {f:g} Hz [rad/s²]' for f in IN_TABLE))
    return Table(name, 'Time and residual vibration', '', heads, [
        [p.planner_id, f'{p.plan.trajectory.duration:.3f}',
         *(f'{value:.3g}' for value in vibration_of(p, IN_TABLE))] for p in plans])


def vibration_figure(plans: Sequence[Planned], name: str) -> Picture:
    """
    Return the figure of residual vibrations over frequency.

    Parameters
    ----------
    plans : sequence of Planned
        One or more.
    name : str
        See `Picture`.

    Returns
    -------
    Picture
        A line for each plan.

    """
    x, y = "mode's frequency [Hz]", 'residual vibration [rad/s²]'
    middle = IN_FIGURE[BESIDE:-BESIDE]
    curves = [sliding_window_view(vibration_of(p, IN_FIGURE), 2 * BESIDE + 1).max(axis=1)
              for p in plans]
    floor = FLOOR * max(float(curve.max()) for curve in curves) or FLOOR

    def draw(figure: Any) -> None:
        axes = drawing.stacked(figure, [y], x)[0]
        lines = [axes.loglog(middle, np.maximum(curve, floor), color=SERIES[i % len(SERIES)],
                             linestyle=DASHES[i % len(DASHES)], label=p.planner_id)[0]
                 for i, (p, curve) in enumerate(zip(plans, curves))]
        ticks = [f for f in (5.0, *IN_TABLE) if middle[0] <= f <= middle[-1]]
        axes.set_xticks(ticks, [f'{f:g}' for f in ticks])
        axes.minorticks_off()
        drawing.legend(figure, lines, 2)

    return Picture(
        name, 'Residual vibration over frequency',
        f'The largest of modes within {100.0 * (IN_FIGURE[BESIDE] / IN_FIGURE[0] - 1.0):.0f} % of '
        'a frequency.', draw, 3.0 + 0.17 * ((len(plans) + 1) // 2), {x: middle, **{
            f'{i} {p.planner_id}': curve for i, (p, curve) in enumerate(zip(plans, curves))}})
