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

"""The arm's options over DDS: payload, friction, encoders, disturbance, tolerances, rules."""

from __future__ import annotations

from helpers.arm_in_ros import Arm, at, GOAL, moving, NAMES, rest_to_rest, SECOND, stamp, START
import numpy as np
import pytest
from rcl_interfaces.msg import Log
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arm.payload import with_payload
from rrr_traj_planner.core.dynamics.rigid_body import gravity_torque
from sensor_msgs.msg import JointState

# The thesis's motors hardly carry the arm; these follow quick motions too [N m].
STRONG = {f'joint_limits.{name}.max_effort': 1000.0 for name in NAMES}

# More than they have [N m].
PUSH = 5000.0


def weight(mass):
    return gravity_torque(with_payload(RobotModel(), mass), START)


def test_payload_changes_at_run_time_and_the_controller_may_know_it(ros):
    arm = Arm(ros)
    arm.actual.wait_for()
    assert arm.set_parameter('payload.mass', 2.0).successful
    sagged = arm.actual.wait_for_next(
        lambda m: np.abs(np.subtract(m.effort, weight(2.0))).max() < 1.0)
    assert np.abs(np.subtract(sagged.position, START)).max() > 1e-4
    assert arm.set_parameter('payload.known_to_controller', True).successful
    arm.actual.wait_for_next(lambda m: np.abs(np.subtract(m.position, START)).max() < 1e-9)


def test_friction_holds_a_disturbed_arm_exactly_where_it_is(ros):
    arm = Arm(ros, **{'friction.coulomb': [10.0, 10.0, 10.0]})
    log = ros.listen(Log, '/rosout', 100)
    before = arm.actual.wait_for()
    arm.disturb(joint_1=9.0, joint_3=-9.0)
    arm.disturb(joint_1=9.0, joint_3=-9.0, joint_2=float('nan'))  # refused: the first is read
    log.wait_for(lambda m: 'must be in' in m.msg)
    for _ in range(20):
        assert arm.actual.wait_for_next().position == before.position
    arm.disturb(joint_1=11.0)
    arm.actual.wait_for_next(lambda m: m.position[0] > before.position[0])


def test_disturbance_deflects_the_arm_until_it_ends(ros):
    arm = Arm(ros)
    arm.disturb(joint_3=100.0)
    arm.actual.wait_for(lambda m: m.position[2] > START[2] + 0.01)
    arm.disturb()
    arm.actual.wait_for_next(at(START))


def test_bad_disturbance_is_refused_with_a_reason_and_changes_nothing(ros):
    arm = Arm(ros)
    log = ros.listen(Log, '/rosout', 100)
    publisher = ros.publisher(JointState, 'disturbance')
    for message, text in (
            (JointState(name=['elbow'], effort=[1.0]),
             "a disturbance names joint 'elbow', must name distinct joints of joint_1, joint_2, "
             'joint_3'),
            (JointState(name=['joint_1', 'joint_1'], effort=[1.0, 2.0]),
             "a disturbance names joint 'joint_1', must name distinct joints of joint_1, "
             'joint_2, joint_3'),
            (JointState(name=NAMES, effort=[1.0]),
             'a disturbance has 3 names and 1 effort, must have an effort for each name'),
            (JointState(name=['joint_2'], effort=[float('nan')]),
             'the disturbance of joint_2 is nan N m, must be in [-100000, 100000] N m'),
            (JointState(name=['joint_2'], effort=[-1e6]),
             'the disturbance of joint_2 is -1e+06 N m, must be in [-100000, 100000] N m'),
            (JointState(name=['joint_2'], effort=[1.0], position=[1.0]),
             'a disturbance has efforts only, no positions or velocities')):
        publisher.publish(message)
        log.wait_for(lambda m, text=text: m.msg == text and m.level == 40)
    assert at(START, 1e-9)(arm.actual.wait_for_next())


def test_joint_states_are_what_encoders_measure(ros):
    resolution = 2.0 ** -14
    arm = Arm(ros, **STRONG, **{'encoder.resolution': resolution})
    error = ros.listen(JointState, 'simulated_arm/tracking_error')
    arm.send(rest_to_rest(GOAL, 0.4))
    arm.actual.wait_for(moving)
    arm.actual.wait_for(lambda m: np.abs(np.subtract(m.position, GOAL)).max() <= 4.0 * resolution)
    for message in arm.actual.messages:
        assert (np.array(message.position) % resolution == 0.0).all()
    assert np.abs(error.wait_for_next().position).max() > 0.0


def test_tracking_error_is_desired_less_actual_at_the_same_time(ros):
    arm = Arm(ros, **{'payload.mass': 3.0})
    error = ros.listen(JointState, 'simulated_arm/tracking_error')
    arm.send(rest_to_rest(GOAL, 0.4))
    arm.desired.wait_for(moving)
    arm.desired.wait_for(lambda m: np.array_equal(m.position, GOAL))
    until = stamp(arm.desired.messages[-1])
    for listener in (error, arm.actual, arm.desired):
        listener.wait_for(lambda m: stamp(m) > until)
    actual, desired = ({stamp(m): m for m in x.messages} for x in (arm.actual, arm.desired))
    common = [m for m in error.messages if stamp(m) in actual and stamp(m) in desired]
    assert len(common) > 20
    for message in common:
        a, d = actual[stamp(message)], desired[stamp(message)]
        np.testing.assert_array_equal(message.position, np.subtract(d.position, a.position))
        np.testing.assert_array_equal(message.velocity, np.subtract(d.velocity, a.velocity))
        assert message.name == NAMES
        assert len(message.effort) == 0


