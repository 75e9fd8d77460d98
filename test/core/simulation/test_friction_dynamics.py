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

"""Friction, bumpers and stops: closed forms, sticking, no chatter, energy to the last part."""

from __future__ import annotations

from dataclasses import replace
from math import exp, inf, log, pi

from helpers.thesis_arm import ThesisArm
import numpy as np
import pytest
from rrr_traj_planner.core.arm.friction import Friction
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.dynamics.rigid_body import (
    forward_dynamics,
    gravity_torque,
    inertia_matrix,
    kinetic_energy,
    potential_energy,
)
from rrr_traj_planner.core.simulation.energy import work
from rrr_traj_planner.core.simulation.friction_dynamics import FrictionDynamics
from rrr_traj_planner.core.simulation.physics import ArmPhysics
from rrr_traj_planner.core.simulation.soft_stops import SoftStops
from scipy.integrate import solve_ivp

MODEL = RobotModel()
WEIGHTLESS = ThesisArm(g=0.0)
STEP = 1e-3
LOW, HIGH = (0.0, 0.0, -pi), (pi / 2.0, pi, 2.0 * pi)
FREE = ((-inf,) * 3, (inf,) * 3)

# Joints 2 and 3 stuck: joint 1 is then one body, with closed forms.
ONE_BODY = np.array([0.0, 1e4, 1e4])
Q2, Q3 = 0.7, 0.3
INERTIA = float(inertia_matrix(WEIGHTLESS, (0.0, Q2, Q3))[0, 0])


def rubbing(friction):
    return replace(MODEL, friction=friction)


def advanced(physics, state, torque, steps, h=STEP):
    for _ in range(steps):
        state = physics.step(physics.terms(state), state, torque, h)
    return state


def one_body(viscous=0.0, coulomb=0.0, w=0.0, q=0.0, bounds=FREE, soft=None):
    friction = Friction(viscous * np.array([1.0, 0.0, 0.0]),
                        ONE_BODY + coulomb * np.array([1.0, 0.0, 0.0]))
    arm = replace(WEIGHTLESS, friction=friction)
    return ArmPhysics(arm, *bounds, soft), (q, Q2, Q3, w, 0.0, 0.0)


def energy(state, soft, model=MODEL):
    return float(kinetic_energy(model, state[:3], state[3:]) + potential_energy(
        model, state[:3])) + soft.energy(state, LOW, HIGH)


def random_friction(rng):
    return Friction(rng.uniform(0.0, 6.0, 3), rng.uniform(0.0, 40.0, 3))


# Closed forms


def test_coulomb_friction_stops_a_joint_after_the_displacement_that_takes_its_energy():
    physics, state = one_body(coulomb=20.0, w=1.3)
    after = advanced(physics, state, (0.0, 0.0, 0.0), 2000)
    assert after[0] == pytest.approx(0.5 * INERTIA * 1.3 ** 2 / 20.0, rel=1e-12)
    assert after[1:] == (Q2, Q3, 0.0, 0.0, 0.0)


def test_viscous_friction_slows_exponentially():
    physics, state = one_body(viscous=9.0, w=1.3)
    after = advanced(physics, state, (0.0, 0.0, 0.0), 1000)
    assert after[3] == pytest.approx(1.3 * exp(-9.0 / INERTIA), rel=1e-11)


def test_both_frictions_stop_a_joint_at_their_time():
    b, c, w0 = 9.0, 20.0, 1.3
    physics, state = one_body(b, c, w0)
    end = INERTIA / b * log(1.0 + b * w0 / c)
    before = advanced(physics, state, (0.0, 0.0, 0.0), int(end / STEP))
    assert before[3] > 0.0
    after = advanced(physics, before, (0.0, 0.0, 0.0), 1)
    assert after[3] == 0.0
    assert after[0] == pytest.approx(INERTIA / b * w0 - c / b * end, rel=1e-11)


def test_result_with_viscous_friction_equals_an_independent_integration():
    viscous = np.array([5.0, 8.0, 3.0])
    start, torque = (0.3, 0.5, -0.4, 1.0, -2.0, 1.5), (20.0, 100.0, -30.0)

    def rate(_, x):
        return np.concatenate((
            x[3:], forward_dynamics(MODEL, x[:3], x[3:], torque - viscous * x[3:])))

    reference = solve_ivp(rate, (0.0, 0.5), start, method='DOP853', rtol=1e-12, atol=1e-12)
    physics = ArmPhysics(rubbing(Friction(viscous)), *FREE)
    np.testing.assert_allclose(advanced(physics, start, torque, 500), reference.y[:, -1],
                               atol=1e-8)


