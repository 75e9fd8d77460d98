"""
`cycloid`: transition, cruise, transition in every segment, via velocities free, least total time.

Every transition is a full-period cycloid.
"""

from __future__ import annotations

from rrr_traj_planner.core.cycloid_transitions import CYCLOID
from rrr_traj_planner.core.trajectory import Trajectory
from rrr_traj_planner.planners.free_via_velocities import planned
from rrr_traj_planner.planners.registry import register
from rrr_traj_planner.planners.request import JointTask


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
    return planned(task, CYCLOID)
