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

"""A motion through a chain of segments of given durations, and what slows it down."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.core.limit_check import POSITION_TOLERANCE
from rrr_traj_planner.core.motion_torque import squared_stretch, torque_grid
from rrr_traj_planner.core.piecewise import PiecewiseTrajectory
from rrr_traj_planner.planners import segment_motion
from rrr_traj_planner.planners.barrier import Chain
from rrr_traj_planner.planners.motion_law import cannot_hold, LEAST_VELOCITY, torque_stretch
from rrr_traj_planner.planners.request import JointTask
from rrr_traj_planner.planners.via_velocities import least_stretch

STRETCH_TOLERANCE = 3e-7   # of prescribed durations: jerk then keeps its limit to 1e-6
TORQUE_TOLERANCE = 5e-7    # of the stretch that torque asks for
OVERSHOOT_REDUCTION = 0.5


class ChainMotion(NamedTuple):
    """A motion within the kinematic limits, and the durations of its segments."""

    trajectory: PiecewiseTrajectory
    durations: Array


def timed_motion(task: JointTask, chain: Chain, durations: Array,
                 gently: bool = True) -> tuple[ChainMotion | None, BoolArray]:
    """
    Return a motion of given durations, and which segments overshoot a joint's range.

    Time to spare makes it gentle, or else slows the fastest motion of the same proportions.

    Parameters
    ----------
    task : JointTask
        The arm and its limits.
    chain : Chain
        The via points.
    durations : ndarray, shape (n,)
        [s].
    gently : bool
        Whether time to spare makes it gentle.

    Returns
    -------
    tuple of ChainMotion and ndarray of bool, shape (n, 3)
        None where the kinematic limits leave no such motion.

    """
    factor, solution = least_stretch(chain, durations)
    v, T = solution.velocities, solution.durations
    if factor > 1.0 + STRETCH_TOLERANCE:
        return None, np.zeros_like(chain.displacements, dtype=bool)
    if factor <= 1.0 and gently:
        v, T, factor = v * factor, durations, 1.0
    v0, v1 = np.vstack((np.zeros(3), v)), np.vstack((v, np.zeros(3)))
    parts = segment_motion.gentle_parts(
        chain.law, chain.max_velocity, v0, v1, T[:, np.newaxis], chain.displacements)
    trajectory = segment_motion.trajectory(
        task.points, v0, v1, T[:, np.newaxis], parts, chain.function)
    if factor != 1.0:
        trajectory = trajectory.stretched(1.0 / factor)
    return ChainMotion(trajectory, durations), _overshoot(task, trajectory)


def slower_at(chain: Chain, segments: BoolArray) -> Chain:
    """
    Return the chain with lower velocities at the ends of some segments.

    Parameters
    ----------
    chain : Chain
        The via points.
    segments : ndarray of bool, shape (n, 3)
        Which segments of which joints.

    Returns
    -------
    Chain
        Bounds of the via velocities halved there.

    """
    at_ends = segments[:-1] | segments[1:]
    factor = np.where(at_ends, OVERSHOOT_REDUCTION, 1.0)
    return replace(chain, lowest=np.minimum(chain.lowest * factor, -LEAST_VELOCITY),
                   highest=np.maximum(chain.highest * factor, LEAST_VELOCITY))


def at_rest(chain: Chain) -> Chain:
    """
    Return the chain with a stop at every via point: its motions never overshoot.

    Parameters
    ----------
    chain : Chain
        The via points.

    Returns
    -------
    Chain
        Via velocities bounded to next to nothing.

    """
    still = np.full_like(chain.highest, LEAST_VELOCITY)
    return replace(chain, lowest=-still, highest=still)


def segment_stretch(task: JointTask, motion: ChainMotion) -> Array:
    """
    Return by how much torque asks each segment to be stretched.

    Parameters
    ----------
    task : JointTask
        The arm and its limits.
    motion : ChainMotion
        The motion.

    Returns
    -------
    ndarray, shape (n,)
        Below 1 where there is torque to spare, infinite where gravity alone is too much.

    """
    if np.isinf(task.limits.max_effort).all():
        return np.zeros(len(motion.durations))
    t = torque_grid(motion.trajectory)
    squared = squared_stretch(task.model, task.limits, *motion.trajectory(t)[:3]).max(axis=1)
    segment = np.searchsorted(motion.trajectory.via_times[1:-1], t, side='right')
    worst = np.zeros(len(motion.durations))
    np.maximum.at(worst, segment, squared)
    return np.sqrt(worst)


def stretched_for_torque(task: JointTask, motion: ChainMotion) -> ChainMotion:
    """
    Return the motion slowed as a whole, just enough for its torques.

    Parameters
    ----------
    task : JointTask
        The arm and its limits.
    motion : ChainMotion
        The motion.

    Returns
    -------
    ChainMotion
        Within the effort limits.

    Raises
    ------
    LimitViolationError
        If gravity alone exceeds an effort limit on the way.

    """
    factor = torque_stretch(task, motion.trajectory)
    if np.isinf(factor):
        raise cannot_hold(task, motion.trajectory)
    if factor <= 1.0 + TORQUE_TOLERANCE:
        return motion
    return ChainMotion(motion.trajectory.stretched(factor), motion.durations * factor)


def _overshoot(task: JointTask, trajectory: PiecewiseTrajectory) -> BoolArray:
    """Return in which segments which joints leave their range, shape (n, 3)."""
    out = np.zeros((len(task.points) - 1, 3), dtype=bool)
    starts = trajectory.via_times[1:-1] - 1e-12
    for joint, profile in enumerate(trajectory.profiles):
        least, most = profile.piece_ranges
        beyond = (least < task.limits.min_position[joint] - POSITION_TOLERANCE) | (
            most > task.limits.max_position[joint] + POSITION_TOLERANCE)
        out[np.searchsorted(starts, profile.knots[:-1][beyond], side='right'), joint] = True
    return out
