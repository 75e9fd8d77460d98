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

"""Both nodes together: in one process, in namespaces, renamed, twice, late and restarted."""

from __future__ import annotations

import signal
from threading import Condition

from helpers.arm_in_ros import at, moving, stamp
from helpers.own_limits import own_limits
from helpers.places import CONFIG
from helpers.plan_requests import NEAR, patient, plan_request
from helpers.scripts import Script, script
from helpers.thesis_arm import ThesisArm
import numpy as np
import pytest
from rclpy.qos import DurabilityPolicy, QoSProfile
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.nodes.arm_node.node import SimulatedArm
from rrr_traj_planner.nodes.planner_node.node import TrajectoryPlanner
from rrr_traj_planner_interfaces.srv import PlanTrajectory
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from std_srvs.srv import Trigger
from trajectory_msgs.msg import JointTrajectory
from visualization_msgs.msg import Marker, MarkerArray

LATCHED = QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)
DEADLINE = 20.0  # s
REACHED = 1e-3   # m

# An arm unlike the thesis's in size, names and limits.
OTHER = {
    **own_limits('turn', 'lift', 'bend'), 'link_names': ['post', 'upper', 'fore'],
    'base_frame': 'other_base', 'tip_frame': 'other_tip', 'arm.d1': 0.7, 'arm.a2': 0.8,
    'initial_positions': [0.2, 0.8, 0.3], 'joint_limits.turn.max_velocity': 0.5}
OTHER_MODEL = ThesisArm(d1=0.7, a2=0.8, joint_names=OTHER['joint_names'])
OTHER_START = forward_kinematics(OTHER_MODEL, OTHER['initial_positions'])
OTHER_POINTS = (OTHER_START, OTHER_START + (0.02, 0.02, -0.01))


def options(ros, overrides, *remappings, namespace=''):
    return {'context': ros.context, 'namespace': namespace,
            'parameter_overrides': patient(**overrides),
            'cli_args': ['--ros-args', *(a for r in remappings for a in ('-r', r))]}


class Robot:
    """A planner and an arm in a namespace, in the process of the test, and how to use them."""

    def __init__(self, ros, namespace='', **overrides):
        self.ros, self.prefix = ros, f'/{namespace}/' if namespace else '/'
        self.options = options(ros, overrides, namespace=namespace)
        self.states = ros.listen(JointState, f'{self.prefix}joint_states', 100)

    def start(self):
        self.planner = self.ros.add(TrajectoryPlanner(**self.options))
        self.arm = self.ros.add(SimulatedArm(**self.options))
        return self

    def listen(self, kind, topic):
        return self.ros.listen(kind, self.prefix + topic, LATCHED)

    def plan(self, points):
        response = self.ros.call(
            PlanTrajectory, f'{self.prefix}plan_trajectory', plan_request(points))
        assert response.error_code == response.SUCCESS, response.message
        return response.trajectory

    def drive(self, trajectory):
        """Send a trajectory, and return where the arm came to rest."""
        count = len(self.states.messages)
        self.ros.publisher(JointTrajectory, f'{self.prefix}joint_trajectory').publish(trajectory)
        goal = trajectory.points[-1].positions
        return np.array(self.states.wait_for(at(goal, 1e-4), count).position)


def assert_executes(robot, points, model=None):
    """Assert that a robot plans through points and gets to the last."""
    q = robot.drive(robot.plan(points))
    tip = forward_kinematics(model or RobotModel(), q)
    assert np.linalg.norm(tip - points[-1]) <= REACHED


@pytest.mark.parametrize('kind', [TrajectoryPlanner, SimulatedArm])
def test_a_node_with_a_wrong_parameter_does_not_appear(ros, kind):
    names = set(ros.node.get_node_names())
    with pytest.raises(InvalidInputError) as caught:  # holds the half-made node
        kind(**options(ros, {'joint_limits.joint_1.max_velocity': -1.0}))
    assert 'joint_1' in str(caught.value)
    assert set(ros.node.get_node_names()) == names


def test_both_nodes_work_in_one_process_and_executor(ros):
    assert_executes(Robot(ros).start(), NEAR)