def test_blocked_arm_gives_up_says_so_and_holds(ros):
    arm = Arm(ros, **STRONG, **{'constraints.joint_1.trajectory': 0.05})
    log = ros.listen(Log, '/rosout', 100)
    arm.disturb(joint_1=0.0)
    arm.send(rest_to_rest(START + (0.4, 0.0, 0.0), 1.0))
    arm.desired.wait_for(moving)
    arm.disturb(joint_1=-PUSH)
    for text in ('State tolerances failed for joint 0:', 'Position Error: 0.05',
                 'Holding position due to state tolerance violation'):
        log.wait_for(lambda m, text=text: m.msg.startswith(text) and m.level == 40)
    arm.disturb()
    rest = arm.desired.wait_for_next(lambda m: not np.any(m.velocity))
    assert rest.position[0] < START[0] + 0.3
    arm.actual.wait_for_next(at(rest.position))


def test_missed_goal_is_given_up_after_its_time(ros):
    arm = Arm(ros, **STRONG, **{'constraints.joint_1.goal': 1e-3, 'constraints.goal_time': 0.1})
    log = ros.listen(Log, '/rosout', 100)
    arm.disturb(joint_1=100.0)
    arm.send(rest_to_rest(GOAL, 0.3))
    log.wait_for(lambda m: m.msg == 'Exceeded goal_time_tolerance: holding position...')
    # where the disturbance had it
    arm.desired.wait_for_next(lambda m: 1e-3 < m.position[0] - GOAL[0] < 0.05)


def test_command_timeout_holds_what_was_reached(ros):
    arm = Arm(ros, **STRONG, **{'cmd_timeout': 0.1})
    log = ros.listen(Log, '/rosout', 100)
    arm.send(rest_to_rest(GOAL, 0.2))
    logged = log.wait_for(lambda m: m.msg == 'Aborted due to command timeout' and m.level == 30)
    held = arm.desired.wait_for(
        lambda m: stamp(m) >= logged.stamp.sec * SECOND + logged.stamp.nanosec)
    np.testing.assert_allclose(held.position, GOAL, atol=1e-3)


def test_one_arm_warns_of_a_timeout_after_an_error_of_tolerances(ros):
    """Each severity has a line of code of its own; rclpy ends the node else."""
    arm = Arm(ros, **{'constraints.joint_1.trajectory': 1e-9, 'cmd_timeout': 0.1})
    log = ros.listen(Log, '/rosout', 100)
    arm.send(rest_to_rest(GOAL, 0.3))
    log.wait_for(lambda m: m.msg == 'Holding position due to state tolerance violation')
    assert arm.set_parameter('constraints.joint_1.trajectory', 0.0).successful
    arm.send(rest_to_rest(GOAL, 0.3))
    log.wait_for(lambda m: m.msg == 'Aborted due to command timeout')
    assert arm.trigger('hold').success


def test_partial_goal_moves_its_joint_alone(ros):
    arm = Arm(ros)
    log = ros.listen(Log, '/rosout', 100)
    arm.send((0.3, [GOAL[2]]), names=['joint_3'])
    log.wait_for(lambda m: m.msg.startswith("Joints on incoming trajectory don't match"))
    assert arm.set_parameter('allow_partial_joints_goal', True).successful
    arm.send((0.3, [GOAL[2]]), names=['joint_3'])
    arm.actual.wait_for(at((START[0], START[1], GOAL[2])))


def test_end_with_a_velocity_is_braked_from_where_it_is_allowed(ros):
    arm = Arm(ros, allow_nonzero_velocity_at_trajectory_end=True)
    arm.send((1.5, GOAL, (0.1, 0.0, 0.0)))
    rest = arm.desired.wait_for(lambda m: m.position[0] > GOAL[0] and not np.any(m.velocity))
    assert 0.005 < rest.position[0] - GOAL[0] < 0.02  # v^2 / 2 a at least, at 1 rad/s^2
    np.testing.assert_array_equal(rest.position[1:], GOAL[1:])
    arm.actual.wait_for_next(at(rest.position))


def test_end_too_near_to_the_end_of_a_range_is_warned_of(ros):
    arm = Arm(ros, allow_nonzero_velocity_at_trajectory_end=True)
    log = ros.listen(Log, '/rosout', 100)
    arm.send((2.0, (0.05, *START[1:]), (-0.4, 0.0, 0.0)))
    logged = log.wait_for(lambda m: 'joint_1 moves at -0.4 rad/s at 0.05 rad' in m.msg)
    # 0.4^2 / (2 * 0.05)
    assert 'it brakes with 1.6 rad/s^2, limit 1 rad/s^2, to rest inside it' in logged.msg
    assert logged.level == 30
    rest = arm.actual.wait_for_next(lambda m: not np.any(np.abs(m.velocity) > 1e-9))
    np.testing.assert_allclose(rest.position, (0.0, *START[1:]), atol=1e-6)


@pytest.mark.parametrize(('name', 'value', 'text'), [
    ('payload.mass', -1.0, 'payload.mass'), ('encoder.seed', -1, 'encoder.seed'),
    ('friction.coulomb', [1.0, -1.0, 0.0],
     'friction.coulomb[1] is -1 N m, must be in [0, 100000] N m'),
    ('friction.viscous', [0.0, 0.0, 1e5], 'too much for a physics_step of 0.001 s'),
    ('publish_clock', True, 'read-only')])
def test_options_without_sense_are_refused(ros, name, value, text):
    arm = Arm(ros)
    answer = arm.set_parameter(name, value)
    assert not answer.successful
    assert text in answer.reason
