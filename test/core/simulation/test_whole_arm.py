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

"""The arm with payload, friction, encoders, disturbance and tolerances, under control."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from rrr_traj_planner.core.arm.friction import Friction
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arm.payload import Payload, with_payload
from rrr_traj_planner.core.control.computed_torque import ControllerGains
from rrr_traj_planner.core.control.tolerances import Outcome, Tolerances
from rrr_traj_planner.core.dynamics.rigid_body import gravity_torque, inertia_matrix
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.simulation.arm_settings import ArmSettings
from rrr_traj_planner.core.simulation.controlled_arm import ControlledArm
from rrr_traj_planner.core.simulation.encoder import EncoderSettings
from rrr_traj_planner.core.simulation.soft_stops import SoftStops
from rrr_traj_planner.core.trajectory.trajectory_points import TrajectoryPoints

MODEL = RobotModel()
SETTINGS = ArmSettings(MODEL, JointLimits(max_effort=np.full(3, 400.0)), ControllerGains())
Q = np.array([0.5, 1.1, 0.2])

# The model's error is all that the controller leaves: e = H^-1 (missing torque) / wn^2.
STIFFNESS = SETTINGS.gains.stiffness

# More than the motor of joint 1 has.
PUSH = (-1500.0, 0.0, 0.0)


def arm_with(**changes):
    return ControlledArm(replace(SETTINGS, **changes), Q)


def line(end, duration):
    return TrajectoryPoints([duration], [end], np.zeros((1, 3)), np.zeros((1, 3)), [True], [True])


# Payload


def test_payload_that_the_controller_knows_is_carried_without_sag():
    arm = arm_with(payload=Payload(5.0, known_to_controller=True))
    arm.advance(2000)
    np.testing.assert_allclose(arm.state, (*Q, 0.0, 0.0, 0.0), atol=1e-12)
    np.testing.assert_allclose(
        arm.torque, gravity_torque(with_payload(MODEL, 5.0), Q), atol=1e-9)


def test_payload_that_it_does_not_know_sags_by_its_weight_over_the_stiffness():
    arm = arm_with(payload=Payload(8.0))
    arm.advance(4000)
    q = np.array(arm.state[:3])
    missing = gravity_torque(with_payload(MODEL, 8.0), q) - gravity_torque(MODEL, q)
    sag = -np.linalg.solve(inertia_matrix(MODEL, q), missing) / STIFFNESS
    assert np.abs(sag).max() > 1e-3
    np.testing.assert_allclose(q - Q, sag, atol=1e-9)


def test_payload_changes_while_the_arm_moves_and_its_energy_is_entered():
    arm = arm_with()
    arm.follow(line(Q + 0.3, 1.0), 0)
    arm.advance(500)
    state, before = arm.state, arm.energy
    arm.configure(replace(arm.settings, payload=Payload(3.0)))
    assert arm.state == state
    assert arm.ledger.payload == pytest.approx(arm.energy - before)
    assert abs(arm.ledger.payload) > 1.0
    arm.advance(1)
    assert arm.state != state


# Friction, disturbance, encoders


def test_friction_holds_the_arm_within_the_error_that_it_leaves():
    coulomb = np.array([10.0, 20.0, 15.0])
    arm = arm_with(model=replace(MODEL, friction=Friction(np.zeros(3), coulomb)))
    arm.follow(line(Q + 0.3, 1.0), 0)
    arm.advance(3000)
    rest = arm.state
    assert rest[3:] == (0.0, 0.0, 0.0)
    assert np.abs(np.subtract(arm.torque, gravity_torque(MODEL, rest[:3]))).max() > 0.0
    assert (np.abs(np.subtract(arm.torque, gravity_torque(MODEL, rest[:3])))
            <= coulomb * (1.0 + 1e-9)).all()
    arm.advance(500)
    assert arm.state == rest


def test_disturbance_deflects_the_arm_by_its_torque_over_the_stiffness_until_it_ends():
    arm, torque = arm_with(), (6.0, -8.0, 5.0)
    arm.disturbance = torque
    arm.advance(3000)
    deflected = np.subtract(arm.state[:3], Q)
    expected = np.linalg.solve(inertia_matrix(MODEL, arm.state[:3]), torque) / STIFFNESS
    np.testing.assert_allclose(deflected, expected, atol=1e-9)
    arm.disturbance = (0.0, 0.0, 0.0)
    arm.advance(3000)
    np.testing.assert_allclose(arm.state[:3], Q, atol=1e-9)


def test_controller_sees_what_the_encoders_tell():
    arm = arm_with(encoder=EncoderSettings(resolution=1e-3))
    arm.follow(line(Q + 0.3, 1.0), 0)
    seen = []
    for _ in range(1500):
        arm.advance(1)
        seen.append(arm.measured)
    steps = np.array(seen)[:, :3] / 1e-3
    np.testing.assert_allclose(steps, np.round(steps), atol=1e-9)
    assert np.abs(np.subtract(arm.state[:3], Q + 0.3)).max() < 1e-3
    assert arm.measured != arm.state


def test_encoder_noise_is_the_same_again_with_its_seed():
    runs = []
    for seed in (1, 1, 2):
        arm = arm_with(encoder=EncoderSettings(noise=1e-4, seed=seed))
        arm.advance(200)
        runs.append(arm.state)
    assert runs[0] == runs[1] != runs[2]


# Tolerances


def test_blocked_arm_gives_its_trajectory_up_and_holds_where_it_is():
    arm = arm_with(tolerances=Tolerances(trajectory=(0.1, 0.1, 0.1)))
    arm.follow(line(Q + (0.6, 0.0, 0.0), 2.0), 0)
    arm.disturbance = PUSH
    while not arm.violation:
        assert arm.time < 2.0
        arm.advance(1)
    assert arm.violation[-1] == Outcome.PATH_VIOLATED.value
    assert arm.violation[0] == 'State tolerances failed for joint 0:'
    arm.disturbance = (0.0, 0.0, 0.0)
    arm.advance(3000)
    assert arm.motion.final[0] < Q[0] + 0.2  # far from the goal, where it was
    np.testing.assert_allclose(arm.state[:3], arm.motion.final, atol=1e-6)


def test_brake_after_a_violation_begins_where_the_arm_was_measured():
    arm = arm_with(tolerances=Tolerances(trajectory=(0.05, 0.0, 0.0)))
    arm.follow(line(Q + (0.6, 0.0, 0.0), 2.0), 0)
    arm.disturbance = PUSH
    for _ in range(1000):
        before = arm.state
        arm.advance(1)
        if arm.violation:
            break
    assert arm.violation
    start = arm.motion(arm.time - SETTINGS.step)
    np.testing.assert_allclose(start[:6], before, atol=1e-12)
    stretch = abs(arm.motion.final[0] - before[0])  # v^2 / 2 a, and 0.1 s until it decelerates so
    assert stretch <= before[3] ** 2 / 2.0 + 0.1 * abs(before[3]) + 1e-9


def test_tolerance_is_not_watched_while_the_arm_holds():
    arm = arm_with(tolerances=Tolerances(trajectory=(0.01,) * 3, goal_time=0.1))
    arm.disturbance = PUSH
    arm.advance(2000)
    assert abs(arm.state[0] - Q[0]) > 0.01
    assert arm.violation == ()


def test_goal_that_is_missed_is_given_up_after_its_time():
    arm = arm_with(tolerances=Tolerances(goal=(1e-3, 0.0, 0.0), goal_time=0.5))
    arm.follow(line(Q + (0.3, 0.0, 0.0), 1.5), 0)
    arm.disturbance = (60.0, 0.0, 0.0)
    arm.advance(2000)
    assert arm.violation == ()
    arm.advance(3)
    assert arm.violation[-1] == Outcome.GOAL_VIOLATED.value


def test_goal_that_is_reached_stays_reached():
    arm = arm_with(tolerances=Tolerances((0.01,) * 3, (1e-3,) * 3, goal_time=0.2))
    arm.follow(line(Q + (0.3, 0.0, 0.0), 1.0), 0)
    arm.advance(3000)
    assert arm.violation == ()
    np.testing.assert_allclose(arm.state[:3], Q + (0.3, 0.0, 0.0), atol=1e-6)


# Everything


def test_features_that_are_off_change_no_bit():
    points = line(Q + (0.3, -0.3, 0.4), 0.8)
    arms = [arm_with(), arm_with(
        payload=Payload(0.0, True), tolerances=Tolerances(trajectory=(9.0,) * 3),
        encoder=EncoderSettings(seed=3, bandwidth=50.0), soft_stops=SoftStops(0.0, 1.0, 1.0))]
    for arm in arms:
        arm.follow(points, 0)
        arm.advance(1500)  # the second one's every step is watched: it runs the slower code
    assert arms[0].state == arms[1].state
    assert arms[0].torque == arms[1].torque
    assert arms[0].ledger.motors == pytest.approx(arms[1].ledger.motors, rel=1e-12)


@pytest.mark.parametrize(('seed', 'width'), [(0, 0.0), (1, 0.15), (2, 0.15), (3, 0.0)])
def test_energy_balance_closes_over_ten_seconds_with_everything_on(seed, width):
    rng = np.random.default_rng(seed)
    friction = Friction(rng.uniform(0.5, 5.0, 3), rng.uniform(1.0, 15.0, 3))
    settings = ArmSettings(
        replace(MODEL, friction=friction),
        JointLimits(max_effort=np.array([90.0, 190.0, 80.0])), ControllerGains(),
        payload=Payload(rng.uniform(1.0, 4.0)), soft_stops=SoftStops(width, 5000.0, 0.3),
        encoder=EncoderSettings(2.0 ** -14, 1e-4, seed))
    arm = ControlledArm(settings, Q)
    before, saturated = arm.energy, False
    for n in range(20):
        if n == 10:
            arm.configure(replace(settings, payload=Payload(rng.uniform(4.0, 8.0))))
        if n % 4 == 0:
            goal = rng.uniform((-0.3, -0.3, -3.3), (1.9, 3.4, 6.5))  # some beyond the stops
            arm.follow(line(goal, 1.7), arm.now)
        arm.disturbance = tuple(rng.uniform(-40.0, 40.0, 3).tolist())
        arm.advance(500)
        saturated |= bool((np.abs(arm.torque) == settings.limits.max_effort).any())
    ledger, change = arm.ledger, arm.energy - before
    assert saturated
    assert arm.time == pytest.approx(10.0)
    assert min(ledger.viscous, ledger.coulomb) > 1.0
    assert ledger.payload != 0.0 != ledger.disturbance
    assert ledger.supplied == pytest.approx(change + ledger.dissipated,
                                            abs=1e-6 * ledger.dissipated)


def test_reset_opens_a_new_account():
    arm = arm_with(model=replace(MODEL, friction=Friction([1.0] * 3, [1.0] * 3)))
    arm.follow(line(Q + 0.3, 1.0), 0)
    arm.advance(500)
    assert arm.ledger.dissipated > 0.0
    arm.reset(Q)
    assert arm.ledger.supplied == arm.ledger.dissipated == 0.0
    arm.follow(line(Q + 0.3, 1.0), arm.now)
    before = arm.energy
    arm.advance(500)
    assert arm.ledger.supplied - arm.ledger.dissipated == pytest.approx(
        arm.energy - before, abs=1e-8)


def test_friction_too_hard_for_the_step_is_refused():
    with pytest.raises(InvalidInputError, match='too much for a physics_step of 0.001 s'):
        arm_with(model=replace(MODEL, friction=Friction([1e5] * 3)))
