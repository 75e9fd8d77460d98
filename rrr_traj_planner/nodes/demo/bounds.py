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

"""The demo's figures (errors and peaks) with their bounds."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.errors import format_distinct
from rrr_traj_planner.core.simulation.saturation_and_contact import SATURATED
from rrr_traj_planner.core.trajectory.limit_check import TOLERANCE
from rrr_traj_planner.nodes.runs.figures import deviations, executed_torque, peaks
from rrr_traj_planner.nodes.runs.run import Run
from rrr_traj_planner.nodes.runs.via_errors import executed_errors, final_error, planned_errors

PLANNED_BOUND = 1e-9   # rad, error of the plan at via points: rounding
EXECUTED_BOUND = 2e-3  # m, error of the arm's tip at via points: tracking
FINAL_BOUND = 1e-3     # m, error of the arm's tip at rest


class CheckedValue(NamedTuple):
    """A value and its upper bound."""

    name: str
    value: float
    bound: float
    unit: str

    @property
    def within_bound(self) -> bool:
        """Return whether the value is at most the bound."""
        return bool(self.value <= self.bound)

    @property
    def text(self) -> str:
        """Return name, value, bound and unit in a line."""
        value, bound = format_distinct(self.value, self.bound)
        return f'{self.name} is {value} {self.unit}, bound {bound} {self.unit}'


def checked_values(run: Run) -> list[CheckedValue]:
    """
    Return all values of a run that have a bound.

    Parameters
    ----------
    run : Run
        The run.

    Returns
    -------
    list of CheckedValue
        Values with their bounds.

    """
    found = []
    missed = run.planner.misses_via_points
    for i, (planned, executed) in enumerate(zip(planned_errors(run), executed_errors(run))):
        if missed and not run.rests.at[i]:  # by construction
            continue
        found += [CheckedValue(f'via point {i}: planned error', planned, PLANNED_BOUND, 'rad'),
                  CheckedValue(f'via point {i}: tip error', executed, EXECUTED_BOUND, 'm')]
    found.append(CheckedValue('final error', final_error(run), FINAL_BOUND, 'm'))
    if run.follows_path:
        bound = run.config.max_deviation
        planned, executed = deviations(run)
        found += [CheckedValue('planned distance from the polyline', planned, bound, 'm'),
                  CheckedValue('distance from the polyline', executed, bound + EXECUTED_BOUND,
                               'm')]
    for name, peak, limit, unit in peaks(run.response, run.config.limits):
        for joint, p, m in zip(run.config.model.joint_names, peak, limit):
            found.append(
                CheckedValue(f'{joint}: planned {name}', p, m * (1.0 + TOLERANCE), unit))
    for joint, p, m in zip(run.config.model.joint_names, executed_torque(run),
                           _torque_bounds(run)):
        found.append(CheckedValue(f'{joint}: executed torque', p, m, 'N m'))
    return found


def bounds_text(found: list[CheckedValue]) -> str:
    """
    Return how many values are within their bounds, in a line.

    Parameters
    ----------
    found : list of CheckedValue
        From `checked_values`.

    Returns
    -------
    str
        The line.

    """
    within = sum(value.within_bound for value in found)
    return f'{within} of {len(found)} figures are inside their bounds'


def _torque_bounds(run: Run) -> Array:
    """
    Return the bounds of the motors' executed torques [N m].

    A torque at the limit means that the motor is saturated and may not follow. A motor whose plan
    leaves what the controller needs to follow it, 1 - 1 / `SATURATED` of the limit, must not be:
    its bound is the next number below the limit. Of a plan that takes more, up to the whole limit
    (and the 1e-6 of it by which plans may exceed limits), the controller's correction saturates
    the motor: torques are constant over a physics step, and the motion between two points is
    interpolated. Whether the arm follows all the same, the tip's errors say.

    Parameters
    ----------
    run : Run
        The run.

    Returns
    -------
    ndarray, shape (3,)
        Bounds.

    """
    limit = run.config.limits.max_effort
    takes_all = np.array(run.response.peak_effort) * SATURATED >= limit
    return np.where(takes_all, limit * (1.0 + TOLERANCE), np.nextafter(limit, 0.0))
