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
from enum import Enum
from functools import cached_property
from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array, finite_array
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.read_only import ReadOnlyArrays
from rrr_traj_planner.core.scalars import not_negative
from rrr_traj_planner.core.states import Desired, State

FIELDS = {'trajectory': 'rad', 'goal': 'rad', 'stopped_velocity': 'rad/s',
          'trajectory_velocity': 'rad/s'}


class Outcome(Enum):
    """What is found when the tolerances of a trajectory are checked."""

    REACHED = 'the goal is reached'
    PATH_VIOLATED = 'Holding position due to state tolerance violation'
    GOAL_VIOLATED = 'Exceeded goal_time_tolerance: holding position...'
    TIMED_OUT = 'Aborted due to command timeout'


class Exceeded(NamedTuple):
    """A tolerance that a joint exceeds."""

    joint: int  # index
    kind: str   # 'Position' or 'Velocity'
    error: float      # desired minus measured [rad] or [rad/s]
    tolerance: float  # the same


class Verdict(NamedTuple):
    """An outcome, and what it comes from."""

    outcome: Outcome
    since_end: float  # s since the trajectory's end
    exceeded: tuple[Exceeded, ...] = ()

    @property
    def lines(self) -> tuple[str, ...]:
        """Return the exceeded tolerances in joint_trajectory_controller's words."""
        found: list[str] = []
        for i, (joint, kind, error, tolerance) in enumerate(self.exceeded):
            if i == 0 or self.exceeded[i - 1].joint != joint:
                found.append(f'State tolerances failed for joint {joint}:')
            found.append(f'{kind} Error: {error:f}, {kind} Tolerance: {tolerance:f}')
        return tuple(found)


@dataclass(frozen=True, eq=False)
class Tolerances(ReadOnlyArrays):
    """
    Tolerances while and after a trajectory is followed.

    Parameters
    ----------
    trajectory, goal : array_like, shape (3,)
        Largest position error of each joint during the trajectory, and from its end on [rad].
    stopped_velocity : array_like, shape (3,)
        Largest velocity error of each joint from the end on [rad/s].
    goal_time : float
        Time after the end until the goal tolerances apply [s]; 0: never.
    cmd_timeout : float
        Time after the end at which the measured position is held instead [s]; 0: never. Ignored
        unless larger than goal_time.
    trajectory_velocity : array_like, shape (3,)
        Largest velocity error of each joint during the trajectory [rad/s].

    Raises
    ------
    InvalidInputError
        If a value is negative or not finite.

    """

    trajectory: Array = field(default_factory=lambda: np.zeros(3))
    goal: Array = field(default_factory=lambda: np.zeros(3))
    stopped_velocity: Array = field(default_factory=lambda: np.full(3, 0.01))
    goal_time: float = 0.0
    cmd_timeout: float = 0.0
    trajectory_velocity: Array = field(default_factory=lambda: np.zeros(3))

    def __post_init__(self) -> None:
        """Check the values and make the arrays read-only."""
        for name, unit in FIELDS.items():
            array = finite_array(name, getattr(self, name), (3,))
            object.__setattr__(self, name, array)
            if (array < 0.0).any():
                raise InvalidInputError(
                    f'{name} is {array.tolist()} {unit}, must not be negative')
        for name in ('goal_time', 'cmd_timeout'):
            object.__setattr__(self, name, not_negative(name, getattr(self, name), 's'))
        super().__post_init__()

    @cached_property
    def apply_on_the_way(self) -> bool:
        """Return whether there is a tolerance before the trajectory's end."""
        return bool(self.trajectory.any() or self.trajectory_velocity.any())

    @property
    def apply_after_the_end(self) -> bool:
        """Return whether a trajectory can be given up after its end."""
        return self.goal_time > 0.0 or self.cmd_timeout > 0.0

    def verdict(self, measured: State, desired: Desired, since_end: float, first: bool = False,
                is_goal: bool = False) -> Verdict | None:
        """
        Return what is to be done about a trajectory.

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
        is_goal : bool
            Whether the trajectory is a goal's, which is reached once it has ended and the goal
            tolerances are met.

        Returns
        -------
        Verdict or None
            None: the trajectory goes on.

        """
        if since_end < 0.0 or first:
            if found := _exceeded(measured, desired, self.trajectory, self.trajectory_velocity):
                return Verdict(Outcome.PATH_VIOLATED, since_end, found)
        if since_end >= 0.0 and (is_goal or self.goal_time > 0.0):
            found = _exceeded(measured, desired, self.goal, self.stopped_velocity)
            if is_goal and not found:
                return Verdict(Outcome.REACHED, since_end)
            if found and since_end > self.goal_time > 0.0:
                return Verdict(Outcome.GOAL_VIOLATED, since_end, found)
        if self.cmd_timeout > self.goal_time and since_end > self.cmd_timeout:
            return Verdict(Outcome.TIMED_OUT, since_end)
        return None


def _exceeded(measured: State, desired: Desired, position: Array, velocity: Array
              ) -> tuple[Exceeded, ...]:
    """Return what exceeds tolerances: of each joint first the position, then the velocity."""
    largest = (*position.tolist(), *velocity.tolist())
    return tuple(
        Exceeded(i % 3, 'Velocity' if i >= 3 else 'Position', error, largest[i])
        for i in (0, 3, 1, 4, 2, 5)
        if largest[i] > 0.0 and abs(error := desired[i] - measured[i]) > largest[i])
