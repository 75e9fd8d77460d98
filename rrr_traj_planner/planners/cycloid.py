"""
`cycloid`: transition, cruise, transition in every segment, via velocities free, least total time.

Every transition is a full-period cycloid. Durations and via velocities are optimised together
under the velocity, acceleration and jerk limits; where the torque of the motion is too much, the
segments that ask for it are given more time.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.core.errors import ConvergenceError, TimingError
from rrr_traj_planner.core.limit_check import POSITION_TOLERANCE
from rrr_traj_planner.core.motion_torque import squared_stretch, torque_grid
from rrr_traj_planner.core.piecewise import PiecewiseTrajectory
from rrr_traj_planner.core.trajectory import Trajectory
from rrr_traj_planner.planners import segment_motion
from rrr_traj_planner.planners.barrier import Chain
from rrr_traj_planner.planners.motion_law import (
    cannot_hold,
    chain_of,
    LEAST_VELOCITY,
    torque_stretch,
)
from rrr_traj_planner.planners.registry import register
from rrr_traj_planner.planners.request import JointTask
from rrr_traj_planner.planners.via_velocities import least_stretch, least_time

# Durations are longer than the least by this part, so that they can be prescribed again.
DURATION_ROOM = 1e-6
DURATION_TOLERANCE = 1e-9  # s, to which prescribed durations are kept
STRETCH_TOLERANCE = 3e-7   # of prescribed durations: jerk then keeps its limit to 1e-6
TORQUE_TOLERANCE = 5e-7    # of the stretch that torque asks for

STRAIGHTENING_ROUNDS = 5   # of lowering via velocities of a path that gravity blocks
SLOWING_ROUNDS = 8         # of giving more time to the segments that lack torque
OVERSHOOT_ROUNDS = 8       # of lowering via velocities that overshoot a joint's range
OVERSHOOT_REDUCTION = 0.5


@register('cycloid')
def plan(task: JointTask) -> Trajectory:
    """
    Return the fastest motion of this structure, or one of prescribed durations.

    Parameters
    ----------
    task : JointTask
        What is asked.

    Returns
    -------
    Trajectory
        Within the limits.

    Raises
    ------
    InvalidInputError
        If a joint has no acceleration limit.
    TimingError
        If prescribed durations are too short; with feasible ones.
    LimitViolationError
        If gravity alone exceeds an effort limit between the via points.

    """
    chain = chain_of(task)
    if task.durations is None:
        return _fastest(task, chain, None).trajectory
    motion = _prescribed(task, chain, task.durations) or _slowed_fastest(
        task, chain, task.durations)
    if motion is None:
        raise _too_short(task, chain, task.durations)
    return motion.trajectory


class _Motion(NamedTuple):
    """A motion within the kinematic limits, and the durations of its segments."""

    trajectory: PiecewiseTrajectory
    durations: Array


def _fastest(task: JointTask, chain: Chain, floor: Array | None) -> _Motion:
    """Return the motion of least total time, slowed where torque asks for it."""
    chain, motion, stretch = _holdable_motion(task, chain, floor)
    best, least = motion, motion.durations.sum() * max(1.0, stretch.max())
    lacking = np.zeros(len(stretch), dtype=bool)
    for _ in range(SLOWING_ROUNDS):
        lacking |= stretch > 1.0
        if not lacking.any() or np.isinf(stretch).any():
            break
        # as long as torque asks for, neither more nor less
        slow = np.where(lacking, motion.durations * stretch, 0.0)
        slow = slow if floor is None else np.maximum(slow, floor)
        motion = _least_time_motion(task, chain, slow)
        stretch = _segment_stretch(task, motion)
        total = motion.durations.sum() * max(1.0, stretch.max())
        if total < least:
            best, least = motion, total
    return _stretched_for_torque(task, best)


def _holdable_motion(task: JointTask, chain: Chain,
                     floor: Array | None) -> tuple[Chain, _Motion, Array]:
    """
    Return the motion of least time whose path can be held against gravity, and torque's stretch.

    Lower via velocities straighten the path; if gravity is too much even from rest to rest, the
    stretch says so by being infinite.
    """
    for _ in range(STRAIGHTENING_ROUNDS):
        motion = _least_time_motion(task, chain, floor)
        stretch = _segment_stretch(task, motion)
        blocked = np.isinf(stretch)
        if not blocked.any():
            return chain, motion, stretch
        chain = _slower_at(chain, np.tile(blocked[:, np.newaxis], 3))
    motion = _least_time_motion(task, _at_rest(chain), floor)
    return _at_rest(chain), motion, _segment_stretch(task, motion)


def _least_time_motion(task: JointTask, chain: Chain, floor: Array | None) -> _Motion:
    """Return the motion of least total time within the kinematic limits."""
    for round_ in range(OVERSHOOT_ROUNDS + 1):
        if round_ == OVERSHOOT_ROUNDS:
            chain = _at_rest(chain)
        durations = least_time(chain, floor).durations * (1.0 + DURATION_ROOM)
        motion, overshoot = _motion(task, chain, durations)
        if motion is not None and not overshoot.any():
            return motion
        chain = _slower_at(chain, overshoot)
    raise ConvergenceError('cycloid: even stops at the via points overshoot a range')


def _prescribed(task: JointTask, chain: Chain, durations: Array) -> _Motion | None:
    """
    Return a motion of given durations within all limits; None if none is found.

    Where the gentle one lacks torque, the fastest of the same proportions may have it once it is
    slowed to these durations; else lower via velocities may help.
    """
    for round_ in range(STRAIGHTENING_ROUNDS + 1):
        if round_ == STRAIGHTENING_ROUNDS:
            chain = _at_rest(chain)
        for gently in (True, False):
            motion = _with_durations(task, chain, durations, gently)
            if motion is None:
                return None
            stretch = _segment_stretch(task, motion)
            if torque_stretch(task, motion.trajectory) <= 1.0 + TORQUE_TOLERANCE:
                return motion
        lacking = stretch > 1.0
        chain = _slower_at(chain, np.tile(lacking[:, np.newaxis], 3))
    return None


def _slowed_fastest(task: JointTask, chain: Chain, durations: Array) -> _Motion | None:
    """Return the fastest motion, slowed, if that gives the durations; else None."""
    fastest = _fastest(task, chain, None)
    slower = float(np.mean(durations / fastest.durations))
    if slower < 1.0 - STRETCH_TOLERANCE or (
            np.abs(durations - slower * fastest.durations).max() > DURATION_TOLERANCE):
        return None
    return _Motion(fastest.trajectory.stretched(slower), durations)


def _with_durations(task: JointTask, chain: Chain, durations: Array,
                    gently: bool) -> _Motion | None:
    """Return a motion of given durations within the kinematic limits; None if there is none."""
    for round_ in range(OVERSHOOT_ROUNDS + 1):
        if round_ == OVERSHOOT_ROUNDS:
            chain = _at_rest(chain)
        motion, overshoot = _motion(task, chain, durations, gently)
        if motion is None or not overshoot.any():
            return motion
        chain = _slower_at(chain, overshoot)
    return motion


def _motion(task: JointTask, chain: Chain, durations: Array,
            gently: bool = True) -> tuple[_Motion | None, BoolArray]:
    """
    Return a motion of given durations, and which segments overshoot a joint's range.

    Time to spare makes it gentle, or else slows the fastest motion of the same proportions.
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
    trajectory = segment_motion.trajectory(task.points, v0, v1, T[:, np.newaxis], parts)
    if factor != 1.0:
        trajectory = trajectory.stretched(1.0 / factor)
    return _Motion(trajectory, durations), _overshoot(task, trajectory)


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


