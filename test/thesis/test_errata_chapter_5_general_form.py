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

"""Equation 5.34, the general form of the torques, as printed and as corrected."""

from helpers.comparison import differ
from helpers.pinocchio_arm import PinocchioArm
from helpers.random_cases import ARMS, central_difference, random_states
import numpy as np
import pytest

# Fourth-order differences of functions whose scale is about 100.
DIFFERENCES = 1e-6


def states(seed, n=20):
    return list(zip(*random_states(np.random.default_rng(seed), n)))


@pytest.mark.parametrize('arm', ARMS)
def test_5_34_has_the_sign_of_gravity_wrong(arm):
    # At rest Q is the slope of U alone; 5.38 prints it with the right sign.
    reference = PinocchioArm(arm)
    for q, _, _ in states(311):
        slope = [central_difference(lambda x, d=d, q=q: reference.potential_energy(q + x * d),
                                    0.0, 1e-3) for d in np.eye(3)]
        true = reference.inverse_dynamics(q, np.zeros(3), np.zeros(3))
        assert slope == pytest.approx(true, abs=DIFFERENCES)
        assert differ(-np.array(slope), true)


@pytest.mark.parametrize('arm', ARMS)
def test_5_34_lacks_half_of_its_velocity_terms(arm):
    # A depends on positions alone, so its derivative by a velocity is 0. Read as a derivative by
    # the position theta_l, with the second velocity theta_l', the term is (dH/dt) qd: still not h.
    reference, cases = PinocchioArm(arm), states(312)
    true, kindly, corrected = [], [], []
    for q, qd, _ in cases:
        dH = np.array([central_difference(
            lambda x, d=d, q=q: reference.inertia_matrix(q + x * d), 0.0, 1e-3)
            for d in np.eye(3)])
        true.append(reference.coriolis_torque(q, qd))
        kindly.append(np.einsum('lik,k,l->i', dH, qd, qd))
        corrected.append(kindly[-1] - 0.5 * np.einsum('ikl,k,l->i', dH, qd, qd))
    assert differ(np.zeros_like(true), true)
    assert differ(kindly, true)
    assert np.array(corrected) == pytest.approx(np.array(true), abs=DIFFERENCES)
