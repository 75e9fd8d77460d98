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

"""Replanning in motion, as docs/replanning.md does it: the arm joins new plans without a step."""

from __future__ import annotations

import re
import signal
import sys

from helpers.arm_in_ros import Arm
from helpers.motion_in_ros import assert_steady, random_places, RATE, SteppedClock
from helpers.places import DOCS
from helpers.plan_requests import points_of
from helpers.planner_in_ros import start_planner
from helpers.scripts import DEADLINE, Script, script
import numpy as np
from rclpy.duration import Duration
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner_interfaces.srv import PlanTrajectory
from trajectory_msgs.msg import JointTrajectory

CODE, = re.findall(r'^```python\n(.*?)^```', (DOCS / 'replanning.md').read_text(),
                   re.DOTALL | re.MULTILINE)
INSTANTS = 100
STEP = 1e-9  # rad, rad/s, rad/s^2: between what ends and what begins at a point


def the_document_s():
    """Return the functions of the document's example."""
    names = {'__name__': 'example'}
    exec(CODE, names)
    return names


def test_the_arm_joins_plans_made_in_motion_without_a_step(ros):
    rng, model, example = np.random.default_rng(4), RobotModel(), the_document_s()
    arm = Arm(ros, use_sim_time=True, publish_rate=RATE)
    start_planner(ros)
    clock = SteppedClock(ros)
    publisher = ros.publisher(JointTrajectory, 'joint_trajectory')
    client = ros.node.create_client(PlanTrajectory, 'plan_trajectory')
    assert client.wait_for_service(DEADLINE)
    clock.advance(arm, 0.1)
    joined, running = 0, None
    while joined < INSTANTS:
        k = example['joint'](running, clock.now()) if running else None
        places = random_places(rng, model)
        if k is not None:
            request = example['onward'](running, k, places)
        else:
            if running:  # it ends soon
                clock.advance(arm, 2.0 * example['AHEAD'])
            request = PlanTrajectory.Request(
                via_points=example['poses'](places), planner_id='time_optimal',
                start_state=arm.actual.messages[-1])
        answer = client.call(request, timeout_sec=DEADLINE)
        assert answer.error_code == answer.SUCCESS, answer.message
        clock.advance(arm, rng.uniform(0.0, 0.1))  # as planning takes
        if k is None:
            running = answer.trajectory
            running.header.stamp = (clock.now() + Duration(seconds=0.1)).to_msg()
        elif example['is_in_time'](running, k, clock.now()):
            before = points_of(running)
            running = example['spliced'](running, k, answer.trajectory, clock.now())
            assert_continues(before, points_of(running), k)
            joined += 1
        publisher.publish(running)
        clock.advance(arm, rng.uniform(0.02, 0.2))
    assert_steady(arm.desired.messages[:])  # more may arrive


def assert_continues(before, after, k):
    """Assert that a motion has the points of one before up to point k, with the same states."""
    first = int(np.searchsorted(before.times, after.times[0] - STEP))
    for field in ('times', 'positions', 'velocities', 'accelerations'):
        expected = getattr(before, field)[first:k + 1]
        assert np.abs(getattr(after, field)[:len(expected)] - expected).max() <= STEP


def test_the_document_s_example_replans_in_motion():
    with Script(script('planner')), Script(script('simulated_arm')) as arm:
        with Script([sys.executable, '-c', CODE]) as example:
            status, text, _ = example.ended()
        arm.process.send_signal(signal.SIGINT)
        _, _, log = arm.ended()
    assert status == 0
    assert len(re.findall(r'^turn \d: joined at point \d+$', text, re.MULTILINE)) >= 3
    more = map(int, re.findall(r'\((\d+) more since the last such line\)', log))
    assert len(re.findall(r'following \d+ points', log)) + sum(more) >= 4
