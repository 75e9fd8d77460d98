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

"""The planner's answer in words."""

from __future__ import annotations

from rrr_traj_planner.core.errors import counted
from rrr_traj_planner_interfaces.srv import PlanTrajectory

Response = PlanTrajectory.Response
CODES = {getattr(Response, name): name for name in (
    'SUCCESS', 'PLANNING_FAILED', 'GOAL_CONSTRAINTS_VIOLATED', 'INVALID_GOAL_CONSTRAINTS',
    'FRAME_TRANSFORM_FAILURE', 'START_STATE_INVALID', 'NO_IK_SOLUTION', 'FAILURE')}


def planned_text(response: Response, planner_id: str) -> str:
    """
    Return what was planned, in a line.

    Parameters
    ----------
    response : PlanTrajectory.Response
        A plan.
    planner_id : str
        The planner.

    Returns
    -------
    str
        Number of via points, planner, planning time, duration, number of points.

    """
    return (f'planned {counted(len(response.via_times), "via point")} with '
            f"'{planner_id}' in {1e3 * response.planning_time:.0f} ms: "
            f'{response.via_times[-1]:.3f} s, '
            f'{counted(len(response.trajectory.points), "point")}')


def refused_text(response: Response) -> str:
    """
    Return why the planner refuses, in a line.

    Parameters
    ----------
    response : PlanTrajectory.Response
        No plan.

    Returns
    -------
    str
        Code and message.

    """
    return f'the planner refuses ({response.error_code}): {response.message}'
