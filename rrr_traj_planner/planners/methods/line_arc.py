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
`line_arc`: lines and circular arcs through every via point, as fast as limits allow.

The path is that of thesis 5.4.2; its timing: Bobrow, Dubowsky & Gibson, Time-optimal control of
robotic manipulators along specified paths, IJRR 4, 1985.
"""

from __future__ import annotations

from rrr_traj_planner.core.path.design import line_arc
from rrr_traj_planner.core.trajectory.trajectory import Trajectory
from rrr_traj_planner.planners.path_timing.planner import along
from rrr_traj_planner.planners.registration import register_path
from rrr_traj_planner.planners.tasks import CartesianTask


@register_path('line_arc')
def plan(task: CartesianTask) -> Trajectory:
    """
    Return the fastest motion of the tip on lines and arcs (5.63-5.68).

    The tip does not stop at the via points. Joint accelerations step where an arc begins or ends,
    within their limits; the note says by how much.

    Parameters
    ----------
    task : CartesianTask
        Via points, the arm and its limits.

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
