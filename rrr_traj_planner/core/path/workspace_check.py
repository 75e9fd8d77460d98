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

"""Check of a whole path against the workspace and the joint ranges, between points too."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.core.cancellation import never, ShouldStop
from rrr_traj_planner.core.errors import format_distinct, StartStateError
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.kinematics.joint_ranges import (
    nearest_turns,
    out_of_range,
    range_error,
    TURN,
    whole_turns,
)
from rrr_traj_planner.core.path.arm_path import ArmPath
from rrr_traj_planner.core.path.axis_planes import axis_planes, AxisPlanes
from rrr_traj_planner.core.path.cartesian_path import CartesianPath
from rrr_traj_planner.core.path.following import followed_path, place_on_path, SHORTEST_STEP
from rrr_traj_planner.core.rounding import JOINT_ROUNDING, TIP_ROUNDING

BISECTIONS = 40  # largest number of rounds of halving intervals; chosen: 1e-12 of the first

# Largest excursions that may be missed, chosen so that what is missed is rounding to later checks:
COARSE_ANGLE = 1e-8     # rad, of a joint
FINEST_ANGLE = 0.01 * JOINT_ROUNDING  # rad, of a joint within NEAR_END of an end of its range
NEAR_END = 1e-6         # rad
# Bound on a second derivative between two samples, over the larger of theirs; chosen.
SAFETY = 2.0


def check_workspace(model: RobotModel, limits: JointLimits, path: CartesianPath, first: Array,
                    start: Array | None = None, should_stop: ShouldStop = never) -> ArmPath:
    """
    Return a path as an arm follows it, within the joints' ranges; raise if it cannot.

    Every interval in which a bound on the second derivative allows a joint to leave its range is
    halved until none is left.

    Parameters
    ----------
    model : RobotModel
        The arm.
    limits : JointLimits
        Ranges of the joints.
    path : CartesianPath
        The path.
    first : ndarray, shape (3,)
        Joint positions at its beginning, up to whole turns [rad].
    start : ndarray, shape (3,), optional
        The same, with the whole turns with which the path is to begin; None: with any.
    should_stop : callable
        Polled in every round; called for its exceptions; the return value is ignored.

    Returns
    -------
    ArmPath
        Its known joint positions contain their extremes along the path.

    Raises
    ------
    UnreachableError
        If the path leaves the workspace: with the path coordinate of the largest violation and
        the nearest via point's number.
    LimitViolationError
        If the path crosses joint axis 1 where joint 1 would have to turn, or a joint leaves its
        range; likewise.
    StartStateError
        If the arm would have to turn joint 1 first, with the tip on its axis.

    """
    if start is not None:
        _check_direction(axis_planes(model, path, float(start[0])), model, start)
    arm_path = followed_path(model, path, first, should_stop)
    arm_path = arm_path.turned(_turns(arm_path.q, limits, start))
    arm_path = _with_extremes(arm_path, limits, should_stop)
    _check_ranges(arm_path, limits)
    return arm_path


def _turns(q: Array, limits: JointLimits, start: Array | None) -> Array:
    """
    Return whole turns for joint positions along a path; of those that fit nowhere, at its start.

    So the error tells where the path leaves the range.
    """
    of_all, of_first = (whole_turns(part, limits, start) for part in (q, q[:1]))
    return np.where(out_of_range(q[:1] + of_all, limits)[0], of_first, of_all)


def _check_direction(planes: AxisPlanes, model: RobotModel, start: Array) -> None:
    """Raise if a path leaves joint axis 1 in a plane other than that in which the arm is."""
    tip = planes.frame.coordinates(forward_kinematics(model, start))
    wanted = planes.joint_1(float(start[0]))
    if np.hypot(tip[0], tip[1]) > TIP_ROUNDING or abs(wanted - start[0]) <= JOINT_ROUNDING:
        return
    at, needed = format_distinct(float(start[0]), wanted)
    raise StartStateError(
        f'start state: {model.joint_names[0]} is at {at} rad with the tip on joint axis 1 '
        f'(singularity): it would need unbounded velocity to reach {needed} rad, where the '
        'path leaves the axis')


def _with_extremes(arm_path: ArmPath, limits: JointLimits, should_stop: ShouldStop) -> ArmPath:
    """Return a path with joint positions known wherever one of them may be an extreme."""
    s, leaving, reaching = arm_path.s, arm_path(arm_path.s), arm_path(arm_path.s, left=True)
    # position; derivatives as the path leaves and as it reaches each of them
    q, rates, second = leaving.q, np.stack((leaving.dq, reaching.dq)), np.stack(
        (leaving.ddq, reaching.ddq))
    for _ in range(BISECTIONS):
        should_stop()
        open_ = _may_exceed(q, np.diff(s)[:, np.newaxis], second, limits)
        if not open_.any():
            break
        middles, after = 0.5 * (s[:-1] + s[1:])[open_], np.flatnonzero(open_) + 1
        between = arm_path(middles)  # none of them is a join
        s, q = np.insert(s, after, middles), np.insert(q, after, between.q, axis=0)
        rates = np.insert(rates, after, between.dq, axis=1)
        second = np.insert(second, after, between.ddq, axis=1)
    return replace(arm_path, s=s, q=q, rates=rates)


def _may_exceed(q: Array, h: Array, second: Array, limits: JointLimits) -> BoolArray:
    """Return in which intervals of length h a joint may go beyond the farthest known position."""
    excursion = 0.125 * SAFETY * h ** 2 * np.maximum(
        np.abs(second[0, :-1]), np.abs(second[1, 1:]))
    low = np.minimum(q[:-1], q[1:]) - excursion
    high = np.maximum(q[:-1], q[1:]) + excursion
    least, most = q.min(axis=0), q.max(axis=0)
    farther = ((low < least - _resolution(least, limits.min_position))
               | (high > most + _resolution(most, limits.max_position))).any(axis=1)
    return np.asarray(farther & (h[:, 0] > SHORTEST_STEP))


def _resolution(extreme: Array, end: Array) -> Array:
    """Return the resolution of joints' extremes: fine where they are near the range's end."""
    with np.errstate(invalid='ignore'):  # infinite ends
        beyond = extreme - end
        is_near = np.abs(beyond - TURN * nearest_turns(beyond)) < NEAR_END
    return np.where(is_near, FINEST_ANGLE, COARSE_ANGLE)


def _check_ranges(arm_path: ArmPath, limits: JointLimits) -> None:
    """Raise if joint positions are out of range, reporting the largest violation."""
    q = arm_path.q
    excess = np.maximum(limits.min_position - q, q - limits.max_position)
    if (excess <= JOINT_ROUNDING - FINEST_ANGLE).all():
        return
    i, j = (int(k) for k in np.unravel_index(excess.argmax(), excess.shape))
    place, nearest = place_on_path(arm_path.path, float(arm_path.s[i]))
    raise range_error(arm_path.model, limits, place, j, q[i], nearest)
