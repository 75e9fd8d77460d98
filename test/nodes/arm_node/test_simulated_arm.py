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

"""The node `simulated_arm` over DDS: holding, following, refusing, stopping, keeping time."""

from __future__ import annotations

from helpers.arm_in_ros import Arm, at, GOAL, moving, NAMES, rest_to_rest, SECOND, stamp, START
from helpers.own_limits import own_limits
import numpy as np
import pytest
from rcl_interfaces.msg import Log
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.dynamics.rigid_body import gravity_torque


def assert_no_jump(messages, limit=1.0):
    """Desired positions go on as fast as the velocity limit allows, at the most."""
    for before, after in zip(messages, messages[1:]):
        seconds = (stamp(after) - stamp(before)) / SECOND
        step = np.abs(np.subtract(after.position, before.position)).max()
        assert step <= limit * seconds * 1.01 + 1e-9


def test_arm_holds_its_initial_position_against_gravity(ros):
    arm = Arm(ros)
    state, desired = arm.actual.wait_for(), arm.desired.wait_for()
    assert state.name == desired.name == NAMES
    np.testing.assert_allclose(state.position, START, atol=1e-12)
    np.testing.assert_allclose(desired.position, START, atol=1e-12)
    np.testing.assert_allclose(state.effort, gravity_torque(RobotModel(), START), atol=1e-9)
    assert len(desired.effort) == 0


def test_trajectory_is_followed_and_held(ros):
    arm = Arm(ros)
    arm.send((0.0, START, (0,) * 3, (0,) * 3), rest_to_rest(GOAL, 0.4))
    arm.actual.wait_for(moving)
    arm.actual.wait_for(at(GOAL))
    held = arm.actual.wait_for_next()
    np.testing.assert_allclose(held.position, GOAL, atol=1e-5)
    assert_no_jump(arm.desired.messages)
    by_stamp = {stamp(m): m for m in arm.actual.messages}
    for wanted in arm.desired.messages:
        if stamp(wanted) in by_stamp:  # tracking: jerk * step / 2 / wn^2, some 1e-5 rad
            np.testing.assert_allclose(
                by_stamp[stamp(wanted)].position, wanted.position, atol=1e-4)


def test_joints_in_another_order_are_sorted(ros):
    arm = Arm(ros)
    arm.send((0.3, GOAL[[2, 0, 1]]), names=('joint_3', 'joint_1', 'joint_2'))
    arm.actual.wait_for(at(GOAL))


def test_refused_trajectory_is_logged_and_changes_nothing(ros):
    arm = Arm(ros)
    log = ros.listen(Log, '/rosout', 100)
    arm.send(rest_to_rest(GOAL, 0.8))
    arm.desired.wait_for(moving)
    arm.send((1.0, START), names=NAMES[:2])
    arm.send((1.0, START), (0.5, START))
    arm.send((1.0, (0.0, np.nan, 0.0)))
    arm.send((1.0, START), stamp=5 * SECOND)
    for text in ("Joints on incoming trajectory don't match the controller joints.",
                 'Time between points 0 and 1 is not strictly increasing, it is 1.000000 and '
                 '0.500000 respectively',
                 'Value of positions of joint joint_2 at point #0 is not finite: nan',
                 'Received trajectory with non-zero start time (5.000000) that ends in the past '
                 '(6.000000)'):
        log.wait_for(lambda m, text=text: m.msg == text)
    arm.actual.wait_for(at(GOAL))
    assert_no_jump(arm.desired.messages)


def test_trajectory_replaced_mid_way_does_not_jump(ros):
    arm = Arm(ros)
    arm.send(rest_to_rest(GOAL, 0.8))
    arm.desired.wait_for(moving)
    arm.send((0.0, START - 0.02, (0,) * 3, (0,) * 3), rest_to_rest(START + 0.02, 0.9))
    arm.actual.wait_for(at(START + 0.02))
    assert_no_jump(arm.desired.messages)


def test_distant_point_due_now_is_reached_within_limits(ros):
    arm = Arm(ros)
    arm.send((0.0, START + 0.1))
    arm.actual.wait_for(at(START + 0.1))
    assert_no_jump(arm.desired.messages)


def test_stamped_trajectory_arrives_on_its_time(ros):
    arm = Arm(ros)
    goal, start = START + 0.1 * (GOAL - START), arm.now() + SECOND  # it takes 0.3 s to get there
    arm.send(rest_to_rest(goal, 0.1), stamp=start)
    end = start + SECOND // 10
    due = arm.desired.wait_for(lambda m: stamp(m) >= end)
    np.testing.assert_array_equal(due.position, goal)
    before = [m for m in arm.desired.messages if stamp(m) < end - SECOND // 100]
    assert all(np.abs(np.subtract(m.position, goal)).max() > 0.0 for m in before)


def test_hold_stops_the_arm_short_of_its_goal(ros):
    arm = Arm(ros)
    arm.send(rest_to_rest(START + 0.4, 1.0))
    arm.desired.wait_for(moving)
    answer = arm.trigger('hold')
    assert answer.success
    assert answer.message.startswith('at rest in ')
    rest = arm.desired.wait_for_next(lambda m: not np.any(m.velocity))
    assert np.abs(np.subtract(rest.position, START)).max() < 0.3
    arm.actual.wait_for_next(at(rest.position))
    assert_no_jump(arm.desired.messages, limit=1.0)


def test_reset_returns_to_the_initial_position_and_drops_the_trajectory(ros):
    arm = Arm(ros)
    arm.send(rest_to_rest(START + 0.4, 1.0))
    arm.desired.wait_for(moving)
    assert arm.trigger('reset').success
    for listener in (arm.actual, arm.desired):
        state = listener.wait_for_next(at(START, 1e-12))
        np.testing.assert_allclose(state.position, START, atol=1e-12)
    assert not moving(arm.desired.wait_for_next())


def test_time_is_the_clock_s_in_whole_steps(ros):
    arm = Arm(ros)
    first = stamp(arm.actual.wait_for())
    since = arm.now()
    later = arm.actual.wait_for(lambda m: stamp(m) >= since)  # the arm keeps up
    assert (stamp(later) - first) % (SECOND // 1000) == 0
    stamps = [stamp(m) for m in arm.actual.messages]
    assert stamps == sorted(stamps)
    assert stamps[-1] <= arm.now()


def test_arm_catches_up_after_a_pause(ros):
    arm = Arm(ros)
    arm.actual.wait_for()
    end = arm.now() + SECOND // 2
    # Nothing else runs on the executor meanwhile.
    ros.node.create_timer(0.01, lambda: [None for _ in iter(lambda: arm.now() < end, False)])
    arm.actual.wait_for(lambda m: stamp(m) >= end)


def test_changed_effort_limit_saturates_the_motors(ros):
    arm = Arm(ros)
    assert arm.set_parameter('joint_limits.joint_2.max_effort', 100.0).successful
    arm.actual.wait_for_next(lambda m: m.effort[1] == 100.0)  # it takes 163 N m to hold
    arm.actual.wait_for_next(lambda m: m.position[1] == 0.0)  # it sinks onto its stop


def test_names_and_positions_come_from_parameters(ros):
    arm = Arm(ros, **own_limits('a', 'b', 'c'), initial_positions=[0.1, 1.5, 0.3])
    state = arm.actual.wait_for()
    assert state.name == ['a', 'b', 'c']
    assert state.position.tolist() == pytest.approx([0.1, 1.5, 0.3])
