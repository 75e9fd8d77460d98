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

"""Following a path of the tip from given joint positions, and why an arm cannot."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.core.cancellation import never, ShouldStop
from rrr_traj_planner.core.errors import (
    format_distinct,
    LimitViolationError,
    RrrPlannerError,
    UnreachableError,
)
from rrr_traj_planner.core.kinematics.along_path import (
    follow_points,
    FollowedPoints,
    singular_distance,
    SINGULAR_VALUE,
)
from rrr_traj_planner.core.kinematics.axis_frame import axis_frame
from rrr_traj_planner.core.kinematics.solutions import distances_out_of_reach
from rrr_traj_planner.core.path.arm_path import ArmPath
from rrr_traj_planner.core.path.axis_planes import axis_planes
from rrr_traj_planner.core.path.cartesian_path import CartesianPath
from rrr_traj_planner.core.rounding import TIP_ROUNDING
from scipy import optimize

# Least singular value of the Jacobian along a path: with less, a joint would have to turn by more
# than a million radians for each metre of the path, practically without bound. Chosen.
LEAST_SINGULAR_VALUE = 1e-6  # m/rad

# Intervals of the path are halved until they are no longer than the distance to the nearest
# singular position and predictions are as good as this; or until they are this short, less than
# the tip is told apart by. Chosen.
PREDICTION = 0.02     # rad
SHORTEST_STEP = 1e-9  # m

# Rounds of halving: from any length of path up to 10^18 m, as short as that. Chosen.
MOST_ROUNDS = 90

# Distance from joint axis 1 up to which a singular position is one of that axis, over the arm's
# size: far above LEAST_SINGULAR_VALUE, far below any link. Chosen.
NEAR_AXIS = 1e-4


def followed_path(model: RobotModel, path: CartesianPath, first: Array,
                  should_stop: ShouldStop = never) -> ArmPath:
    """
    Return a path as an arm follows it from given joint positions, without regard to ranges.

    Parameters
    ----------
    model : RobotModel
        The arm.
    path : CartesianPath
        The path.
    first : ndarray, shape (3,)
        Joint positions at its beginning [rad].
    should_stop : callable
        Polled in every round; called for its exceptions; the return value is ignored.

    Returns
    -------
    ArmPath
        Continuous joint positions, beginning with those given.

    Raises
    ------
    UnreachableError
        If the path leaves the workspace, or touches its edge; with the path coordinate of the
        largest violation and the nearest via point's number.
    LimitViolationError
        If the path passes joint axis 1, where joint 1 would have to turn; likewise.

    """
    planes = axis_planes(model, path, float(first[0]))
    first = np.array((planes.joint_1(float(first[0])), *first[1:]))
    s = np.unique(path.grid)
    for attempt in range(MOST_ROUNDS):
        should_stop()
        found = follow_points(
            model, s, planes.points(path, s), planes.points(path, s, left=True), first)
        ended = len(found.q) < len(s)
        sigma = found.regularity[..., SINGULAR_VALUE].min(axis=0, initial=np.inf)
        if ended and attempt == 0:
            _check_reach(model, path, s)
        if sigma.min(initial=np.inf) < LEAST_SINGULAR_VALUE:
            raise _refusal(model, path, s, float(s[sigma.argmin()]))
        h = np.diff(s)
        split = _too_long(found, h) & (h > SHORTEST_STEP)
        if not split.any():
            break
        s = np.sort(np.concatenate((s, 0.5 * (s[:-1] + s[1:])[split])))
    if ended:
        raise _refusal(model, path, s, float(s[max(len(found.q) - 1, 0)]))
    return ArmPath(model, path, planes, s, found.q, found.rates)


def place_on_path(path: CartesianPath, s: float) -> tuple[str, int]:
    """
    Return a text for a path coordinate, and the nearest via point.

    Parameters
    ----------
    path : CartesianPath
        The path.
    s : float
        The path coordinate [m].

    Returns
    -------
    tuple of str and int
        The text, and the number of the via point that is nearest along the path.

    """
    nearest = int(np.abs(path.via_s - s).argmin())
    before = int(np.clip(np.searchsorted(path.via_s, s, side='right') - 1, 0,
                         len(path.via_s) - 2))
    return (f'at {s:.6g} m along the path, between via points {before} and {before + 1} '
            f'(nearest: {nearest})', nearest)


def _too_long(found: FollowedPoints, h: Array) -> BoolArray:
    """Return which intervals are too long to be sure of the branch."""
    reached = len(found.q)
    too_long = np.zeros(len(h), dtype=bool)
    too_long[reached - 1:reached] = reached <= len(h)
    leaving, reaching = singular_distance(found.regularity)
    done = slice(max(reached - 1, 0))
    too_long[done] = (h[done] > np.minimum(leaving[:-1], reaching[1:])) | (
        found.error > PREDICTION)
    return too_long


def _check_reach(model: RobotModel, path: CartesianPath, s: Array) -> None:
    """Raise if points of a path are out of reach, at the farthest one."""
    miss = distances_out_of_reach(model, path(s)[0])
    if miss.max() <= TIP_ROUNDING:
        return

    def within_reach(x: float) -> float:
        return -float(distances_out_of_reach(model, path(np.array([x]))[0])[0])

    at, least = _least(within_reach, s, int(miss.argmax()))
    most = -least
    place, nearest = place_on_path(path, at)
    raise UnreachableError(
        f"{place}: the tip would be out of the arm's reach: it misses by {most:.6g} m",
        distance=most, via_point=nearest)


def _least(function: Callable[[float], float], s: Array, k: int) -> tuple[float, float]:
    """Return where a function is least between a path coordinate's neighbours, and its value."""
    begin, middle, end = (float(s[i]) for i in (max(k - 1, 0), k, min(k + 1, len(s) - 1)))
    # By the offset: the search's tolerance is relative to the coordinate, however long the path.
    found = optimize.minimize_scalar(
        lambda offset: function(middle + offset), bounds=(begin - middle, end - middle),
        method='bounded', options={'xatol': TIP_ROUNDING * (end - begin)})
    at_middle = function(middle)
    return (middle + float(found.x), float(found.fun)) if found.fun < at_middle else (
        middle, at_middle)


def _refusal(model: RobotModel, path: CartesianPath, s: Array, at: float) -> RrrPlannerError:
    """Return why a path cannot be followed beyond a point."""
    try:
        _check_reach(model, path, s)
    except UnreachableError as error:
        return error
    frame = axis_frame(model)

    def from_axis(x: float) -> float:
        return float(np.hypot(*frame.coordinates(path(x)[0])[:2]))

    if from_axis(at) < NEAR_AXIS * model.chain.size:
        at, distance = _least(from_axis, s, int(np.searchsorted(s, at)))
        place, nearest = place_on_path(path, at)
        name = model.joint_names[0]
        passed, bound = format_distinct(distance, LEAST_SINGULAR_VALUE, digits=3)
        return LimitViolationError(
            f'{place}: the tip would pass joint axis 1 (singularity) at {passed} m, where {name} '
            f'would need unbounded velocity; least {bound} m', name, distance,
            LEAST_SINGULAR_VALUE, via_point=nearest)
    place, nearest = place_on_path(path, at)
    return UnreachableError(
        f'{place}: the arm would be at the end of its reach in this posture (singularity: '
        'stretched, folded or turned over), where joints would need unbounded velocity',
        distance=0.0, via_point=nearest)
