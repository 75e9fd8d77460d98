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
Tolerances of one goal: what it asks for, in place of the parameters' tolerances.

As in joint_trajectory_controller (ros2_controllers, Jazzy, `tolerances.hpp`), 0 leaves a tolerance
as it is, -1 takes it away, and what is wrong leaves all of them as they are.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import isnan
from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.control.tolerances import Tolerances
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.trajectory.trajectory_points import FLOAT_EPSILON

ERASED = -1.0  # removes a tolerance
LARGEST = 1e9  # rad, rad/s, s: no error comes near it; an infinite tolerance becomes this one


class AskedTolerance(NamedTuple):
    """Largest errors of a joint, as a goal has them."""

    joint: str
    position: float  # rad
    velocity: float  # rad/s
    acceleration: float = 0.0  # rad/s^2, unused: no acceleration is measured


class AskedTolerances(NamedTuple):
    """Tolerances as a goal has them."""

    path: Sequence[AskedTolerance] = ()
    goal: Sequence[AskedTolerance] = ()
    goal_time: float = 0.0  # s


def tolerances_of_goal(defaults: Tolerances, asked: AskedTolerances,
                       joint_names: Sequence[str]) -> Tolerances:
    """
    Return the tolerances of a goal.

    Parameters
    ----------
    defaults : Tolerances
        Those of the parameters.
    asked : AskedTolerances
        Those of the goal.
    joint_names : sequence of str
        The arm's joints.

    Returns
    -------
    Tolerances
        The defaults, where the goal does not ask for others.

    Raises
    ------
    InvalidInputError
        In joint_trajectory_controller's words, where it would use its defaults: a joint is
        unknown, or a tolerance is negative and not -1, or not a number.

    """
    goal_time = _resolved(defaults.goal_time, asked.goal_time)
    if goal_time is None:
        raise InvalidInputError(f'Specified illegal goal_time_tolerance: {asked.goal_time:f}. '
                                'Using default tolerances')
    path, path_velocity = _of_joints(
        'path', asked.path, joint_names, defaults.trajectory, defaults.trajectory_velocity)
    goal, goal_velocity = _of_joints(
        'goal', asked.goal, joint_names, defaults.goal, defaults.stopped_velocity)
    return replace(defaults, trajectory=path, trajectory_velocity=path_velocity, goal=goal,
                   stopped_velocity=goal_velocity, goal_time=goal_time)


def _of_joints(kind: str, asked: Sequence[AskedTolerance], joint_names: Sequence[str],
               position: Array, velocity: Array) -> tuple[Array, Array]:
    """Return position and velocity tolerances, given the defaults."""
    defaults = {'position': position, 'velocity': velocity, 'acceleration': np.zeros(3)}
    found = {name: values.copy() for name, values in defaults.items()}
    for tolerance in asked:
        if tolerance.joint not in joint_names:
            raise InvalidInputError(
                f"joint '{tolerance.joint}' specified in goal.{kind}_tolerance does not exist. "
                'Using default tolerances.')
        i = list(joint_names).index(tolerance.joint)
        for name, values in defaults.items():
            value = _resolved(float(values[i]), getattr(tolerance, name))
            if value is None:
                raise InvalidInputError(
                    f"joint '{tolerance.joint}' specified in goal.{kind}_tolerance has a invalid "
                    f'{name} tolerance. Using default tolerances.')
            found[name][i] = value
    return found['position'], found['velocity']


def _resolved(default: float, asked: float) -> float | None:
    """Return a tolerance, 0 for none; None if it is not allowed."""
    if asked > 0.0:
        return min(asked, LARGEST)
    if abs(asked - ERASED) < FLOAT_EPSILON:
        return 0.0
    return None if asked < 0.0 or isnan(asked) else default
