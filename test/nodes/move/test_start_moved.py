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

"""`move` sends nothing where the arm has moved while the plan was made."""

from __future__ import annotations

from helpers.arm_in_ros import Arm, at, GOAL, rest_to_rest, START
from helpers.move_script import moved
from helpers.plan_requests import NAMES
from helpers.planner_in_ros import start_planner
import numpy as np
from rrr_traj_planner.nodes.parameters.configuration import PlannerConfig
from rrr_traj_planner.nodes.parameters.table import PLANNER, rows_of
from rrr_traj_planner.nodes.planner_node.planning_answer import success
from rrr_traj_planner.nodes.planner_node.planning_request import planning_request
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner_interfaces.srv import PlanTrajectory


def test_plan_whose_start_the_arm_has_left_is_not_sent(ros, other_ros, tmp_path):
    start_planner(ros)
    arm = Arm(ros)
    config = PlannerConfig.from_values({
        name: row.default for name, row in rows_of(PLANNER, NAMES).items()})

    def answer(request, _):
        """Plan, but have somebody move the arm meanwhile."""
        found = plan(config.model, config.limits, planning_request(request, config))
        arm.send(rest_to_rest(GOAL, 0.5))
        arm.actual.wait_for(at(GOAL))
        return success(found, config)

    other_ros.node.create_service(PlanTrajectory, 'slow_planner', answer)
    (tmp_path / 'taught.csv').write_text('joint_1,joint_2,joint_3\n0.6,1.0,0.2\n0.7,1.1,0.1\n')
    code, output, errors = moved(
        'taught.csv', '--ros-args', '-r', 'plan_trajectory:=slow_planner', cwd=tmp_path)
    assert code == 1
    assert np.abs(GOAL - START).argmax() == 2
    assert errors == ('move: joint_3 has moved by 0.06 rad since the plan was asked for, allowed '
                      '0.01 rad: nothing is sent\n')
    assert 'executing' not in output
    arm.actual.wait_for_next(at(GOAL))
