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

"""Via points in another frame: the transform, the wait for it, and what is said without it."""

from __future__ import annotations

from importlib.util import find_spec
from math import inf, nan, sqrt
import sys
from threading import Event
from types import SimpleNamespace

from geometry_msgs.msg import Quaternion, TransformStamped, Vector3
from helpers.plan_requests import is_refused, patient, plan_request, points_of, TABLE_6_1
import numpy as np
import pytest
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.node import Node
from rclpy.task import Future
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.nodes.planner_node.frame_transforms import (
    FrameError,
    in_base_frame,
    in_time,
)
from rrr_traj_planner.nodes.planner_node.node import TrajectoryPlanner
from rrr_traj_planner_interfaces.srv import PlanTrajectory
from scipy.spatial.transform import Rotation
from std_srvs.srv import Trigger

CODES = PlanTrajectory.Response
ROUNDING = 1e-14
DEADLINE = 20.0


def transform(rotation=(0.0, 0.0, 0.0, 1.0), translation=(0.0, 0.0, 0.0)):
    """Return the transform from a camera to the base."""
    found = TransformStamped(child_frame_id='camera')
    found.header.frame_id = 'base_link'
    found.transform.rotation = Quaternion(**dict(zip('xyzw', map(float, rotation))))
    found.transform.translation = Vector3(**dict(zip('xyz', map(float, translation))))
    return found


def test_a_quarter_turn_about_z_and_a_shift():
    turned = in_base_frame(np.array([[1.0, 0.0, 0.5], [0.0, 2.0, 0.0]]), transform(
        (0.0, 0.0, sqrt(0.5), sqrt(0.5)), (10.0, 20.0, 30.0)))
    assert turned == pytest.approx(np.array([[10.0, 21.0, 30.5], [8.0, 20.0, 30.0]]), abs=ROUNDING)


def test_any_rotation_is_scipy_s():
    rng = np.random.default_rng(0)
    points = rng.normal(size=(5, 3))
    for rotation in Rotation.random(10, random_state=1):
        shift = rng.normal(size=3)
        rounded = np.round(rotation.as_quat(), 6)  # as a file has it
        expected = Rotation.from_quat(rounded).apply(points) + shift
        assert in_base_frame(points, transform(rounded, shift)) == pytest.approx(
            expected, abs=10.0 * ROUNDING)


@pytest.mark.parametrize(('rotation', 'translation'), [
    ((0.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0)), ((0.0, 0.0, 1.0, 1.0), (0.0, 0.0, 0.0)),
    ((nan, 0.0, 0.0, 1.0), (0.0, 0.0, 0.0)), ((0.0, 0.0, 0.0, 1.0), (inf, 0.0, 0.0))])
def test_what_is_no_rotation_and_translation_is_refused(rotation, translation):
    with pytest.raises(FrameError, match=(
            "^the transform from frame 'camera' to the base frame 'base_link' has the rotation "
            '.*: correct who publishes it, for the norm must be')):
        in_base_frame(np.zeros((1, 3)), transform(rotation, translation))


class Waiting(Node):
    """A node with a service that waits for a future, and one that sets it."""

    def __init__(self, timeout, **kwargs):
        super().__init__('waiting', **kwargs)
        self.future, self.begun, self._timeout = Future(), Event(), timeout
        group = ReentrantCallbackGroup()
        self.create_service(Trigger, 'wait', self._wait, callback_group=group)
        self.create_service(Trigger, 'set', self._set, callback_group=group)

    async def _wait(self, _, response):
        self.begun.set()
        response.success = await in_time(self, self.future, self._timeout)
        return response

    def _set(self, _, response):
        self.future.set_result(True)
        return response


