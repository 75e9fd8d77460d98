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

"""Random chains in simulation: forward dynamics, energy, friction, stops, rest, control."""

from __future__ import annotations

from dataclasses import replace
from math import inf

from helpers.friction_arms import with_friction
from helpers.public_arms import described, DESCRIPTIONS
from helpers.random_chains import PinocchioChain, random_arm
import numpy as np
import pytest
from rrr_traj_planner.core.arm.friction import Friction
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.control.computed_torque import ControllerGains
from rrr_traj_planner.core.dynamics.rigid_body import (
    gravity_torque,
    inertia_matrix,
    kinetic_energy,
    potential_energy,
)
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.simulation.arm_settings import ArmSettings
from rrr_traj_planner.core.simulation.controlled_arm import ControlledArm
from rrr_traj_planner.core.simulation.energy import work
from rrr_traj_planner.core.simulation.physics import ArmPhysics
from rrr_traj_planner.core.simulation.soft_stops import SoftStops
from rrr_traj_planner.core.simulation.step_stability import check_step, MOST_STEPS
from rrr_traj_planner.core.simulation.time_step import Load, TimeStep
from rrr_traj_planner.core.trajectory.trajectory_points import TrajectoryPoints

SEEDS = range(4)
STEP = 1e-3
FREE = (-inf,) * 3, (inf,) * 3
RANGE = (-1.5,) * 3, (1.5,) * 3
BALANCE = 1e-6  # of the energy that is exchanged


def advanced(physics, state, torque, steps):
    for _ in range(steps):
        state = physics.step(physics.terms(state), state, torque, STEP)
    return state


def energy(arm, state):
    return float(kinetic_energy(arm, state[:3], state[3:]) + potential_energy(arm, state[:3]))


def random_state(rng, speed):
    return (*rng.uniform(-1.0, 1.0, 3).tolist(), *rng.uniform(-speed, speed, 3).tolist())


@pytest.mark.parametrize('seed', SEEDS)
def test_accelerations_are_those_of_the_articulated_body_algorithm(seed):
    arm, rng = random_arm(seed), np.random.default_rng(seed)
    step, reference = TimeStep(arm), PinocchioChain(arm)
    for _ in range(50):
        state, torque = random_state(rng, 3.0), rng.uniform(-50.0, 50.0, 3)
        found = step.accelerations(state, Load(torque=tuple(torque)))
        expected = reference.forward_dynamics(np.array(state[:3]), np.array(state[3:]), torque)
        np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize('seed', SEEDS)
def test_unactuated_chain_keeps_its_energy_for_ten_seconds(seed):
    arm = random_arm(seed)
    physics, scale = ArmPhysics(arm, *FREE), np.abs(arm.tables.potential).sum()
    state = random_state(np.random.default_rng(seed), 1.0)
    before = energy(arm, state)
    for _ in range(20):
        state = advanced(physics, state, (0.0,) * 3, 500)
        assert abs(energy(arm, state) - before) <= BALANCE * scale


@pytest.mark.parametrize(('seed', 'width'), [(0, 0.2), (1, 0.0), (2, 0.2), (3, 0.0)])
def test_work_is_energy_and_losses_with_friction_and_stops(seed, width):
    arm, rng = with_friction(random_arm(seed), seed), np.random.default_rng(seed)
    soft = SoftStops(width, 3000.0, 0.3)
    physics = ArmPhysics(arm, *RANGE, soft)
    state, most = random_state(rng, 2.0), np.abs(arm.tables.potential).max()
    before, supplied = energy(arm, state) + soft.energy(state, *RANGE), 0.0
    for _ in range(50):
        torque = tuple(rng.uniform(-most, most, 3).tolist())
        after = advanced(physics, state, torque, 200)
        supplied, state = supplied + work(torque, state, after), after
    lost = physics.ledger
    assert min(lost.viscous, lost.coulomb, lost.stops) > 0.1
    assert supplied - lost.dissipated == pytest.approx(
        energy(arm, state) + soft.energy(state, *RANGE) - before, abs=BALANCE * lost.dissipated)
    assert all(low - width <= q <= high + width for q, low, high in zip(state, *RANGE))


@pytest.mark.parametrize('seed', SEEDS)
def test_chain_with_less_load_than_friction_stays_exactly_at_rest(seed):
    rng = np.random.default_rng(seed)
    arm = with_friction(random_arm(seed), seed)
    q, coulomb = rng.uniform(-1.0, 1.0, 3), arm.friction.coulomb
    physics, start = ArmPhysics(arm, *RANGE), (*q.tolist(), 0.0, 0.0, 0.0)
    for _ in range(200):
        load = gravity_torque(arm, q) + rng.uniform(-0.999, 0.999, 3) * coulomb
        assert advanced(physics, start, tuple(load.tolist()), 1) == start
    joint = seed % 3
    load = gravity_torque(arm, q)
    load[joint] += 1.001 * coulomb[joint]
    after = advanced(physics, start, tuple(load.tolist()), 20)
    assert after[3 + joint] > 0.0