def test_sliding_arm_equals_an_independent_integration_until_a_joint_turns():
    friction = Friction(np.zeros(3), [4.0, 6.0, 5.0])
    start, torque = (0.3, 0.5, -0.4, 1.0, -2.0, 1.5), (20.0, 100.0, -30.0)

    def rate(_, x):
        return np.concatenate((x[3:], forward_dynamics(
            MODEL, x[:3], x[3:], torque - friction.coulomb * (1.0, -1.0, 1.0))))

    reference = solve_ivp(rate, (0.0, 0.1), start, method='DOP853', rtol=1e-12, atol=1e-12)
    assert (np.sign(reference.y[3:, -1]) == (1.0, -1.0, 1.0)).all()
    np.testing.assert_allclose(
        advanced(ArmPhysics(rubbing(friction), *FREE), start, torque, 100), reference.y[:, -1],
        atol=1e-9)


# Sticking


@pytest.mark.parametrize('seed', range(5))
def test_arm_with_less_load_than_friction_stays_exactly_at_rest(seed):
    rng = np.random.default_rng(seed)
    q, coulomb = rng.uniform(LOW, HIGH), rng.uniform(1.0, 40.0, 3)
    physics = ArmPhysics(rubbing(Friction(np.zeros(3), coulomb)), LOW, HIGH)
    state = start = (*q.tolist(), 0.0, 0.0, 0.0)
    for _ in range(500):
        load = rng.uniform(-0.999, 0.999, 3) * coulomb
        state = advanced(physics, state, tuple((gravity_torque(MODEL, q) + load).tolist()), 1)
        assert state == start


@pytest.mark.parametrize('sign', [1.0, -1.0])
@pytest.mark.parametrize('joint', range(3))
def test_joint_breaks_loose_just_above_its_friction(joint, sign):
    q, coulomb = (0.5, 1.1, 0.2), np.array([10.0, 20.0, 15.0])
    physics = ArmPhysics(rubbing(Friction(np.zeros(3), coulomb)), LOW, HIGH)
    torque = gravity_torque(MODEL, q)
    torque[joint] += sign * 1.001 * coulomb[joint]
    after = advanced(physics, (*q, 0.0, 0.0, 0.0), tuple(torque.tolist()), 50)
    assert sign * after[3 + joint] > 0.0
    assert [w for i, w in enumerate(after[3:]) if i != joint] == [0.0, 0.0]


def test_turning_joint_passes_through_rest_once():
    physics, state = one_body(coulomb=20.0, w=0.5)
    signs = []
    for _ in range(400):
        state = advanced(physics, state, (-60.0, 0.0, 0.0), 1)
        signs.append(np.sign(state[3]))
    assert np.count_nonzero(np.diff(signs)) == 1


# Stops


def test_bumper_holds_a_load_where_its_spring_balances_it_and_does_not_chatter():
    soft = SoftStops(0.1, 2000.0, 0.5)
    physics, state = one_body(viscous=1e-3, q=1.5, w=1.0, bounds=(LOW, HIGH), soft=soft)
    turns, before = 0, 1.0
    for _ in range(10_000):
        state = advanced(physics, state, (100.0, 0.0, 0.0), 1)
        turns += state[3] * before < 0.0
        before = state[3] or before
    assert state[0] == pytest.approx(HIGH[0] + 100.0 / 2000.0, abs=1e-6)
    assert abs(state[3]) < 1e-6
    assert turns < 150  # of its 4 Hz: it swings, it does not chatter


def test_bumper_that_is_driven_through_ends_at_the_hard_stop():
    physics, state = one_body(q=1.5, bounds=(LOW, HIGH), soft=SoftStops(0.1, 100.0, 0.5))
    after = advanced(physics, state, (300.0, 0.0, 0.0), 3000)
    assert (after[0], after[3]) == (HIGH[0] + 0.1, 0.0)


def test_arm_pressed_into_its_hard_stop_rests_there_and_leaves_when_friction_lets_it():
    physics, state = one_body(coulomb=20.0, q=0.0, bounds=(LOW, HIGH))
    assert advanced(physics, state, (-500.0, 0.0, 0.0), 100) == state
    assert advanced(physics, state, (19.9, 0.0, 0.0), 100) == state
    assert advanced(physics, state, (20.1, 0.0, 0.0), 100)[3] > 0.0


