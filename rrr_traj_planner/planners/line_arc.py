"""`line_arc`: lines and arcs of circles through every via point, as fast as the limits allow."""

from __future__ import annotations

from rrr_traj_planner.core.path_design import line_arc
from rrr_traj_planner.core.trajectory import Trajectory
from rrr_traj_planner.planners.along_path import along
from rrr_traj_planner.planners.registry import register_path
from rrr_traj_planner.planners.request import CartesianTask


@register_path('line_arc')
def plan(task: CartesianTask) -> Trajectory:
    """
    Return the fastest motion of the tip on lines and arcs (5.63-5.68).

    The tip does not stop at the via points. Joint accelerations step where an arc begins or ends,
    within their limits; the note says by how much.

    Parameters
    ----------
    task : CartesianTask
        What is asked.

    Returns
    -------
    Trajectory
        Within the limits.

    Raises
    ------
    InvalidInputError
        If the path reverses, or has fewer than two points.
    UnreachableError, LimitViolationError
        If the arm cannot follow the path; with the place.

    """
    return along(task, line_arc)
