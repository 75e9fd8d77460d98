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
Validation of received trajectories by joint_trajectory_controller's rules, in its words.

The checks, their order and their texts are those of its `validate_trajectory_msg`
(ros2_controllers, Jazzy), without effort commands. In addition repeated names, a negative first
time, and values that are not finite or absurdly large are refused.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite
from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.errors import format_distinct, InvalidInputError
from rrr_traj_planner.core.nanoseconds import SECOND
from rrr_traj_planner.core.trajectory.trajectory_points import FLOAT_EPSILON, TrajectoryPoints

# Largest value accepted [rad], [rad/s], [rad/s^2]: excludes overflow in later
# computations; chosen far above any arm's.
LARGEST = 1e6

FIELDS = ('positions', 'velocities', 'accelerations')


class IncomingPoint(NamedTuple):
    """A point as received: its sequences may have the wrong size."""

    time: int  # ns from the trajectory's start
    positions: Sequence[float]
    velocities: Sequence[float] = ()
    accelerations: Sequence[float] = ()
    effort: Sequence[float] = ()


class IncomingTrajectory(NamedTuple):
    """A trajectory as received, not yet validated."""

    joint_names: Sequence[str]
    stamp: int  # ns on the clock of the arm; 0: starts on arrival
    points: Sequence[IncomingPoint]


class JointNamesError(InvalidInputError):
    """A trajectory whose joints are not the arm's."""


class PastEndError(InvalidInputError):
    """A trajectory that has ended already."""


class MovingEndError(InvalidInputError):
    """A trajectory whose last point has a velocity, where `Rules` do not allow it."""


class Rules(NamedTuple):
    """Options, with the names of joint_trajectory_controller's parameters."""

    allow_partial_joints_goal: bool = False
    allow_nonzero_velocity_at_trajectory_end: bool = False


STRICT = Rules()


def check_trajectory(trajectory: IncomingTrajectory, joint_names: Sequence[str],
                     now: int, rules: Rules = STRICT) -> None:
    """
    Refuse a trajectory that the arm cannot follow.

    Parameters
    ----------
    trajectory : IncomingTrajectory
        As received.
    joint_names : sequence of str
        The arm's joints.
    now : int
        The clock [ns].
    rules : Rules
        Options.

    Raises
    ------
    InvalidInputError
        With joint_trajectory_controller's text, where it would refuse.

    """
    _check_names(trajectory, joint_names, rules)
    if not rules.allow_nonzero_velocity_at_trajectory_end:
        _check_rest(trajectory)
    _check_end(trajectory, now)
    before = 0
    for i, point in enumerate(trajectory.points):
        _check_time(i, before, point.time)
        _check_point(i, point, trajectory.joint_names)
        before = point.time


def commanded_points(trajectory: IncomingTrajectory, joint_names: Sequence[str],
                     held: Sequence[float] = (0.0, 0.0, 0.0)) -> TrajectoryPoints:
    """
    Return the points of an accepted trajectory, joints in the arm's order.

    Parameters
    ----------
    trajectory : IncomingTrajectory
        As received, validated.
    joint_names : sequence of str
        The arm's joints.
    held : sequence of float
        Positions of joints that the trajectory does not name [rad].

    Returns
    -------
    TrajectoryPoints
        Times from the trajectory's start [s].

    """
    columns = [list(joint_names).index(name) for name in trajectory.joint_names]
    points, still = trajectory.points, (0.0,) * len(joint_names)
    return TrajectoryPoints(
        np.array([p.time / SECOND for p in points]),
        _rows([p.positions for p in points], columns, held),
        _rows([p.velocities for p in points], columns, still),
        _rows([p.accelerations for p in points], columns, still),
        np.array([len(p.velocities) > 0 for p in points]),
        np.array([len(p.accelerations) > 0 for p in points]))


def _rows(values: list[Sequence[float]], columns: list[int], missing: Sequence[float]) -> Array:
    """Return joint values, a row for each point; `missing` for joints or points without."""
    rows: Array = np.tile(np.asarray(missing, dtype=float), (len(values), 1))
    given = [i for i, v in enumerate(values) if len(v)]
    if given:
        rows[np.ix_(given, columns)] = np.array([values[i] for i in given], dtype=float)
    return rows


def _check_names(trajectory: IncomingTrajectory, joint_names: Sequence[str],
                 rules: Rules) -> None:
    names = trajectory.joint_names
    if not rules.allow_partial_joints_goal and len(names) != len(joint_names):
        raise JointNamesError("Joints on incoming trajectory don't match the controller joints.")
    if not names:
        raise JointNamesError('Empty joint names on incoming trajectory.')
    if not trajectory.points:
        raise InvalidInputError('Empty trajectory received.')
    for name in names:
        if name not in joint_names:
            raise JointNamesError(
                f"Incoming joint {name} doesn't match the controller's joints.")
    for i, name in enumerate(names):
        if name in names[:i]:
            raise JointNamesError(f'Incoming joint {name} is named twice.')


def _check_rest(trajectory: IncomingTrajectory) -> None:
    last = trajectory.points[-1]
    for name, velocity in zip(trajectory.joint_names, last.velocities):
        if abs(velocity) > FLOAT_EPSILON:
            raise MovingEndError(
                f'Velocity of last trajectory point of joint {name} is not zero: {velocity:.15f}')


def _check_end(trajectory: IncomingTrajectory, now: int) -> None:
    end = trajectory.stamp + trajectory.points[-1].time
    if trajectory.stamp != 0 and end < now:
        raise PastEndError(
            f'Received trajectory with non-zero start time ({trajectory.stamp / SECOND:f}) '
            f'that ends in the past ({end / SECOND:f})')


def _check_time(i: int, before: int, time: int) -> None:
    if i > 0 and time <= before:
        raise InvalidInputError(
            f'Time between points {i - 1} and {i} is not strictly increasing, '
            f'it is {before / SECOND:f} and {time / SECOND:f} respectively')
    if time < 0:
        raise InvalidInputError(f'Time of point #{i} is negative: {time / SECOND:f}')


def _check_point(i: int, point: IncomingPoint, names: Sequence[str]) -> None:
    for field in FIELDS:
        size = len(getattr(point, field))
        if size != len(names) and (size or field == 'positions'):
            raise InvalidInputError(
                f'Mismatch between joint_names size ({len(names)}) and {field} ({size}) '
                f'at point #{i}.')
    if len(point.effort):
        raise InvalidInputError(
            'Trajectories with effort fields are only supported for '
            "controllers using the 'effort' command interface.")
    for field in FIELDS:
        for name, value in zip(names, getattr(point, field)):
            if not isfinite(value):
                raise InvalidInputError(
                    f'Value of {field} of joint {name} at point #{i} is not finite: {value:f}')
            if abs(value) > LARGEST:
                _, most, shown = format_distinct(abs(value), LARGEST, value)
                raise InvalidInputError(
                    f'Value of {field} of joint {name} at point #{i} is {shown}, must be within '
                    f'{most}')
