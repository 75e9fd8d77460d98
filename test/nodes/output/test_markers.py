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

"""Visualization by both nodes: robot_description and markers."""

from __future__ import annotations

from helpers.arm_in_ros import Arm, at, GOAL, rest_to_rest, START
from helpers.other_arms import OTHER_ARMS
from helpers.plan_requests import patient, plan_request, TABLE_6_1, TABLE_6_3
from helpers.thesis_arm import ThesisArm
import numpy as np
import pytest
from rclpy.qos import DurabilityPolicy, QoSProfile
from rrr_traj_planner.core.arm.friction import Friction
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arm.urdf import FrameNames, urdf
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.kinematics.link_positions import link_positions
from rrr_traj_planner.core.trajectory.trajectory_points import TrajectoryPoints
from rrr_traj_planner.nodes.output.marker_messages import (
    arm_markers,
    MAX_POINTS,
    plan_markers,
)
from rrr_traj_planner.nodes.planner_node.node import TrajectoryPlanner
from rrr_traj_planner_interfaces.srv import PlanTrajectory
from std_msgs.msg import String
from visualization_msgs.msg import Marker, MarkerArray

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
ON_THE_SPOT = 1e-9  # m
MODEL = RobotModel()


def by_name(message):
    return {(m.ns, m.id): m for m in message.markers}


def places(points):
    return np.array([(p.x, p.y, p.z) for p in points])


def shows_the_plan(message):
    return any(m.ns == 'planned_path' and m.action == Marker.ADD for m in message.markers)


def shows(name, *points):
    """Return whether an arm's markers end at points."""
    def wanted(message):
        line = by_name(message).get(('executed_path', 0))
        return line is not None and line.action == Marker.ADD and all(
            np.abs(places(line.points[i:][:1]) - p).max() < 1e-3 for i, p in zip((0, -1), points))
    return wanted


# The arm's description


def test_description_is_the_urdf_of_the_parameters_for_whoever_comes_late(ros):
    Arm(ros, base_frame='floor', tip_frame='tool', link_names=['a', 'b', 'c'], **{
        'arm.d1': 0.25, 'joint_limits.joint_2.max_effort': 123.0})
    expected = urdf(ThesisArm(d1=0.25), JointLimits(max_effort=(150.0, 123.0, 200.0)),
                    FrameNames('floor', ('a', 'b', 'c'), 'tool'))
    for _ in range(2):
        assert ros.listen(String, 'robot_description', LATCHED).wait_for().data == expected


def test_description_follows_the_parameters_that_are_in_it_and_no_others(ros):
    arm = Arm(ros)
    description = ros.listen(String, 'robot_description', LATCHED)
    description.wait_for()
    assert arm.set_parameter('payload.mass', 1.0).successful
    assert arm.set_parameter('friction.coulomb', [1.0, 2.0, 3.0]).successful
    expected = urdf(RobotModel(friction=Friction(coulomb=(1.0, 2.0, 3.0))), JointLimits())
    description.wait_for(lambda m: m.data == expected)
    assert len(description.messages) == 2


@pytest.mark.parametrize('names', [
    {'base_frame': 'tip'}, {'tip_frame': 'link_2'}, {'link_names': ['a', 'a', 'b']}])
def test_frames_that_share_a_name_stop_the_arm(ros, names):
    with pytest.raises(ValueError, match='must be distinct and not empty'):
        Arm(ros, **names)


# The arm's markers


def test_markers_show_the_arm_where_it_is_and_where_it_has_been(ros):
    arm = Arm(ros)
    markers = ros.listen(MarkerArray, 'markers', LATCHED)
    at_rest = by_name(markers.wait_for())
    assert set(at_rest) == {('arm', i) for i in range(4)} | {('executed_path', 0)}
    arm.send(rest_to_rest(GOAL, 0.5))
    arm.desired.wait_for(at(GOAL))
    start, goal = forward_kinematics(MODEL, (START, GOAL))
    shown = by_name(markers.wait_for(shows('executed_path', start, goal)))
    line = shown['executed_path', 0]
    assert line.type == Marker.LINE_STRIP
    steps = np.linalg.norm(np.diff(places(line.points), axis=0), axis=1)
    assert 2 < len(steps) < 50 and steps[:-1].min() >= 0.02 > steps[-1]
    for marker in shown.values():
        assert marker.header.frame_id == 'base_link'
        assert marker.color.a == 1.0
        assert marker.scale.x > 0.0
    base, shoulder, elbow, _ = np.array(link_positions(MODEL, GOAL))
    np.testing.assert_allclose(
        places(shown['arm', 3].points), [shoulder, elbow], rtol=0.0, atol=1e-3)
    rods = [shown['arm', i] for i in range(3)]
    assert {m.type for m in rods} == {Marker.CYLINDER}
    np.testing.assert_allclose([m.scale.z for m in rods], [0.5, 0.9, 0.7], rtol=0.0, atol=1e-12)
    np.testing.assert_allclose(places([rods[1].pose.position]), [(shoulder + elbow) / 2],
                               rtol=0.0, atol=1e-3)