def test_joint_that_only_its_neighbour_s_stop_presses_into_its_own_rests_there(monkeypatch):
    # Alone, joint 3 would leave its stop; joint 2, pressed into its own, throws it back.
    # What a chattering step ends with.
    monkeypatch.setattr(FrictionDynamics, '_step_with_joints_locked', None)
    physics = ArmPhysics(rubbing(Friction([1.0] * 3, [1.0] * 3)), LOW, HIGH)
    state, found = (0.5, HIGH[1], HIGH[2], 0.1, 0.0, 0.0), 0
    for tau_2, tau_3 in np.random.default_rng(1).uniform(
            -300.0, 300.0, (300, 2)).tolist():
        free = forward_dynamics(MODEL, state[:3], state[3:], (0.0, tau_2, tau_3))
        after = advanced(physics, state, (0.0, tau_2, tau_3), 1)
        if free[1] > 1.0 and free[2] < -1.0 and after[1:3] == state[1:3]:
            found += 1
            assert after[4:] == (0.0, 0.0)
    assert found > 10


def test_next_to_no_friction_is_no_friction():
    rng = np.random.default_rng(3)
    plain = ArmPhysics(MODEL, LOW, HIGH)
    slick = ArmPhysics(rubbing(Friction([1e-12] * 3)), LOW, HIGH)
    for _ in range(5):
        state = (*rng.uniform(LOW, HIGH).tolist(), *rng.uniform(-2.0, 2.0, 3).tolist())
        np.testing.assert_allclose(
            advanced(slick, state, (0.0,) * 3, 700), advanced(plain, state, (0.0,) * 3, 700),
            atol=1e-6)
    assert plain.ledger.stops > 1.0


# Energy


@pytest.mark.parametrize(('seed', 'width'), [(0, 0.2), (1, 0.0), (2, 0.2), (3, 0.0)])
def test_work_is_energy_and_losses_for_ten_seconds(seed, width):
    rng = np.random.default_rng(seed)
    soft = SoftStops(width, 3000.0, 0.3)
    physics = ArmPhysics(rubbing(random_friction(rng)), LOW, HIGH, soft)
    state = (*rng.uniform(LOW, HIGH).tolist(), *rng.uniform(-3.0, 3.0, 3).tolist())
    before, supplied = energy(state, soft), 0.0
    for _ in range(50):
        torque = tuple((rng.uniform(-1.0, 1.0, 3) * (60.0, 200.0, 100.0)).tolist())
        after = advanced(physics, state, torque, 200)
        supplied, state = supplied + work(torque, state, after), after
    lost = physics.ledger
    assert min(lost.viscous, lost.coulomb, lost.stops) > 1.0
    assert supplied - lost.dissipated == pytest.approx(
        energy(state, soft) - before, abs=1e-6 * lost.dissipated)


@pytest.mark.parametrize('seed', range(4))
def test_falling_arm_with_friction_never_gains_energy(seed):
    rng = np.random.default_rng(seed)
    soft = SoftStops(0.1 * (seed % 2), 5000.0, 0.2)
    physics = ArmPhysics(rubbing(random_friction(rng)), LOW, HIGH, soft)
    state = (*rng.uniform(LOW, HIGH).tolist(), *rng.uniform(-3.0, 3.0, 3).tolist())
    before = energy(state, soft)
    for _ in range(3000):
        state = advanced(physics, state, (0.0,) * 3, 1)
        after = energy(state, soft)
        assert after <= before + 1e-6
        before = after
        assert all(low - soft.width <= q <= high + soft.width
                   for q, low, high in zip(state, LOW, HIGH))
    assert state[3:] == (0.0, 0.0, 0.0) or soft.width  # it comes to rest, exactly


@pytest.mark.parametrize('seed', range(3))
def test_a_huge_disturbance_leaves_finite_states_between_the_stops(seed):
    rng = np.random.default_rng(seed)
    physics = ArmPhysics(rubbing(random_friction(rng)), LOW, HIGH)
    state = (*rng.uniform(LOW, HIGH).tolist(), 0.0, 0.0, 0.0)
    for _ in range(100):
        state = advanced(physics, state, tuple(rng.choice([-1e5, 1e5], 3).tolist()), 3)
        assert np.isfinite(state).all()
        assert all(low <= q <= high for q, low, high in zip(state, LOW, HIGH))
