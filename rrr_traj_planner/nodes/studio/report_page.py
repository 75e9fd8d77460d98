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

"""The report of what the page shows: the page of `report --plan`, as one file."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

from rrr_traj_planner.nodes.parameters.configuration import PlannerConfig
from rrr_traj_planner.nodes.planner_node.planning_request import planning_request
from rrr_traj_planner.nodes.studio.requests import request_of
from rrr_traj_planner.nodes.studio.wanted import Wanted
from rrr_traj_planner.report.attempts import attempts, Task
from rrr_traj_planner.report.plan_report import write_plan_report


def report_page(wanted: Wanted, config: PlannerConfig, planner_ids: Sequence[str] = ()) -> bytes:
    """
    Return the report, planned again by the same request; takes seconds.

    Parameters
    ----------
    wanted : Wanted
        What is planned.
    config : PlannerConfig
        The planner's.
    planner_ids : sequence of str
        Planners to be shown beside the one that is wanted.

    Returns
    -------
    bytes
        A self-contained page; of a motion that is refused, it has the reason.

    Raises
    ------
    InvalidInputError
        If the request is malformed.
    ImportError
        If matplotlib is missing.

    """
    ids = list(dict.fromkeys((wanted.task.planner_id, *planner_ids)))
    task = Task(wanted.task.name, config.model, config.limits_for(*ids),
                planning_request(request_of(wanted), config))
    with TemporaryDirectory() as folder:
        return write_plan_report(Path(folder), attempts(task, ids)).read_bytes()


def report_name(wanted: Wanted) -> str:
    """
    Return the file's name.

    Parameters
    ----------
    wanted : Wanted
        What is planned.

    Returns
    -------
    str
        With the planner's id.

    """
    return f'report_{wanted.task.name}_{wanted.task.planner_id}.html'
