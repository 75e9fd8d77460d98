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

"""
Tolerances of trajectory execution, as in joint_trajectory_controller.

Names, meaning and texts are those of its `tolerances.hpp` (ros2_controllers, Jazzy), for position
and velocity commands. As there, a tolerance of 0 is none.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from rrr_traj_planner.core.arrays import Array, finite_array
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.read_only import ReadOnlyArrays
from rrr_traj_planner.core.scalars import not_negative
from rrr_traj_planner.core.states import Desired, State

PATH_VIOLATED = 'Holding position due to state tolerance violation'
GOAL_TIME_EXCEEDED = 'Exceeded goal_time_tolerance: holding position...'
TIMED_OUT = 'Aborted due to command timeout'


@dataclass(frozen=True, eq=False)
class Tolerances(ReadOnlyArrays):
    """
    Tolerances while and after a trajectory is followed.

    Parameters
    ----------
    trajectory, goal : array_like, shape (3,)
        Largest position error of each joint during the trajectory, and from its end on [rad].
    stopped_velocity : float
        Largest velocity error from the end on [rad/s].
    goal_time : float
        Time after the end until the goal tolerances apply [s]; 0: never.
    cmd_timeout : float
        Time after the end at which the measured position is held instead [s]; 0: never. Ignored
        unless larger than goal_time.

    Raises
    ------
    InvalidInputError
        If a value is negative or not finite.

    """

    trajectory: Array = field(default_factory=lambda: np.zeros(3))
    goal: Array = field(default_factory=lambda: np.zeros(3))
    stopped_velocity: float = 0.01
    goal_time: float = 0.0
    cmd_timeout: float = 0.0

    def __post_init__(self) -> None:
        """Check the values and make the arrays read-only."""
        for name in ('trajectory', 'goal'):
            array = finite_array(name, getattr(self, name), (3,))
            object.__setattr__(self, name, array)
            if (array < 0.0).any():
                raise InvalidInputError(
                    f'{name} is {array.tolist()} rad, must not be negative')
        for name, unit in (('stopped_velocity', 'rad/s'), ('goal_time', 's'),
                           ('cmd_timeout', 's')):
            object.__setattr__(self, name, not_negative(name, getattr(self, name), unit))

    @property
    def are_none(self) -> bool:
        """Whether no tolerance applies; without a goal time, the goal's do not."""
        return not self.trajectory.any() and self.goal_time == 0.0 and self.cmd_timeout == 0.0

    def violation(self, measured: State, desired: Desired, since_end: float,
                  first: bool = False) -> tuple[str, ...]:
        """
        Return the violated tolerances, in joint_trajectory_controller's words.

        Parameters
        ----------
        measured : tuple of 6 floats
            Measured positions [rad] and velocities [rad/s].
        desired : tuple of 9 floats
            The reference.
        since_end : float
            Time since the trajectory's end [s]; negative before it.
        first : bool
            Whether this is the first check of a trajectory, to which path tolerances apply.

        Returns
        -------
        tuple of str
            A line for each violation, the consequence last; empty if there is none.

        """
        lines: list[str] = []
        if since_end < 0.0 or first:
            lines = _exceeded(measured, desired, self.trajectory.tolist(), 0.0)
            if lines:
                return *lines, PATH_VIOLATED
        if since_end > self.goal_time > 0.0:
            lines = _exceeded(measured, desired, self.goal.tolist(), self.stopped_velocity)
            if lines:
                return *lines, GOAL_TIME_EXCEEDED
        if self.cmd_timeout > self.goal_time and since_end > self.cmd_timeout:
            return (TIMED_OUT,)
        return ()


def _exceeded(measured: State, desired: Desired, position: list[float],
              velocity: float) -> list[str]:
    """Return the lines that name joints, errors and tolerances."""
    lines: list[str] = []
    for i, tolerance in enumerate(position):
        found = []
        for kind, error, largest in (('Position', desired[i] - measured[i], tolerance),
                                     ('Velocity', desired[3 + i] - measured[3 + i], velocity)):
            if largest > 0.0 and abs(error) > largest:
                found.append(f'{kind} Error: {error:f}, {kind} Tolerance: {largest:f}')
        if found:
            lines += [f'State tolerances failed for joint {i}:', *found]
    return lines
