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

"""The README's client and its example of a URDF, run unchanged."""

from __future__ import annotations

from helpers.examples import example
from helpers.places import ROOT
from helpers.plan_requests import TABLE_6_1
from helpers.scripts import python, Script, script
import numpy as np
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.request import PlanningRequest
from sensor_msgs.msg import JointState

README, MODEL = ROOT / 'README.md', RobotModel()


def test_library_s_example_of_a_urdf_is_planned_with_its_own_limits(monkeypatch):
    code = example(README, 'read_urdf')
    monkeypatch.chdir(ROOT)
    names = {'plan': plan, 'PlanningRequest': PlanningRequest}
    exec(code, names)
    assert (names['found'].peaks.velocity <= names['arm'].max_velocity).all()
    assert names['limits'].max_effort.tolist() == [23.7, 23.7, 35.55]


def test_client_s_trajectory_reaches_an_arm_that_is_found_late(ros):
    code = example(README, 'create_client')
    states = ros.listen(JointState, 'joint_states')
    with Script(script('planner')) as planner, Script(python(code)) as client:
        planner.read_errors_until('cycloid planned 3 via points in ')
        with Script(script('simulated_arm')) as arm:
            arm.read_errors_until('following ')
            states.wait_for_next(lambda m: np.allclose(  # it may have been found at the end only
                forward_kinematics(MODEL, m.position), TABLE_6_1[-1], atol=1e-4))
            assert client.ended() == (0, '', '')