def line(end, duration):
    return TrajectoryPoints([0.0, duration], [np.zeros(3), end], np.zeros((2, 3)),
                            np.zeros((2, 3)), [True] * 2, [True] * 2)


def tracking_error(arm, known):
    """Return the largest error of following a motion, of a controller that knows friction."""
    friction = replace(arm.friction, known_to_controller=known)
    limits = JointLimits(*RANGE, max_effort=np.full(3, np.inf))
    controlled = ControlledArm(
        ArmSettings(replace(arm, friction=friction), limits, ControllerGains()), np.zeros(3))
    controlled.follow(line(np.array([0.8, -0.6, 0.7]), 2.0), 0)
    worst = 0.0
    for _ in range(100):
        controlled.advance(20)
        worst = max(worst, np.abs(np.subtract(controlled.state[:3],
                                              controlled.desired[:3])).max())
    return worst


@pytest.mark.parametrize('seed', SEEDS)
def test_controller_that_knows_friction_follows_more_closely(seed):
    arm = with_friction(random_arm(seed), seed)
    assert tracking_error(arm, True) < 0.2 * tracking_error(arm, False)


def test_an_arm_without_inertia_is_refused_with_what_to_give():
    arm = random_arm(0)
    massless = replace(arm, rotor_inertia=np.zeros(3), chain=replace(
        arm.chain, mass=np.zeros(3), inertia=np.zeros((3, 3, 3))))
    with pytest.raises(InvalidInputError, match='give masses or rotor_inertia'):
        ArmSettings(massless, JointLimits(), ControllerGains())
    ArmSettings(replace(massless, rotor_inertia=np.ones(3)), JointLimits(), ControllerGains())


@pytest.mark.parametrize('seed', SEEDS)
def test_largest_friction_that_is_accepted_needs_the_most_integration_steps(seed):
    arm, rng = random_arm(seed), np.random.default_rng(seed)
    q = np.column_stack((np.zeros(4000), rng.uniform(-np.pi, np.pi, (4000, 2))))
    worst = np.abs(np.linalg.eigvals(np.linalg.inv(inertia_matrix(arm, q)))).max()

    def accepts(viscous):
        try:
            check_step(replace(arm, friction=Friction([viscous] * 3)), SoftStops(), STEP)
        except InvalidInputError:
            return False
        return True

    most = MOST_STEPS / (worst * STEP)
    assert accepts(0.95 * most)
    assert not accepts(1.05 * most)


@pytest.mark.parametrize('seed', SEEDS)
def test_strong_viscous_friction_is_integrated_as_exactly_in_long_steps_as_in_short_ones(seed):
    """Time constants down to a fiftieth of a step; shorter steps by a physics of their own."""
    arm = random_arm(seed)
    q = np.random.default_rng(seed).uniform(-1.0, 1.0, 3)
    mobility = np.abs(np.linalg.eigvals(np.linalg.inv(inertia_matrix(arm, q)))).max()
    stiff = replace(arm, friction=Friction([50.0 / (mobility * STEP)] * 3))
    state = (*q.tolist(), 0.3, -0.2, 0.4)
    ends = []
    for parts in (1, 100):
        physics = ArmPhysics(stiff, (-inf,) * 3, (inf,) * 3)
        end = state
        for _ in range(40 * parts):
            end = physics.step(physics.terms(end), end, (1.0, -2.0, 3.0), STEP / parts)
        ends.append(end)
    np.testing.assert_allclose(ends[0], ends[1], atol=1e-7)
    assert np.abs(np.subtract(ends[0][3:], state[3:])).max() > 1e-3


@pytest.mark.parametrize('name', [p.stem for p in sorted(DESCRIPTIONS.glob('*.urdf'))
                                  if p.stem != 'planar_arm'])
def test_every_public_arm_holds_its_position_at_the_default_step(name):
    arm = described(DESCRIPTIONS / f'{name}.urdf')
    model = arm.model if not arm.model.singular_inertia_reason else replace(
        arm.model, rotor_inertia=np.full(3, 0.01))
    rest = np.clip(0.0, arm.limits.min_position, arm.limits.max_position)
    limits = replace(arm.limits, max_effort=np.full(3, np.inf))
    controlled = ControlledArm(ArmSettings(model, limits, ControllerGains()), rest)
    controlled.advance(300)
    np.testing.assert_allclose(controlled.measured[:3], rest, atol=1e-6)
