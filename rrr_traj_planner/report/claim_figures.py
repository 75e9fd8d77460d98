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

"""Figures on the thesis's claims (6.5): excitation, and motion times relative to the least."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.trajectory.residual_vibration import residual_vibration
from rrr_traj_planner.report import drawing
from rrr_traj_planner.report.attempts import Planned
from rrr_traj_planner.report.excitation import (
    amplitude_spectrum,
    fraction_above,
    joint_acceleration,
)
from rrr_traj_planner.report.function_figures import FUNCTIONS
from rrr_traj_planner.report.picture import Picture
from rrr_traj_planner.report.tables import Table
from rrr_traj_planner.report.theme import DASHES, SERIES

FREQUENCIES = np.linspace(0.25, 10.0, 400)  # Hz, of the curves in the figures
MODES = np.linspace(3.0, 10.0, 281)         # Hz, frequencies of a joint's flexible mode
HIGH = 2.0                                  # Hz, above which energy counts as excitation
DURATION, CHANGE, POINTS = 2.0, 1.0, 4001   # s, rad/s, samples of the transition in the figures
FLOOR = 1e-6                                # lower end of the logarithmic axes

# Least times of any motion through the points of tables 6.1 and 6.3 [s], with limits of velocity
# and acceleration, and with jerk limits too; see docs/claims.md.
LIMIT_TIMES = {'velocity, acceleration': (2.015, 2.474), 'and jerk': (2.129, 2.581)}


class Excitation(NamedTuple):
    """Excitation of a flexible structure by a motion."""

    above: float      # fraction of the acceleration's energy above HIGH
    vibration: float  # largest residual vibration of a mode in MODES, relative to its deflection


def of_transitions() -> dict[str, Excitation]:
    """Return the excitation by each function's transition, of equal duration and change."""
    return {f.name: Excitation(fraction_above(*_transition(f), HIGH),
                               float(_vibration(f, MODES).max())) for f in FUNCTIONS}


def of_plan(of: Planned) -> Excitation:
    """
    Return the excitation of a whole motion.

    Parameters
    ----------
    of : Planned
        The motion.

    Returns
    -------
    Excitation
        The largest values of the three joints.

    """
    trajectory = of.plan.trajectory
    above = (fraction_above(*joint_acceleration(trajectory, joint), HIGH) for joint in range(3))
    vibration = residual_vibration(trajectory, trajectory.knots, MODES)
    return Excitation(max(above), float((vibration / of.plan.peaks.acceleration).max()))


def spectra() -> Picture:
    """Return the figure of the functions' spectra."""
    curves = {f.name: amplitude_spectrum(*_transition(f), FREQUENCIES) for f in FUNCTIONS}
    energies = ', '.join(f'{n} {1e6 * e.above:.0f}' for n, e in of_transitions().items())
    return _by_frequency(
        'claim_spectra', 'Spectrum of a transition of each function',
        f'Duration {DURATION:g} s, change {CHANGE:g} rad/s. Energy above {HIGH:g} Hz, in '
        f'millionths: {energies}.', curves, 'frequency [Hz]', 'acceleration [rad/s²/Hz]')


def vibrations() -> Picture:
    """Return the figure of a flexible mode's residual vibration."""
    curves = {f.name: _vibration(f, FREQUENCIES) for f in FUNCTIONS}
    return _by_frequency(
        'claim_vibrations', 'Residual vibration after a transition',
        'Of a flexible mode with 1 % damping, relative to its deflection under the largest '
        'acceleration.', curves, "mode's frequency [Hz]", 'vibration / deflection')


def claims_table(plans: list[tuple[Planned, Planned]]) -> Table:
    """
    Return the table of the methods' motion times, relative to the least, and their excitation.

    Parameters
    ----------
    plans : list of pairs of Planned
        Each method's plans for tables 6.1 and 6.3.

    Returns
    -------
    Table
        A row for each method.

    """
    heads = ('planner', *(f'time / limit ({name}), table {table}' for name in LIMIT_TIMES
                          for table in ('6.1', '6.3')),
             f'energy above {HIGH:g} Hz [%], table 6.1',
             f'residual vibration of modes of {MODES[0]:g} to {MODES[-1]:g} Hz, table 6.1')
    rows = []
    for pair in plans:
        times = [p.plan.trajectory.duration for p in pair]
        found = of_plan(pair[0])
        rows.append([pair[0].planner_id, *(
            f'{t / limit:.2f}' for limits in LIMIT_TIMES.values()
            for t, limit in zip(times, limits)), f'{100.0 * found.above:.2f}',
            f'{found.vibration:.2f}'])
    return Table('claims', 'Motion times relative to the least times, and excitation',
                 'Of whole motions; excitation of the worst joint.', heads, rows)


def _transition(function: Any) -> tuple[Array, Array]:
    t = np.linspace(0.0, DURATION, POINTS)
    piece = function.transition(DURATION, 0.0, 0.0, CHANGE)
    return t, piece.at(t / DURATION)[2]


def _vibration(function: Any, frequencies: Array) -> Array:
    """Return the residual vibration over the deflection under the largest acceleration."""
    piece = function.transition(DURATION, 0.0, 0.0, CHANGE)

    def motion(t: Array) -> tuple[Array, Array, Array, Array]:
        q, qd, qdd, qddd = (x[:, np.newaxis] for x in piece.at(t / DURATION))
        return q, qd, qdd, qddd

    found = residual_vibration(motion, [0.0, DURATION], frequencies)[:, 0]
    return np.asarray(found / np.abs(_transition(function)[1]).max())


def _by_frequency(name: str, title: str, caption: str, curves: dict[str, Array], x_label: str,
                  y_label: str) -> Picture:
    def draw(figure: Any) -> None:
        axes = drawing.stacked(figure, [y_label], x_label)[0]
        for i, (label, values) in enumerate(curves.items()):
            axes.semilogy(FREQUENCIES, np.maximum(values, FLOOR), color=SERIES[i],
                          linestyle=DASHES[i % 3], linewidth=1.2, label=label)
        drawing.legend(figure, axes.get_lines(), 4)

    return Picture(name, title, caption, draw, 3.2, {x_label: FREQUENCIES, **curves})