def test_a_wait_ends_with_the_future_and_the_executor_does_other_work_meanwhile(ros):
    node = ros.add(Waiting(10.0 * DEADLINE, context=ros.context))
    client = ros.node.create_client(Trigger, 'wait')
    assert client.wait_for_service(DEADLINE)
    answer, arrived = client.call_async(Trigger.Request()), Event()
    answer.add_done_callback(lambda _: arrived.set())
    assert node.begun.wait(DEADLINE)
    assert not answer.done()
    ros.call(Trigger, 'set')  # served by the same executor
    assert arrived.wait(DEADLINE)
    assert answer.result().success


def test_a_wait_ends_after_its_time(ros):
    ros.add(Waiting(0.01, context=ros.context))
    assert not ros.call(Trigger, 'wait').success


@pytest.mark.parametrize('stamp', [0, -1])
def test_via_points_in_a_frame_without_transform_are_refused_and_the_node_continues(ros, stamp):
    ros.add(TrajectoryPlanner(
        context=ros.context, parameter_overrides=patient(transform_timeout=0.1)))
    request = plan_request(frame='camera')
    request.via_points.header.stamp.sec = stamp
    response = ros.call(PlanTrajectory, 'plan_trajectory', request)
    is_refused(response, CODES.FRAME_TRANSFORM_FAILURE,
               "via_points are in frame 'camera', ")
    assert "the base frame 'base_link'" in response.message
    assert ": give them in 'base_link', or " in response.message
    if stamp < 0:
        assert "with the stamp -1 s: give them in 'base_link', or the stamp 0" in response.message
    elif find_spec('tf2_ros') is None:
        assert ', or install tf2_ros (apt: ros-jazzy-tf2-ros-py)' in response.message
    assert ros.call(PlanTrajectory, 'plan_trajectory', plan_request()).error_code == CODES.SUCCESS


class Buffer:
    """A tf2 buffer that gets no transform."""

    def wait_for_transform_async(self, *_):
        return Future()

    def lookup_transform(self, *_):
        raise KeyError('"camera" passed to lookupTransform\n does not exist.')


def test_transform_that_does_not_come_is_told_with_both_frames_and_what_to_do(ros, monkeypatch):
    monkeypatch.setitem(sys.modules, 'tf2_ros', SimpleNamespace(
        Buffer=Buffer, TransformListener=lambda *_: None, TransformException=KeyError))
    ros.add(TrajectoryPlanner(
        context=ros.context, parameter_overrides=patient(transform_timeout=0.1)))
    response = ros.call(PlanTrajectory, 'plan_trajectory', plan_request(frame='camera'))
    is_refused(response, CODES.FRAME_TRANSFORM_FAILURE, (
        "via_points are in frame 'camera', and no transform to the base frame 'base_link' has "
        "arrived in 0.1 s: give them in 'base_link', or publish the transform on /tf or "
        '/tf_static (tf2: '))
    assert '"camera" passed to lookupTransform' in response.message


def test_via_points_in_another_frame_are_transformed_where_tf2_is_installed(ros):
    tf2_ros = pytest.importorskip('tf2_ros')
    ros.add(TrajectoryPlanner(context=ros.context, parameter_overrides=patient(
        transform_timeout=DEADLINE / 2.0)))
    quarter = transform((0.0, 0.0, sqrt(0.5), sqrt(0.5)), (0.1, 0.2, 0.3))
    tf2_ros.StaticTransformBroadcaster(ros.node).sendTransform(quarter)
    # p = R q + t, so q = R^T (p - t); R turns by a quarter about z
    seen = [(y - 0.2, 0.1 - x, z - 0.3) for x, y, z in TABLE_6_1]
    response = ros.call(PlanTrajectory, 'plan_trajectory', plan_request(seen, frame='camera'))
    assert response.error_code == CODES.SUCCESS, response.message
    motion = points_of(response.trajectory)
    index = [np.abs(motion.times - t).argmin() for t in response.via_times]
    assert forward_kinematics(RobotModel(), motion.positions[index]) == pytest.approx(
        np.array(TABLE_6_1), abs=1e-9)
