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

"""The arm at work: holding, following, saturating, stopping."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.control.computed_torque import ControllerGains
from rrr_traj_planner.core.dynamics.rigid_body import gravity_torque
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.simulation.arm_settings import ArmSettings
from rrr_traj_planner.core.simulation.controlled_arm import ControlledArm
from rrr_traj_planner.core.trajectory.reference_trajectory import reference_through
from rrr_traj_planner.core.trajectory.trajectory_points import TrajectoryPoints

MODEL = RobotModel()
SETTINGS = ArmSettings(MODEL, JointLimits(), ControllerGains())
Q = np.array([0.5, 1.1, 0.2])


def quintic(start, end, duration, n=201):
    s = np.linspace(0.0, 1.0, n)
    d = np.subtract(end, start)
    return TrajectoryPoints(
        duration * s, start + np.outer(10 * s ** 3 - 15 * s ** 4 + 6 * s ** 5, d),
        np.outer(30 * s ** 2 - 60 * s ** 3 + 30 * s ** 4, d) / duration,
        np.outer(60 * s - 180 * s ** 2 + 120 * s ** 3, d) / duration ** 2,
        np.full(n, True), np.full(n, True))


def followed(arm, until):
    """Run the arm, and return the largest tracking error [rad]."""
    error = 0.0
    while arm.time < until:
        arm.advance(1)
        error = max(error, np.abs(np.subtract(arm.state[:3], arm.desired[:3])).max())
    return error


def test_arm_holds_its_position_without_sag():
    arm = ControlledArm(SETTINGS, Q)
    arm.advance(5000)
    np.testing.assert_allclose(arm.state, (*Q, 0.0, 0.0, 0.0), atol=1e-12)
    np.testing.assert_allclose(arm.torque, gravity_torque(MODEL, Q), atol=1e-9)


def test_trajectory_is_followed_and_its_end_held():
    arm, end = ControlledArm(SETTINGS, Q), Q + (0.3, -0.3, 0.4)
    arm.follow(quintic(Q, end, 2.0), arm.now)
    # A torque held for a step lags by half of one: jerk * step / 2 / wn^2 = 5e-6 rad.
    assert followed(arm, 2.5) < 1e-5
    np.testing.assert_allclose(arm.state, (*end, 0.0, 0.0, 0.0), atol=1e-6)


@pytest.mark.parametrize('step', [0.001, 0.0005, 0.0001])
def test_arm_is_on_the_new_segment_exactly_at_every_point(step):
    """The velocity of a line is that of the segment that begins, from its first nanosecond on."""
    arm = ControlledArm(replace(SETTINGS, step=step), Q)
    arm.advance(137)
    n, slopes = 100, np.tile([0.1, -0.1], 50)[:, np.newaxis] * np.ones(3)
    q = Q + 0.01 * np.vstack((np.zeros(3), np.cumsum(slopes, axis=0)))
    arm.follow(TrajectoryPoints(0.01 * np.arange(n + 1), q, *np.zeros((2, n + 1, 3)),
                                *np.zeros((2, n + 1), dtype=bool)), arm.now)
    for slope in slopes:
        np.testing.assert_allclose(arm.desired[3:6], slope, rtol=1e-9)
        arm.advance(round(0.01 / step))
    assert arm.desired[3:6] == (0.0,) * 3


def test_acceleration_at_the_end_is_not_held():
    arm = ControlledArm(SETTINGS, Q)
    arm.follow(TrajectoryPoints([1.0], [Q + 0.1], np.zeros((1, 3)), np.full((1, 3), -2.0),
                                [True], [True]), 0)
    arm.advance(2000)
    # held, it would leave the arm 2 / 30^2 = 2.2 mrad off
    np.testing.assert_allclose(arm.state, (*(Q + 0.1), 0.0, 0.0, 0.0), atol=1e-6)


def test_time_in_one_go_equals_time_in_steps():
    arms = [ControlledArm(SETTINGS, Q) for _ in range(2)]
    for arm in arms:
        arm.follow(quintic(Q, Q + 0.2, 1.0), 0)
    arms[0].advance(700)
    for _ in range(70):
        arms[1].advance(10)
    assert arms[0].state == arms[1].state
    assert arms[0].time == arms[1].time == pytest.approx(0.7)


def test_tracking_error_decays():
    arm = ControlledArm(SETTINGS, Q)
    arm.state = (*(Q + 0.01), 0.0, 0.0, 0.0)
    arm.advance(1000)
    np.testing.assert_allclose(arm.state[:3], Q, atol=1e-9)


def test_torques_saturate_at_the_effort_limits():
    arm = ControlledArm(SETTINGS, Q)
    arm.follow(quintic(Q, Q + 0.5, 0.2), 0)
    limit = SETTINGS.limits.max_effort
    peak = np.zeros(3)
    for _ in range(200):
        arm.advance(1)
        peak = np.maximum(peak, np.abs(arm.torque))
    assert (peak <= limit).all()
    assert (peak == limit).any()


def test_hold_stops_the_arm_and_keeps_it_there():
    arm = ControlledArm(SETTINGS, Q)
    arm.follow(quintic(Q, Q + (0.3, -0.3, 0.4), 2.0), 0)
    arm.advance(1000)
    arm.hold()
    assert arm.motion.end - arm.time < 1.0
    assert followed(arm, arm.motion.end + 1.0) < 1e-5
    np.testing.assert_allclose(arm.state[:3], arm.motion.final, atol=1e-6)


def test_hold_of_an_arm_that_was_sent_out_of_its_ranges_takes_the_torque_off_its_stops():
    arm = ControlledArm(SETTINGS, Q)
    arm.follow(quintic(Q, (34.0, 57.0, 17.0), 2.0), 0)  # degrees, taken for radians
    arm.advance(2500)
    assert np.abs(arm.torque).tolist() == SETTINGS.limits.max_effort.tolist()
    arm.hold()
    assert (arm.motion.final <= SETTINGS.limits.max_position).all()
    arm.advance(round((arm.motion.end - arm.time + 1.0) / SETTINGS.step))
    np.testing.assert_allclose(arm.torque, gravity_torque(MODEL, arm.state[:3]), atol=1e-6)


def test_hold_of_an_arm_that_is_far_from_its_command_stops_it_where_it_is():
    arm = ControlledArm(replace(SETTINGS, limits=JointLimits(max_effort=(5.0, 200.0, 200.0))), Q)
    arm.follow(TrajectoryPoints([0.0, 0.5, 1.0], [Q, Q + (0.4, 0.0, 0.0), Q + (0.8, 0.0, 0.0)],
                                *np.zeros((2, 3, 3)), [False] * 3, [False] * 3), 0)
    arm.advance(1000)
    where = arm.state[0]
    assert Q[0] + 0.8 - where > 0.3  # 5 N m are too weak for it
    arm.hold()
    assert arm.motion.final[0] - where < 0.3


def test_end_with_a_velocity_is_braked_within_the_limits():
    arm = ControlledArm(SETTINGS, Q)
    arm.follow(TrajectoryPoints([1.0], [Q + 0.15], [[0.3] * 3], np.zeros((1, 3)), [True],
                                [True]), 0)
    velocities = []
    for _ in range(2000):
        arm.advance(1)
        velocities.append(arm.desired[3:6])
    assert np.abs(np.diff(velocities, axis=0)).max() <= 1e-3 * 1.001  # 1 rad/s^2
    assert np.abs(velocities).max() > 0.299
    assert velocities[-1] == (0.0, 0.0, 0.0)
    # 0.1 s at full jerk and back, 0.2 s between: 0.3 rad/s * 0.4 s / 2
    np.testing.assert_allclose(arm.state[:3], Q + 0.15 + 0.06, atol=1e-6)


@pytest.mark.parametrize('steps', [1, 250, 999, 1000, 1001])
def test_brake_at_the_end_does_not_depend_on_how_steps_are_counted(steps):
    arms = [ControlledArm(SETTINGS, Q) for _ in range(2)]
    for arm in arms:
        arm.follow(TrajectoryPoints([1.0], [Q + 0.15], [[0.3] * 3], np.zeros((1, 3)), [True],
                                    [True]), 0)
    arms[0].advance(2002)
    arms[1].advance(steps)
    arms[1].advance(2002 - steps)
    assert arms[0].state == arms[1].state


def test_ranges_that_shrink_stop_a_motion_that_would_leave_them():
    arm = ControlledArm(SETTINGS, Q)
    arm.follow(quintic(Q, Q + 0.5, 4.0), 0)
    arm.advance(1500)
    narrow = replace(SETTINGS.limits, max_position=np.array([0.9, 3.0, 3.0]))
    arm.configure(replace(SETTINGS, limits=narrow))
    assert arm.stop_warnings == ('The motion leaves the new joint ranges: stopping',)
    arm.advance(2000)
    assert arm.state[0] < 0.9
    assert arm.state[3:] == pytest.approx((0.0, 0.0, 0.0), abs=1e-9)


def test_ranges_that_shrink_under_a_resting_arm_bring_it_back_inside():
    arm = ControlledArm(SETTINGS, Q)
    arm.configure(replace(SETTINGS, limits=replace(
        SETTINGS.limits, max_position=np.array([0.4, 3.0, 3.0]))))
    arm.advance(3000)
    np.testing.assert_allclose(arm.state[:3], (0.4, *Q[1:]), atol=1e-6)
    np.testing.assert_allclose(arm.torque, gravity_torque(MODEL, arm.state[:3]), atol=1e-3)


def test_other_limits_that_change_leave_the_motion_alone():
    arm = ControlledArm(SETTINGS, Q)
    arm.follow(quintic(Q, (-0.2, 1.1, 0.2), 2.0), 0)
    motion = arm.motion
    arm.configure(replace(SETTINGS, limits=replace(
        SETTINGS.limits, max_acceleration=np.full(3, 0.5))))
    assert arm.motion is motion


def test_reset_puts_the_arm_back_at_rest():
    arm = ControlledArm(SETTINGS, Q)
    arm.follow(quintic(Q, Q + 0.3, 2.0), 0)
    arm.advance(1000)
    arm.reset(Q)
    assert arm.state == (*Q, 0.0, 0.0, 0.0)
    assert arm.time == 1.0
    arm.advance(1000)
    np.testing.assert_allclose(arm.state[:3], Q, atol=1e-12)


def test_replacement_during_motion_does_not_jump():
    arm = ControlledArm(SETTINGS, Q)
    arm.follow(quintic(Q, Q + (0.3, -0.3, 0.4), 2.0), 0)
    arm.advance(900)
    before = np.array(arm.desired)
    arm.follow(quintic(Q, Q + (-0.1, 0.2, 0.1), 3.0), arm.now)
    np.testing.assert_allclose(arm.desired[:6], before[:6], atol=1e-9)
    assert followed(arm, 4.5) < 1e-4
    np.testing.assert_allclose(arm.state[:3], Q + (-0.1, 0.2, 0.1), atol=1e-6)


def test_stops_bound_an_arm_that_is_sent_beyond_them():
    arm = ControlledArm(SETTINGS, Q)
    arm.follow(quintic(Q, (-0.2, 1.1, 0.2), 2.0), 0)
    arm.advance(3000)
    assert (arm.state[0], arm.state[3]) == (0.0, 0.0)


def test_changed_limits_hold_from_the_next_step_on():
    arm = ControlledArm(SETTINGS, Q)
    weak = replace(SETTINGS, limits=JointLimits(max_effort=np.full(3, 10.0)))
    arm.configure(weak)
    arm.advance(1)
    assert arm.torque[1:] == (10.0, 10.0)


def test_step_cannot_change_while_the_arm_runs():
    arm = ControlledArm(SETTINGS, Q)
    with pytest.raises(InvalidInputError, match='^step cannot change'):
        arm.configure(replace(SETTINGS, step=0.002))


@pytest.mark.parametrize('step', [0.0, -1.0, float('inf'), float('nan')])
def test_step_must_be_positive(step):
    with pytest.raises(InvalidInputError, match=r'^step is .* s, must be (positive|finite)'):
        replace(SETTINGS, step=step)


def end_of_the_trajectory(arm):
    arm.advance(1)


def refused_join(arm):
    q = np.array(arm.desired[:3])
    arm.follow(TrajectoryPoints([0.0], [q + (q - Q)], *np.zeros((2, 1, 3)), [True], [False]),
               arm.now)


@pytest.mark.parametrize('means', [end_of_the_trajectory, ControlledArm.hold, refused_join])
@pytest.mark.parametrize(('joint', 'end', 'beyond'), [
    (0, 0.0, 0.0156), (0, np.pi / 2, 0.3), (1, np.pi, 0.002), (2, -np.pi, 0.0156)])
def test_arm_at_a_stop_does_not_push_while_its_command_is_brought_back(means, joint, end, beyond):
    velocity, T = np.sign(end - Q[joint]) * 0.4, 0.8
    q, qd = np.tile(Q, (2, 1)), np.zeros((2, 3))
    qd[:, joint] = velocity
    q[:, joint] = end + np.sign(velocity) * beyond - velocity * np.array([T, 0.0])
    arm = ControlledArm(SETTINGS, q[0])
    arm.state = (*q[0], *qd[0])
    arm.motion = reference_through(TrajectoryPoints(
        [0.0, T], q, qd, np.zeros((2, 3)), *np.ones((2, 2), dtype=bool)))
    arm.advance(round(T / SETTINGS.step) - 1)
    command = q[1, joint] if means is end_of_the_trajectory else arm.desired[joint]
    means(arm)
    assert arm.stop_warnings[0].startswith(
        f'{MODEL.joint_names[joint]} is commanded to {command:.6g} rad, outside its range [')
    arm.advance(1)
    arm.monitor.read_and_clear()
    arm.advance(1000)
    assert arm.monitor.read_and_clear().pressed[joint] == 0.0
    np.testing.assert_allclose(arm.state[joint], end, atol=1e-5)
