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

"""The node `trajectory_planner`: bugs of planners, its log, and what it publishes."""

from __future__ import annotations

from helpers.plan_requests import is_refused, NEAR, points_of, TABLE_6_3
from helpers.planner_in_ros import plan, start_planner
from nav_msgs.msg import Path
import numpy as np
import pytest
from rcl_interfaces.msg import Log
from rclpy.qos import DurabilityPolicy, QoSProfile
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.errors import ConvergenceError
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.planners import registration
from rrr_traj_planner_interfaces.srv import PlanTrajectory
from trajectory_msgs.msg import JointTrajectory

CODES = PlanTrajectory.Response
LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)

# A bug in the planning thread would go unseen otherwise.
pytestmark = pytest.mark.filterwarnings(
    'error::pytest.PytestUnhandledThreadExceptionWarning')


@pytest.mark.parametrize(('error', 'text'), [
    (RuntimeError('no idea'), 'internal error, RuntimeError: no idea'),
    (ConvergenceError('planner broken broke a limit'),
     'internal error, ConvergenceError: planner broken broke a limit'),
    (MemoryError(), 'internal error, MemoryError')])
def test_bug_is_reported_logged_and_survived(ros, monkeypatch, error, text):
    def broken(task):
        raise error

    monkeypatch.setitem(registration.REGISTERED, 'broken', registration.Registered(broken, False))
    log = ros.listen(Log, '/rosout', 100)
    start_planner(ros)
    is_refused(plan(ros, planner_id='broken'), CODES.FAILURE, text)
    logged = log.wait_for(lambda m: text in m.msg)
    assert 'Traceback' in logged.msg
    assert 'in broken' in logged.msg
    assert plan(ros).error_code == CODES.SUCCESS


def test_answer_that_cannot_be_written_is_no_success(ros, monkeypatch):
    def broken(*_):
        raise RuntimeError('no message')

    monkeypatch.setattr('rrr_traj_planner.nodes.planner_node.node.success', broken)
    start_planner(ros)
    published = ros.listen(JointTrajectory, 'planned_trajectory', LATCHED)
    is_refused(plan(ros), CODES.FAILURE, 'internal error, RuntimeError: no message')
    monkeypatch.undo()
    good = plan(ros)
    assert published.wait_for() == good.trajectory


def test_each_request_is_one_line_in_the_log(ros):
    log = ros.listen(Log, '/rosout', 100)
    start_planner(ros)
    plan(ros)
    log.wait_for(lambda m: m.msg.startswith('cycloid planned 3 via points in ')
                 and m.msg.endswith(' ms: 2.850 s, 286 points'))
    plan(ros, TABLE_6_3)
    refused = log.wait_for(lambda m: m.msg.startswith('cycloid refused in '))
    assert refused.msg.endswith(
        ' ms (-14): via point 2: joint_2 needs 218.9 N m to hold, limit 200 N m')
    assert refused.level == Log.WARN


def test_late_subscriber_gets_the_last_success(ros):
    start_planner(ros)
    plan(ros)
    last = plan(ros, NEAR)
    plan(ros, TABLE_6_3)  # refused
    trajectory = ros.listen(JointTrajectory, 'planned_trajectory', LATCHED)
    path = ros.listen(Path, 'planned_path', LATCHED)
    assert trajectory.wait_for() == last.trajectory
    tip = [(p.pose.position.x, p.pose.position.y, p.pose.position.z)
           for p in path.wait_for().poses]
    np.testing.assert_allclose(tip, forward_kinematics(
        RobotModel(), points_of(last.trajectory).positions), atol=1e-12)
    header = path.messages[0].header
    assert header.frame_id == 'base_link'
    assert header.stamp.sec > 0
    assert all(p.header == header for p in path.messages[0].poses)
    assert all(p.pose.orientation.w == 1.0 for p in path.messages[0].poses)


def test_refusal_is_not_published(ros):
    start_planner(ros)
    listeners = [ros.listen(JointTrajectory, 'planned_trajectory', LATCHED),
                 ros.listen(Path, 'planned_path', LATCHED)]
    first = plan(ros)
    for listener in listeners:
        listener.wait_for()
    plan(ros, TABLE_6_3)
    second = plan(ros, NEAR)
    listeners[1].wait_for(since=1)
    assert listeners[0].wait_for(since=1) == second.trajectory
    assert listeners[0].messages == [first.trajectory, second.trajectory]
    assert len(listeners[1].messages) == 2
