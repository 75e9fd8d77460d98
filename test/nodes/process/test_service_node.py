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

"""Services answer clients that are discovered late."""

from __future__ import annotations

import warnings

from helpers.plan_requests import NEAR, plan_request
import pytest
from rcl_interfaces.msg import Log
from rcl_interfaces.srv import GetParameters
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.service import Service
from rrr_traj_planner.nodes.arm_node.node import SimulatedArm
from rrr_traj_planner.nodes.planner_node.node import TrajectoryPlanner
from rrr_traj_planner.nodes.process import responses
from rrr_traj_planner_interfaces.srv import PlanTrajectory
from std_srvs.srv import Trigger

NAMES = GetParameters.Request(names=['joint_names'])
DROPS = 2

# Its response reader requires a stricter quality of service than offered: DDS never matches them.
NEVER_MATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


@pytest.mark.parametrize(('node', 'service', 'name', 'request_'), [
    (TrajectoryPlanner, PlanTrajectory, 'plan_trajectory', plan_request(NEAR)),
    (TrajectoryPlanner, GetParameters, 'trajectory_planner/get_parameters', NAMES),
    (SimulatedArm, Trigger, 'simulated_arm/reset', None),
    (SimulatedArm, GetParameters, 'simulated_arm/get_parameters', NAMES)])
def test_answer_that_was_dropped_is_sent_again(ros, monkeypatch, node, service, name, request_):
    send, dropped = Service.send_response, []

    def drop_at_first(self, response, header):
        if len(dropped) == DROPS:
            return send(self, response, header)
        dropped.append(response)
        warnings.warn('failed to send response (timeout): client will not receive response',
                      RuntimeWarning, stacklevel=2)

    monkeypatch.setattr(Service, 'send_response', drop_at_first)
    ros.add(node(context=ros.context))
    assert isinstance(ros.call(service, name, request_), service.Response)
    assert dropped == [dropped[0]] * DROPS


def test_client_that_is_never_discovered_is_warned_of_and_delays_no_other(ros, monkeypatch):
    monkeypatch.setattr(responses, 'MAX_WAIT', 2.0 * responses.FIRST_WAIT)
    log = ros.listen(Log, '/rosout')
    ros.add(SimulatedArm(context=ros.context))
    assert ros.call(Trigger, 'simulated_arm/reset').success
    stranger = ros.node.create_client(Trigger, 'simulated_arm/reset', qos_profile=NEVER_MATCHED)
    answer = stranger.call_async(Trigger.Request())
    assert ros.call(Trigger, 'simulated_arm/hold').success
    log.wait_for(lambda m: m.msg == (
        'a response of /simulated_arm/reset is lost: its client has not been discovered'))
    assert not answer.done()
