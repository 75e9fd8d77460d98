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

"""The planner's answer, as `move --dry-run` prints it."""

from __future__ import annotations

from rrr_traj_planner.nodes.output.message_times import seconds
from rrr_traj_planner.nodes.parameters.configuration import PlannerConfig
from rrr_traj_planner.nodes.runs.answer import CODES
from rrr_traj_planner.nodes.runs.table import peak_lines
from rrr_traj_planner_interfaces.srv import PlanTrajectory


def answer_text(response: PlanTrajectory.Response, config: PlannerConfig) -> str:
    """
    Return the planner's answer, for people.

    Parameters
    ----------
    response : PlanTrajectory.Response
        The answer.
    config : PlannerConfig
        The planner's.

    Returns
    -------
    str
        Code and message; of a plan also the times of the via points, the number of points, the
        first and the last of them, and the peaks against their limits.

    """
    lines = [f'error_code:    {response.error_code} {CODES.get(response.error_code, "")}'.rstrip()]
    if response.message:
        lines.append(f'message:       {response.message}')
    if response.error_code != response.SUCCESS:
        return '\n'.join(lines)
    points, names = response.trajectory.points, response.trajectory.joint_names
    lines += [f'planning_time: {1e3 * response.planning_time:.1f} ms',
              f'via_times:     {", ".join(f"{t:.3f}" for t in response.via_times)} s',
              f'trajectory:    {len(points)} points of {", ".join(names)}']
    for label, point in (('first', points[0]), ('last', points[-1])):
        q = ', '.join(f'{x:.4f}' for x in point.positions)
        lines.append(f'  {label:<5} at   {seconds(point.time_from_start):.3f} s: ({q}) rad')
    return '\n'.join([*lines, '', *peak_lines(response, config.limits, names)])
