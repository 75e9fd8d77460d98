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

"""Tables of any chain of three revolute joints: against Pinocchio, and the thesis's equations."""

from helpers import thesis_equations
from helpers.random_cases import ARMS, random_states
from helpers.random_chains import PinocchioChain, random_arm
import numpy as np
import pytest
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.dynamics.rigid_body import (
    forward_dynamics,
    gravity_torque,
    inertia_matrix,
    inverse_dynamics,
    potential_energy,
)
from rrr_traj_planner.core.kinematics.forward import forward_kinematics, jacobian, jacobian_rate

SEEDS = range(20)
EXACT = 1e-12   # relative to the largest value: rounding


def agrees(ours, theirs, tolerance=EXACT):
    return np.abs(ours - theirs).max() <= tolerance * np.abs(theirs).max()


@pytest.mark.parametrize('seed', SEEDS)
def test_tip_and_its_jacobian_are_pinocchio_s(seed):
    arm, (q, qd, _) = random_arm(seed), random_states(np.random.default_rng(seed), 40)
    reference = PinocchioChain(arm)
    tip, J, rate = (np.array(x) for x in zip(*(reference.tip_motion(*s) for s in zip(q, qd))))
    assert agrees(forward_kinematics(arm, q), tip)
    assert agrees(jacobian(arm, q), J)
    assert agrees(jacobian_rate(arm, q, qd), rate)


@pytest.mark.parametrize('seed', SEEDS)
def test_dynamics_are_pinocchio_s(seed):
    arm, states = random_arm(seed), random_states(np.random.default_rng(seed), 40)
    reference = PinocchioChain(arm)
    assert agrees(inertia_matrix(arm, states[0]),
                  np.array([reference.inertia_matrix(q) for q in states[0]]))
    torque = np.array([reference.inverse_dynamics(*s) for s in zip(*states)])
    assert agrees(inverse_dynamics(arm, *states), torque)
    q, qd, _ = states
    assert agrees(forward_dynamics(arm, q, qd, torque),
                  np.array([reference.forward_dynamics(*s) for s in zip(q, qd, torque)]), 1e-9)


@pytest.mark.parametrize('seed', SEEDS[:5])
def test_gravity_is_the_gradient_of_the_potential_energy(seed):
    arm, (q, *_), e = random_arm(seed), random_states(np.random.default_rng(seed), 20), 1e-5
    steps = e * np.eye(3)
    slope = np.stack([(potential_energy(arm, q + s) - potential_energy(arm, q - s)) / (2.0 * e)
                      for s in steps], axis=-1)
    assert agrees(gravity_torque(arm, q), slope, 1e-7)


@pytest.mark.parametrize('arm', ARMS)
def test_the_thesis_s_equations_are_what_the_tables_of_its_arm_give(arm):
    q, qd, qdd = random_states(np.random.default_rng(7), 200)
    k = thesis_equations.constants(arm)
    t = thesis_equations.terms(k, q[:, 1], q[:, 2], np.sin, np.cos)
    M = inertia_matrix(arm, q)
    assert M[:, 0, 1:] == pytest.approx(np.zeros((200, 2)), abs=EXACT * M.max())
    for (i, j), expected in {(0, 0): t.M11, (1, 1): t.M22, (1, 2): t.M23,
                             (2, 2): np.full(200, t.M33)}.items():
        assert agrees(M[:, i, j], expected)
    torque = np.stack(thesis_equations.torques(t, *qd.T, *qdd.T), axis=-1)
    assert agrees(inverse_dynamics(arm, q, qd, qdd), torque)
    a2_d4 = np.stack((np.cos(q[:, 1]), np.sin(q[:, 1] + q[:, 2])))
    r = np.array((arm.a2, arm.d4)) @ a2_d4
    tip = np.stack((np.cos(q[:, 0]) * r, np.sin(q[:, 0]) * r, arm.d1 + arm.a2 * np.sin(q[:, 1])
                    - arm.d4 * np.cos(q[:, 1] + q[:, 2])), axis=-1)
    assert agrees(forward_kinematics(arm, q), tip)


def test_rotor_inertia_is_added_to_the_diagonal():
    arm, rotors = random_arm(3), np.array((0.1, 0.2, 0.3))
    bare = RobotModel(arm.chain, arm.gravity)
    with_rotors = RobotModel(arm.chain, arm.gravity, rotors)
    q = np.array((0.3, -0.4, 1.2))
    assert inertia_matrix(with_rotors, q) - inertia_matrix(bare, q) == pytest.approx(
        np.diag(rotors), abs=1e-12)


def test_tables_of_the_thesis_s_arm_are_short():
    # what the kernels' speed on that arm rests on: 10 of 81, 12 of 150 and 3 of 27 coefficients
    counts = [np.count_nonzero(table) for table in RobotModel().tables]
    assert counts == [10, 12, 3]
