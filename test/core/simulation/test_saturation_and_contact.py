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

"""What strains the arm: saturated motors, stops that are hit and pressed, by hand calculation."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from rrr_traj_planner.core.arm.friction import Friction
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arm.payload import Payload
from rrr_traj_planner.core.control.computed_torque import ControllerGains
from rrr_traj_planner.core.dynamics.rigid_body import gravity_torque, inertia_matrix
from rrr_traj_planner.core.simulation.arm_settings import ArmSettings
from rrr_traj_planner.core.simulation.controlled_arm import ControlledArm
from rrr_traj_planner.core.simulation.saturation_and_contact import (
    NONE_RECORDED,
    SaturationAndContact,
    SaturationAndContactMonitor,
)
from rrr_traj_planner.core.simulation.soft_stops import SoftStops
from rrr_traj_planner.core.trajectory.trajectory_points import TrajectoryPoints

MODEL, NAMES = RobotModel(), ('joint_1', 'joint_2', 'joint_3')
SETTINGS = ArmSettings(MODEL, JointLimits(), ControllerGains())
Q = np.array([0.5, 1.1, 0.2])


def quintic(start, end, duration, n=301):
    s = np.linspace(0.0, 1.0, n)
    d = np.subtract(end, start)
    return TrajectoryPoints(
        duration * s, start + np.outer(10 * s ** 3 - 15 * s ** 4 + 6 * s ** 5, d),
        np.outer(30 * s ** 2 - 60 * s ** 3 + 30 * s ** 4, d) / duration,
        np.outer(60 * s - 180 * s ** 2 + 120 * s ** 3, d) / duration ** 2,
        np.full(n, True), np.full(n, True))


def test_motion_within_the_limits_strains_nothing():
    for end in (Q + 0.3, (0.0, 1.1, 0.2), (np.pi / 2, 1.1, 0.2)):  # ends of joint_1's range too
        arm = ControlledArm(SETTINGS, Q)
        arm.follow(quintic(Q, end, 3.0), 0)
        arm.advance(3500)
        assert arm.monitor.read_and_clear() is NONE_RECORDED


def test_arm_at_the_end_of_a_range_does_not_press_it():
    arm = ControlledArm(SETTINGS, (0.0, 1.1, 0.2))
    arm.advance(100)
    assert arm.monitor.read_and_clear() is NONE_RECORDED


@pytest.mark.parametrize('friction', [Friction(), Friction([5.0] * 3, [2.0] * 3)])
def test_saturated_steps_are_counted_with_what_was_wanted(friction):
    """Gravity asks of joint_2 more than its motor has: the arm falls, the error grows."""
    needed = gravity_torque(MODEL, Q)[1]
    limits = JointLimits(max_effort=[150.0, 0.9 * needed, 200.0])
    arm = ControlledArm(replace(
        SETTINGS, limits=limits, model=replace(SETTINGS.model, friction=friction)), Q)
    arm.monitor.read_and_clear()
    arm.advance(1)
    first = arm.monitor.read_and_clear()
    assert first.saturated == (0, 1, 0)
    assert first.wanted == pytest.approx((0.0, needed, 0.0))
    arm.advance(99)
    after = arm.monitor.read_and_clear()
    assert after.saturated[1] == 99
    assert after.wanted[1] > needed
    text, = (x.text for x in first.motors(NAMES, limits))
    assert text == (f'joint_2 needs {needed:.4g} N m to follow, its motor is saturated at '
                    f'{0.9 * needed:.4g} N m')
    assert arm.monitor.read_and_clear() is NONE_RECORDED


def test_stop_is_pressed_with_what_the_controller_gives_for_the_error():
    """Held d beyond the stop, joint_1 pushes with M11 wn^2 d; gravity does not act on it."""
    start = np.array([0.0, 1.1, 0.2])
    for side, wall in ((-1.0, 0.0), (1.0, np.pi / 2)):
        start[0] = wall
        arm = ControlledArm(replace(SETTINGS, limits=JointLimits(max_effort=[400.0] * 3)), start)
        arm.follow(quintic(start, start + (side * 0.01, 0.0, 0.0), 1.0), 0)
        arm.advance(2000)
        arm.monitor.read_and_clear()
        arm.advance(100)
        pressed = arm.monitor.read_and_clear()
        expected = side * inertia_matrix(MODEL, start)[0, 0] * 900.0 * 0.01
        assert pressed.pressed == pytest.approx((expected, 0.0, 0.0), rel=1e-6)
        assert pressed.saturated == (0, 0, 0)


def test_bumper_is_pressed_with_its_spring():
    arm = ControlledArm(replace(SETTINGS, soft_stops=SoftStops(0.1, 1e4, 0.2)), (0.01, 1.1, 0.2))
    arm.disturbance = (-1000.0, 0.0, 0.0)
    arm.advance(3000)
    arm.monitor.read_and_clear()
    arm.advance(10)
    condition = arm.monitor.read_and_clear()
    assert condition.pressed[0] == pytest.approx(1e4 * arm.state[0], rel=1e-3)  # k x, lower
    assert condition.pressed[0] == pytest.approx(-850.0, rel=1e-3)  # 1000 N m less the motor's


def test_stop_is_hit_at_the_speed_that_the_arm_had():
    arm = ControlledArm(replace(SETTINGS, limits=JointLimits(max_effort=[1e-3] * 3)), Q)
    arm.state = (0.001, 1.1, 0.2, -0.9, 0.0, 0.0)  # its motor is too weak to brake it
    arm.advance(2)
    hit = arm.monitor.read_and_clear().hit
    assert hit[0] == pytest.approx(-0.9, abs=1e-3)
    text = SaturationAndContact(hit=(hit[0], 0.0, 0.0)).stops(NAMES, SETTINGS.limits)[0].text
    assert text == f'joint_1 hit its lower stop (0 rad) at {-hit[0]:.4g} rad/s'


def test_payload_too_heavy_to_lift_saturates_the_motor():
    arm = ControlledArm(replace(SETTINGS, payload=Payload(20.0)), (0.5, 0.4, 0.3))
    arm.monitor.read_and_clear()
    arm.advance(2000)
    assert arm.monitor.read_and_clear().saturated[1] > 1000


def test_conditions_of_two_stretches_are_joined():
    a = SaturationAndContact((1, 0, 2), (5.0, 0.0, -7.0), (0.0, -1.0, 0.0), (3.0, 0.0, 0.0))
    b = SaturationAndContact((4, 0, 0), (-6.0, 0.0, 1.0), (0.0, 0.5, 0.0), (-2.0, 0.0, 9.0))
    assert a.joined(b) == SaturationAndContact(
        (5, 0, 2), (-6.0, 0.0, -7.0), (0.0, -1.0, 0.0), (3.0, 0.0, 9.0))
    assert NONE_RECORDED.joined(a) == a


def test_stop_is_pressed_by_an_unlimited_motor_too():
    monitor = SaturationAndContactMonitor()
    upper = (-1, 0, 0)
    monitor.record_contact(upper, upper, (0.0, 0.0, 0.0), (-0.4, 0.0, 0.0), (10.0, 0.0, 0.0))
    assert monitor.read_and_clear() is NONE_RECORDED  # less than a twentieth of the motor's torque
    monitor.record_contact(upper, upper, (0.0, 0.0, 0.0), (-0.6, 0.0, 0.0), (10.0, 0.0, 0.0))
    assert monitor.read_and_clear().pressed == (0.6, 0.0, 0.0)