@pytest.mark.parametrize('name', OTHER_ARMS)
def test_markers_show_other_arms_from_joint_to_joint(name):
    model, q = OTHER_ARMS[name], (0.4, 0.5, -0.6)
    points = np.array(link_positions(model, q))
    found = by_name(arm_markers(model, 'base_link', link_positions(model, q), [points[-1]]))
    rods = [found['arm', i] for i in range(len(points) - 1)]
    assert set(found) == {('arm', i) for i in range(len(points))} | {('executed_path', 0)}
    assert {m.type for m in rods} == {Marker.CYLINDER}
    lengths = np.linalg.norm(np.diff(points, axis=0), axis=1)
    np.testing.assert_allclose([m.scale.z for m in rods], lengths, rtol=0.0, atol=1e-12)
    assert [m.action == Marker.DELETE for m in rods] == (lengths == 0.0).tolist()
    np.testing.assert_allclose(places([m.pose.position for m in rods]),
                               (points[1:] + points[:-1]) / 2, rtol=0.0, atol=1e-12)
    balls = found['arm', len(rods)]
    assert balls.type == Marker.SPHERE_LIST
    np.testing.assert_allclose(places(balls.points), points[1:-1], rtol=0.0, atol=1e-12)
    assert rods[-1].scale.x == pytest.approx(model.chain.size / 16.0)  # as thick as in the URDF


def test_markers_rest_while_the_arm_does_and_reset_clears_the_trail(ros):
    arm = Arm(ros, marker_rate=50.0)
    markers = ros.listen(MarkerArray, 'markers', LATCHED)
    arm.send(rest_to_rest(GOAL, 0.4))
    goal = forward_kinematics(MODEL, GOAL)
    arm.desired.wait_for(at(GOAL))
    markers.wait_for(shows('executed_path', forward_kinematics(MODEL, START), goal))
    count = len(arm.actual.messages)
    arm.actual.wait_for(at(GOAL, 1e-9), count)
    settled, count = len(markers.messages), len(arm.actual.messages)
    arm.actual.wait_for(lambda m: len(arm.actual.messages) > count + 100)  # half a second
    assert len(markers.messages) <= settled + 1
    assert arm.trigger('reset').success
    start = forward_kinematics(MODEL, START)
    markers.wait_for(lambda m: not len(by_name(m)['executed_path', 0].points) or np.abs(
        places(by_name(m)['executed_path', 0].points) - start).max() < 1e-3, settled)


def test_marker_rate_zero_ends_them_and_another_brings_them_back(ros):
    arm = Arm(ros, marker_rate=0.0)
    markers = ros.listen(MarkerArray, 'markers', LATCHED)
    arm.send(rest_to_rest(GOAL, 0.3))
    arm.desired.wait_for(at(GOAL))
    assert not markers.messages
    assert arm.set_parameter('marker_rate', 20.0).successful
    markers.wait_for()
    assert arm.set_parameter('marker_rate', 0.0).successful
    count = len(markers.messages)
    arm.send(rest_to_rest(START, 0.3))
    arm.desired.wait_for(at(START), len(arm.desired.messages))
    assert len(markers.messages) == count


# The planner's markers


def test_plan_is_shown_to_whoever_comes_late(ros):
    ros.add(TrajectoryPlanner(
        context=ros.context, parameter_overrides=patient(base_frame='floor')))
    cleared = by_name(ros.listen(MarkerArray, 'markers', LATCHED).wait_for())
    assert {name: m.action for name, m in cleared.items()} == {
        ('planned_path', 0): Marker.DELETE, ('via_points', 0): Marker.DELETE}
    response = ros.call(PlanTrajectory, 'plan_trajectory', plan_request())
    assert response.error_code == response.SUCCESS
    refused = ros.call(PlanTrajectory, 'plan_trajectory', plan_request(TABLE_6_3))
    assert refused.error_code != refused.SUCCESS
    shown = by_name(ros.listen(MarkerArray, 'markers', LATCHED).wait_for(shows_the_plan))
    assert set(shown) == {('planned_path', 0), ('via_points', 0)}
    assert {m.header.frame_id for m in shown.values()} == {'floor'}
    np.testing.assert_allclose(places(shown['via_points', 0].points), TABLE_6_1, rtol=0.0,
                               atol=ON_THE_SPOT)
    tips = forward_kinematics(MODEL, [p.positions for p in response.trajectory.points])
    np.testing.assert_allclose(places(shown['planned_path', 0].points), tips, rtol=0.0,
                               atol=ON_THE_SPOT)


@pytest.mark.parametrize(('count', 'via_count'), [(200_000, 3), (200_000, 50_000), (1, 1)])
def test_markers_of_long_plans_stay_small(count, via_count):
    rng = np.random.default_rng(1)
    times = 0.01 * np.arange(count)
    points = TrajectoryPoints(times, np.cumsum(rng.normal(0.0, 1e-3, (count, 3)), axis=0))
    at_via = np.unique(np.concatenate(([0], rng.integers(0, count, via_count), [count - 1])))
    line, balls = plan_markers(points, times[at_via], MODEL, 'base_link').markers
    tips = forward_kinematics(MODEL, points.positions)
    assert len(balls.points) == min(len(at_via), MAX_POINTS)
    if count == 1:
        assert line.action == Marker.DELETE
        return
    assert len(line.points) <= 2 * MAX_POINTS
    if via_count < MAX_POINTS:
        np.testing.assert_allclose(places(balls.points), tips[at_via], rtol=0.0, atol=1e-12)
    drawn = {tuple(p) for p in places(line.points).tolist()}
    assert drawn <= {tuple(p) for p in tips.tolist()}
    assert {tuple(p) for p in places(balls.points).tolist()} <= drawn