def test_two_robots_of_different_parameters_do_not_meet(ros):
    left = Robot(ros, 'left').start()
    right = Robot(ros, 'cell/right', **OTHER).start()
    outside = ros.listen(JointState, 'joint_states')
    before = left.states.wait_for()
    assert_executes(right, OTHER_POINTS, OTHER_MODEL)
    np.testing.assert_allclose(left.states.messages[-1].position, before.position, rtol=0.0,
                               atol=1e-9)
    assert_executes(left, NEAR)
    assert list(right.states.messages[-1].name) == OTHER['joint_names']
    assert list(left.states.messages[-1].name) == ['joint_1', 'joint_2', 'joint_3']
    for robot, frame, link in ((left, 'base_link', 'link_1'), (right, 'other_base', 'post')):
        assert f'"{link}"' in robot.listen(String, 'robot_description').wait_for().data
        markers = robot.listen(MarkerArray, 'markers')
        for ns in ('planned_path', 'executed_path'):
            shown = markers.wait_for(lambda m, ns=ns: any(
                x.ns == ns and x.action == Marker.ADD for x in m.markers))
            assert {m.header.frame_id for m in shown.markers} == {frame}
    assert ros.call(Trigger, 'cell/right/simulated_arm/reset').success
    assert not outside.messages


def test_all_names_of_a_namespaced_node_are_in_its_namespace(ros):
    robot = Robot(ros, 'left').start()
    for node in (robot.planner, robot.arm):
        names = [name for by_node in (
            ros.node.get_publisher_names_and_types_by_node,
            ros.node.get_subscriber_names_and_types_by_node,
            ros.node.get_service_names_and_types_by_node)
            for name, _ in by_node(node.get_name(), '/left')]
        assert len(names) > 8
        shared = {'/rosout', '/parameter_events'}
        assert [n for n in names if not n.startswith('/left/') and n not in shared] == []


def test_topics_and_nodes_can_be_renamed(ros):
    ros.add(TrajectoryPlanner(**options(
        ros, {}, '__node:=brain', '__ns:=/cell', 'plan_trajectory:=/think',
        'planned_trajectory:=idea', 'markers:=/drawing')))
    ros.add(SimulatedArm(**options(
        ros, {}, '__node:=body', 'joint_trajectory:=/cell/idea', 'joint_states:=/feelings',
        'markers:=/drawing', '~/reset:=/again')))
    feelings = ros.listen(JointState, 'feelings')
    feelings.wait_for()
    response = ros.call(PlanTrajectory, 'think', plan_request(NEAR))
    assert response.error_code == response.SUCCESS, response.message
    feelings.wait_for(moving)  # the arm listens to the planner directly
    feelings.wait_for(at(response.trajectory.points[-1].positions, 1e-4))
    drawing = ros.listen(MarkerArray, 'drawing', LATCHED)
    for ns in ('planned_path', 'arm'):
        drawing.wait_for(lambda m, ns=ns: any(x.ns == ns for x in m.markers))
    assert ros.call(Trigger, 'again').success
    assert ros.call(Trigger, 'body/hold').success


def test_arm_that_appears_later_executes_what_was_planned_before(ros):
    robot = Robot(ros)
    ros.add(TrajectoryPlanner(**robot.options))
    trajectory = robot.plan(NEAR)
    ros.add(SimulatedArm(**robot.options))
    robot.states.wait_for()
    tip = forward_kinematics(RobotModel(), robot.drive(trajectory))
    assert np.linalg.norm(tip - NEAR[-1]) <= REACHED


def test_planner_that_appears_later_answers_a_client_that_was_there_before(ros):
    client = ros.node.create_client(PlanTrajectory, 'plan_trajectory')
    assert not client.service_is_ready()
    ros.add(TrajectoryPlanner(**options(ros, {})))
    assert client.wait_for_service(DEADLINE)
    response = client.call(plan_request(NEAR), timeout_sec=DEADLINE)
    assert response.error_code == response.SUCCESS


