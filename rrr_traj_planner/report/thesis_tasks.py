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

"""The thesis's tasks: tables 6.1 and 6.3, for the arm of tables 6.2 and B.1 to B.3."""

from __future__ import annotations

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.planners.request import PlanningRequest
from rrr_traj_planner.report.attempts import Task

TABLE_6_1 = ((1.02, 0.59, 0.97), (0.46, 0.55, 1.44), (0.45, 0.38, 1.45))  # m
TABLE_6_3 = ((0.2, 0.8, 0.5), (0.5, 1.0, 1.0), (0.8, 1.2, 0.6))           # m
STRONGER_JOINT_2 = (150.0, 250.0, 200.0)  # N m: table 6.3's last point takes 218.9 to hold


def table_6_1() -> Task:
    """Return the task of table 6.1, for the thesis's arm (tables 6.2 and B.1 to B.3)."""
    return Task('table 6.1', RobotModel(), JointLimits(), PlanningRequest(np.array(TABLE_6_1)))


def table_6_3() -> Task:
    """Return the task of table 6.3, for an arm whose joint 2 can hold its last point."""
    return Task('table 6.3', RobotModel(), JointLimits(max_effort=np.array(STRONGER_JOINT_2)),
                PlanningRequest(np.array(TABLE_6_3)))


def table_6_3_as_printed() -> Task:
    """Return the task of table 6.3 for the thesis's arm, which cannot hold its last point."""
    return Task('table 6.3, torques of table B.3', RobotModel(), JointLimits(),
                PlanningRequest(np.array(TABLE_6_3)))
