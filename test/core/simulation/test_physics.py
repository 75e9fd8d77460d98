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

"""The arm's physics: order of the method, energy, and what hard stops do."""

from __future__ import annotations

from math import inf, pi

from helpers.thesis_arm import ThesisArm
import numpy as np
import pytest
from rrr_traj_planner.core.dynamics.rigid_body import (
    forward_dynamics,
    kinetic_energy,
    potential_energy,
)
from rrr_traj_planner.core.simulation.physics import ArmPhysics
from rrr_traj_planner.core.simulation.time_step import Load, TimeStep
from scipy.integrate import solve_ivp

MODEL = ThesisArm()
NO_TORQUE = (0.0, 0.0, 0.0)
STEP = 1e-3
LOW, HIGH = (0.0, 0.0, -pi), (pi / 2.0, pi, 2.0 * pi)

# Largest difference of potential energy between two poses [J]: what energies are measured by.
ENERGY_SCALE = 2.0 * MODEL.g * float(
    MODEL.mass[1] * MODEL.l2 + MODEL.mass[2] * (MODEL.a2 + MODEL.l3))


def energy(state):
    return float(kinetic_energy(MODEL, state[:3], state[3:])
                 + potential_energy(MODEL, state[:3]))


def advanced(physics, state, torque, steps, h=STEP):
    for _ in range(steps):
        state = physics.step(physics.terms(state), state, torque, h)
    return state


def unlimited():
    return ArmPhysics(MODEL, (-inf,) * 3, (inf,) * 3)


@pytest.mark.parametrize('seed', range(4))
def test_unactuated_arm_keeps_its_energy_for_ten_seconds(seed):
    physics = unlimited()
    state = tuple(np.random.default_rng(seed).uniform(-2.0, 2.0, 6).tolist())
    before = energy(state)
    for _ in range(100):
        state = advanced(physics, state, NO_TORQUE, 100)
        assert abs(energy(state) - before) <= 1e-6 * ENERGY_SCALE


def test_result_equals_an_independent_integration():
    start, torque = (0.3, 0.5, -0.4, 1.0, -2.0, 1.5), (20.0, 100.0, -30.0)

    def rate(_, x):
        return np.concatenate((x[3:], forward_dynamics(MODEL, x[:3], x[3:], torque)))

    reference = solve_ivp(rate, (0.0, 0.5), start, method='DOP853', rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(advanced(unlimited(), start, torque, 500), reference.y[:, -1],
                               atol=1e-8)


def test_method_is_of_fourth_order():
    start, torque = (0.3, 0.5, -0.4, 1.0, -2.0, 1.5), (20.0, 100.0, -30.0)
    ends = [np.array(advanced(unlimited(), start, torque, n, 0.4 / n)) for n in (40, 80, 160)]
    ratio = np.linalg.norm(ends[1] - ends[0]) / np.linalg.norm(ends[2] - ends[1])
    assert 13.0 < ratio < 19.0  # 2^4, and what higher orders add


def test_a_step_with_joints_held_is_the_step_of_the_rest_of_the_arm():
    state = (0.3, 0.5, -0.4, 1.0, 0.0, 1.5)
    after = TimeStep(MODEL)(state, Load(lock=(0, 1, 0)), STEP)
    assert (after[1], after[4]) == (0.5, 0.0)
    heavy = ThesisArm(inertia=MODEL.inertia + np.array([[0, 0, 0], [0, 0, 1e15], [0, 0, 0]]))
    expected = TimeStep(heavy)(state, Load(), STEP)  # joint 2 too heavy to be moved
    np.testing.assert_allclose(after, expected, atol=1e-12)


@pytest.mark.parametrize('seed', range(6))
def test_falling_arm_stays_between_its_stops_and_gains_no_energy(seed):
    physics = ArmPhysics(MODEL, LOW, HIGH)
    rng = np.random.default_rng(seed)
    state = (*rng.uniform(LOW, HIGH).tolist(), *rng.uniform(-3.0, 3.0, 3).tolist())
    before = energy(state)
    for _ in range(2000):
        state = advanced(physics, state, NO_TORQUE, 1)
        assert all(low <= q <= high for q, low, high in zip(state, LOW, HIGH))
        assert energy(state) <= before + 1e-9 * ENERGY_SCALE
        before = energy(state)


def test_impact_stops_the_joint_and_takes_its_share_of_energy():
    physics = ArmPhysics(ThesisArm(g=0.0), LOW, HIGH)
    state = (0.0005, 1.0, 1.0, -1.0, 0.0, 0.0)  # half a step before joint 1's lower stop
    state = advanced(physics, state, NO_TORQUE, 1)
    assert (state[0], state[3]) == (0.0, 0.0)


def test_joint_pressed_into_its_stop_rests_and_leaves_when_pulled():
    physics = ArmPhysics(MODEL, LOW, HIGH)
    state = (0.0, 1.0, 0.5, 0.0, 0.0, 0.0)
    assert advanced(physics, state, (-50.0, 0.0, 0.0), 100)[::3] == (0.0, 0.0)
    away = advanced(physics, state, (50.0, 0.0, 0.0), 10)
    free = advanced(unlimited(), state, (50.0, 0.0, 0.0), 10)
    assert away == free  # a stop does not hold what leaves it


def test_two_joints_at_their_stops_do_not_rock_time_away():
    # Both hang pressed into their stops, each impact throwing the other off by 1e-10 rad/s.
    physics = ArmPhysics(MODEL, LOW, HIGH)
    state = (0.5, 0.0, 2.0 * pi, 0.01, 0.0, -7.7e-11)
    after = advanced(physics, state, NO_TORQUE, 100)
    assert after[0] == pytest.approx(0.5 + 0.01 * 0.1, abs=1e-9)
    assert after[4:] == (0.0, 0.0)


def test_stop_that_is_moved_over_the_arm_lets_it_back_only():
    physics = ArmPhysics(MODEL, (0.5, 0.0, -pi), HIGH)
    state = (0.3, 1.0, 0.5, 0.0, 0.0, 0.0)
    assert advanced(physics, state, (-50.0, 0.0, 0.0), 50)[0] == 0.3
    assert advanced(physics, state, (50.0, 0.0, 0.0), 50)[0] > 0.3