def test_restarted_planner_serves_old_clients_and_takes_its_old_markers_away(ros):
    robot = Robot(ros).start()
    client = ros.node.create_client(PlanTrajectory, 'plan_trajectory')
    markers = robot.listen(MarkerArray, 'markers')
    for _ in range(3):
        assert client.wait_for_service(DEADLINE)
        response = client.call(plan_request(NEAR), timeout_sec=DEADLINE)
        assert response.error_code == response.SUCCESS
        markers.wait_for(lambda m: any(
            x.ns == 'via_points' and x.action == Marker.ADD for x in m.markers))
        del markers.messages[:]
        ros.remove(robot.planner)
        assert_gone(ros, client.service_is_ready)
        robot.planner = ros.add(TrajectoryPlanner(**robot.options))
        markers.wait_for(lambda m: {x.action for x in m.markers if x.ns in (
            'planned_path', 'via_points')} == {Marker.DELETE})
    count = len(robot.states.messages)
    robot.states.wait_for(since=count)  # the arm has continued


def test_restarted_arm_follows_clients_that_were_there_before(ros):
    robot = Robot(ros).start()
    trajectory = robot.plan(NEAR)
    publisher = ros.publisher(JointTrajectory, 'joint_trajectory')
    goal = trajectory.points[-1].positions
    for _ in range(3):
        publisher.publish(trajectory)
        robot.states.wait_for(at(goal, 1e-4), len(robot.states.messages))
        ros.remove(robot.arm)
        assert_gone(ros, publisher.get_subscription_count)
        restarted = ros.node.get_clock().now().nanoseconds
        robot.arm = ros.add(SimulatedArm(**robot.options))
        start = robot.states.wait_for(lambda m, since=restarted: stamp(m) >= since)
        np.testing.assert_allclose(start.position, trajectory.points[0].positions, atol=1e-3)
        wait_until(ros, publisher.get_subscription_count)
    assert robot.plan(NEAR).points == trajectory.points  # to the last bit


def assert_gone(ros, is_there):
    wait_until(ros, lambda: not is_there())


def wait_until(ros, condition):
    """Wait for what the graph of nodes comes to."""
    changed = Condition()
    with changed:
        timer = ros.node.create_timer(0.01, lambda: notify(changed))
        try:
            assert changed.wait_for(condition, DEADLINE)
        finally:
            ros.node.destroy_timer(timer)


def notify(condition):
    with condition:
        condition.notify_all()


# As processes


def test_two_bring_ups_share_a_machine(ros, tmp_path):
    file = tmp_path / 'other.yaml'
    file.write_text('/**:\n  ros__parameters: {arm: {d1: 0.7}, base_frame: other_base}\n')
    left = Robot(ros, 'left')
    right = Robot(ros, 'right')
    with Script(script('bringup'), '--ros-args', '-r', '__ns:=/left') as one, Script(
            script('bringup'), '--arm', file, '--ros-args', '-r', '__ns:=/right') as other:
        for robot in (left, right):
            robot.states.wait_for()
        assert_executes(left, NEAR)
        assert_executes(right, np.add(NEAR, (0.0, 0.0, 0.2)), ThesisArm(d1=0.7))
        for bringup in (one, other):
            children = bringup.started(3)
            bringup.process.send_signal(signal.SIGTERM)
            assert bringup.ended()[0] == 0
            assert all(child.has_ended() for child in children)


def test_one_file_can_hold_the_parameters_of_two_robots(ros, tmp_path):
    file = tmp_path / 'two.yaml'
    file.write_text('/left/**:\n  ros__parameters: {arm: {d1: 0.25}}\n'
                    '/right/**:\n  ros__parameters: {arm: {d1: 0.75}}\n')
    for name, height in (('left', 0.25), ('right', 0.75)):
        robot = Robot(ros, name)
        with Script(script('simulated_arm'), '--ros-args', '--params-file', file, '-r',
                    f'__ns:=/{name}'):
            text = robot.listen(String, 'robot_description').wait_for().data
        assert f'<origin xyz="0.0 0.0 {height}"' in text


def test_demo_runs_in_a_namespace_beside_another_robot(ros, tmp_path):
    robot = Robot(ros).start()
    robot.states.wait_for()
    with Script(script('demo'), CONFIG / 'table_6_1.yaml', '--plot', '', '--ros-args', '-r',
                '__ns:=/left', cwd=tmp_path) as demo:
        code, output, errors = demo.ended()
    assert code == 0, errors
    assert 'figures are inside their bounds' in output
    assert not any(moving(m) for m in robot.states.messages)
