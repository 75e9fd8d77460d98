"""
`cycloid_approach_c`: every segment lifts off, cruises and sets down (4.2, c; after Lin).

Lift-off is a transition from rest and set-down one to rest, full-period cycloids both: the arm
stops at every via point. With velocities at the via points left free, the same three parts make
`cycloid`.
"""

from __future__ import annotations

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.cycloid_transitions import CYCLOID
from rrr_traj_planner.core.errors import TimingError
from rrr_traj_planner.core.piecewise import PiecewiseTrajectory
from rrr_traj_planner.core.trajectory import Trajectory
from rrr_traj_planner.planners.barrier import Chain
from rrr_traj_planner.planners.motion_law import cannot_hold, chain_of, torque_stretch
from rrr_traj_planner.planners.registry import register
from rrr_traj_planner.planners.request import JointTask
from rrr_traj_planner.planners.segment_motion import Parts, quick_parts, trajectory

ROOM = 1e-6                # durations are longer than the least by this part
DURATION_TOLERANCE = 1e-7  # relative, by which prescribed durations may fall short


@register('cycloid_approach_c', some_durations=True)
def plan(task: JointTask) -> Trajectory:
    """
    Return the fastest motion of approach (c), or one of prescribed durations.

    Parameters
    ----------
    task : JointTask
        What is asked; durations that are NaN are free.

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
    chain = chain_of(task, CYCLOID)
    # where nothing moves, any duration will do
    quick = np.maximum(chain.rest_to_rest_times() * (1.0 + ROOM), task.sample_period * ROOM)
    rest = np.zeros_like(chain.displacements)
    parts = quick_parts(chain.law, rest, rest, quick[:, np.newaxis], chain.displacements)
    least = quick * _stretches(task, chain, quick, parts)
    durations = least if task.durations is None else np.where(
        np.isnan(task.durations), least, task.durations)
    if (durations < least * (1.0 - DURATION_TOLERANCE)).any():
        raise _too_short(task, durations, least)
    return _motion(task.points, chain, durations, _slowed(parts, durations / quick))


def _motion(points: Array, chain: Chain, durations: Array, parts: Parts) -> PiecewiseTrajectory:
    """Return the motion that stops at every via point."""
    rest = np.zeros((len(durations), 3))
    return trajectory(points, rest, rest, durations[:, np.newaxis], parts, chain.function)


def _slowed(parts: Parts, factors: Array) -> Parts:
    """Return the parts of every segment run through more slowly by its factor."""
    factor = factors[:, np.newaxis]
    return Parts(parts.first * factor, parts.cruise / factor, parts.last * factor)


def _stretches(task: JointTask, chain: Chain, durations: Array, parts: Parts) -> Array:
    """Return by how much torque asks each segment to be slowed, at least 1."""
    stretches = np.ones(len(durations))
    for k in range(len(durations)):
        own = slice(k, k + 1)
        alone = _motion(task.points[k:k + 2], chain, durations[own], Parts(*(
            part[own] for part in parts)))
        stretches[k] = max(1.0, torque_stretch(task, alone))
    if np.isinf(stretches).any():
        raise cannot_hold(task, _motion(task.points, chain, durations, parts))
    return stretches


def _too_short(task: JointTask, durations: Array, least: Array) -> TimingError:
    """Return the error of prescribed durations that are too short, with the least feasible."""
    short = [str(task.segment_number(k)) for k in np.flatnonzero(
        durations < least * (1.0 - DURATION_TOLERANCE)).tolist()]
    feasible = np.maximum(durations, np.ceil(least * 1e6) / 1e6)
    asked, offered = ([round(float(d), 9) for d in v] for v in (durations, feasible))
    return TimingError(
        f'segment_durations {asked} s are too short for segment{"s" * (len(short) > 1)} '
        f'{", ".join(short)}: the least feasible are {offered} s', tuple(offered))
