"""
`septic`: as `cycloid`, with transitions of the seventh order (C.1-C.11).

As with the cycloid, jerk is zero where a transition begins and ends.
"""

from __future__ import annotations

from rrr_traj_planner.core.septic import SEPTIC
from rrr_traj_planner.core.trajectory import Trajectory
from rrr_traj_planner.planners.free_via_velocities import planned
from rrr_traj_planner.planners.registry import register
from rrr_traj_planner.planners.request import JointTask


@register('septic')
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
    return planned(task, SEPTIC)