def _slower_at(chain: Chain, segments: BoolArray) -> Chain:
    """Return the chain with lower velocities at the ends of some segments."""
    at_ends = segments[:-1] | segments[1:]
    factor = np.where(at_ends, OVERSHOOT_REDUCTION, 1.0)
    return replace(chain, lowest=np.minimum(chain.lowest * factor, -LEAST_VELOCITY),
                   highest=np.maximum(chain.highest * factor, LEAST_VELOCITY))


def _at_rest(chain: Chain) -> Chain:
    """Return the chain with a stop at every via point: its motions never overshoot."""
    still = np.full_like(chain.highest, LEAST_VELOCITY)
    return replace(chain, lowest=-still, highest=still)


def _segment_stretch(task: JointTask, motion: _Motion) -> Array:
    """Return by how much torque asks each segment to be stretched, shape (n,)."""
    if np.isinf(task.limits.max_effort).all():
        return np.zeros(len(motion.durations))
    t = torque_grid(motion.trajectory)
    squared = squared_stretch(task.model, task.limits, motion.trajectory, t).max(axis=1)
    segment = np.searchsorted(motion.trajectory.via_times[1:-1], t, side='right')
    worst = np.zeros(len(motion.durations))
    np.maximum.at(worst, segment, squared)
    return np.sqrt(worst)


def _stretched_for_torque(task: JointTask, motion: _Motion) -> _Motion:
    """Return the motion slowed as a whole, just enough for its torques."""
    factor = torque_stretch(task, motion.trajectory)
    if np.isinf(factor):
        raise cannot_hold(task, motion.trajectory)
    if factor <= 1.0 + TORQUE_TOLERANCE:
        return motion
    return _Motion(motion.trajectory.stretched(factor), motion.durations * factor)


def _too_short(task: JointTask, chain: Chain, durations: Array) -> TimingError:
    """Return the error of prescribed durations that are too short, with feasible ones."""
    feasible = _least_feasible(task, chain, durations)
    asked, offered = ([round(float(d), 9) for d in v] for v in (durations, feasible))
    short = np.flatnonzero(durations * (1.0 + 2.0 * DURATION_ROOM) < feasible - 2e-6).tolist()
    return TimingError(
        f'segment_durations {asked} s are too short for segment'
        f'{"s" * (len(short) > 1)} {", ".join(map(str, short))}: the least feasible are '
        f'{offered} s', tuple(offered))


def _least_feasible(task: JointTask, chain: Chain, durations: Array) -> Array:
    """Return feasible durations in whole microseconds, none shorter than asked for."""
    for candidate in (_fastest(task, chain, durations), _fastest_with_stops(
            task, chain, durations)):
        for room in (0.0, 1e-6, 1e-5, 1e-4, 1e-3):
            feasible = np.ceil(candidate.durations * (1.0 + room) * 1e6) / 1e6
            if _prescribed(task, chain, feasible) is not None:
                return np.asarray(feasible)
    raise ConvergenceError(
        f'no feasible durations found for segment_durations {durations.tolist()} s')


def _fastest_with_stops(task: JointTask, chain: Chain, floor: Array) -> _Motion:
    """Return the motion of least total time with a stop at every via point."""
    stops = _at_rest(chain)
    return _stretched_for_torque(task, _least_time_motion(task, stops, floor))
