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

"""A point mass at the tip, against Pinocchio with a body of its own there."""

from __future__ import annotations

from math import inf, nan

from helpers.pinocchio_arm import PinocchioArm
from helpers.random_cases import ARMS, random_states
from helpers.random_chains import PinocchioChain, random_arm
import numpy as np
import pytest
from rrr_traj_planner.core.arm.payload import Payload, with_payload
from rrr_traj_planner.core.dynamics.rigid_body import (
    forward_dynamics,
    inertia_matrix,
    inverse_dynamics,
    kinetic_energy,
    potential_energy,
)
from rrr_traj_planner.core.errors import InvalidInputError

MASSES = (0.0, 0.3, 8.0, 60.0)

# Two algorithms that solve the same equations in another order.
RELATIVE = 1e-10

EXACT = 1e-12  # of the largest value: rounding


@pytest.mark.parametrize('mass', MASSES)
@pytest.mark.parametrize('arm', ARMS, ids=range(len(ARMS)))
def test_accelerations_equal_the_articulated_body_algorithm_s(arm, mass):
    rng = np.random.default_rng(11)
    reference, loaded = PinocchioArm(arm, mass), with_payload(arm, mass)
    for q, qd, _ in zip(*random_states(rng, 100)):
        tau = rng.normal(0.0, 200.0, 3)
        expected = reference.forward_dynamics(q, qd, tau)
        error = np.abs(forward_dynamics(loaded, q, qd, tau) - expected).max()
        assert error <= RELATIVE * np.abs(expected).max()


@pytest.mark.parametrize('mass', MASSES)
@pytest.mark.parametrize('seed', range(10))
def test_load_on_any_chain_is_a_body_of_its_own_at_the_tip(seed, mass):
    rng, arm = np.random.default_rng(seed), random_arm(seed)
    reference, loaded = PinocchioChain(arm, mass), with_payload(arm, mass)
    states = random_states(rng, 40)
    torque = np.array([reference.inverse_dynamics(*s) for s in zip(*states)])
    M = np.array([reference.inertia_matrix(q) for q in states[0]])
    for ours, theirs in ((inverse_dynamics(loaded, *states), torque),
                         (inertia_matrix(loaded, states[0]), M)):
        assert np.abs(ours - theirs).max() <= EXACT * np.abs(theirs).max()


def test_load_changes_nothing_but_link_3():
    arm = random_arm(3)
    loaded = with_payload(arm, 2.0)
    for name in ('gravity', 'rotor_inertia', 'friction', 'joint_names'):
        assert getattr(loaded, name) is getattr(arm, name) or np.array_equal(
            getattr(loaded, name), getattr(arm, name))
    for name in ('axis', 'point', 'tip'):
        assert getattr(loaded.chain, name).tolist() == getattr(arm.chain, name).tolist()
    for name in ('mass', 'centre', 'inertia'):
        ours, bare = getattr(loaded.chain, name), getattr(arm.chain, name)
        assert ours[:2].tolist() == bare[:2].tolist()
    assert loaded.chain.mass[2] == arm.chain.mass[2] + 2.0


def test_energies_equal_pinocchio_s_but_for_the_height_that_counts_from_elsewhere():
    arm, mass = ARMS[1], 5.0
    reference, loaded = PinocchioArm(arm, mass), with_payload(arm, mass)
    q, qd, _ = random_states(np.random.default_rng(12), 30)
    for a, v in zip(q, qd):
        np.testing.assert_allclose(
            kinetic_energy(loaded, a, v), reference.kinetic_energy(a, v), rtol=1e-12)
    height = [reference.potential_energy(a) - potential_energy(loaded, a) for a in q]
    np.testing.assert_allclose(height, height[0], rtol=1e-9)


def test_no_payload_is_the_same_arm():
    assert with_payload(ARMS[0], 0.0) is ARMS[0]


@pytest.mark.parametrize('mass', [-1.0, nan, inf])
def test_mass_that_is_none_is_refused(mass):
    with pytest.raises(InvalidInputError, match='^mass is .* kg, must (not be negative|be fin)'):
        Payload(mass)
