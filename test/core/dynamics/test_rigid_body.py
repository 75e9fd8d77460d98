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

"""Dynamics: by Pinocchio, by hand, and by the laws that any arm obeys."""

from helpers import thesis_cases as thesis
from helpers.pinocchio_arm import PinocchioArm
from helpers.random_cases import ARMS, central_difference, random_model, random_states
from helpers.random_chains import random_arm
import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.dynamics.arm_dynamics import accelerations, ArmDynamics, torques
from rrr_traj_planner.core.dynamics.rigid_body import (
    coriolis_torque,
    forward_dynamics,
    gravity_torque,
    inertia_matrix,
    inverse_dynamics,
    kinetic_energy,
    potential_energy,
)
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.kinematics.inverse import inverse_kinematics
from scipy.integrate import solve_ivp

# What the project promises against Pinocchio, in N m, kg m^2 and J; values reach some thousand.
AGREEMENT = 1e-10
# Fourth-order differences of functions whose scale is about 100.
DIFFERENCES = 1e-6


@pytest.mark.parametrize('arm', ARMS)
def test_torques_inertia_coriolis_and_gravity_agree_with_pinocchio(arm):
    reference = PinocchioArm(arm)
    q, qd, qdd = random_states(np.random.default_rng(41), 1000)
    states = list(zip(q, qd, qdd))
    for ours, theirs in (
            (inverse_dynamics(arm, q, qd, qdd), [reference.inverse_dynamics(*s) for s in states]),
            (inertia_matrix(arm, q), [reference.inertia_matrix(s[0]) for s in states]),
            (coriolis_torque(arm, q, qd), [reference.coriolis_torque(*s[:2]) for s in states]),
            (gravity_torque(arm, q), [reference.gravity_torque(s[0]) for s in states])):
        assert ours == pytest.approx(np.array(theirs), abs=AGREEMENT)


def test_a_hundred_other_arms_agree_with_pinocchio():
    rng = np.random.default_rng(42)
    for _ in range(100):
        arm = random_model(rng)
        reference = PinocchioArm(arm)
        q, qd, qdd = random_states(rng, 10)
        for i in range(10):
            state = q[i], qd[i], qdd[i]
            assert inverse_dynamics(arm, *state) == pytest.approx(
                reference.inverse_dynamics(*state), abs=AGREEMENT)


@pytest.mark.parametrize('arm', ARMS)
def test_accelerations_agree_with_pinocchio(arm):
    reference = PinocchioArm(arm)
    q, qd, _ = random_states(np.random.default_rng(43), 200)
    tau = np.random.default_rng(44).normal(0.0, 200.0, (200, 3))
    expected = np.array([reference.forward_dynamics(*state) for state in zip(q, qd, tau)])
    # Solving loses the digits of the inertia's condition, below 1e3 for these arms.
    assert forward_dynamics(arm, q, qd, tau) == pytest.approx(expected, rel=1e-10, abs=1e-9)


@pytest.mark.parametrize('arm', ARMS)
def test_forward_dynamics_inverts_inverse_dynamics(arm):
    q, qd, qdd = random_states(np.random.default_rng(45), 1000)
    tau = inverse_dynamics(arm, q, qd, qdd)
    assert forward_dynamics(arm, q, qd, tau) == pytest.approx(qdd, rel=1e-10, abs=1e-9)


@pytest.mark.parametrize('arm', ARMS)
def test_torque_is_inertia_times_acceleration_plus_coriolis_plus_gravity(arm):
    q, qd, qdd = random_states(np.random.default_rng(46), 100)
    parts = (np.einsum('nij,nj->ni', inertia_matrix(arm, q), qdd)
             + coriolis_torque(arm, q, qd) + gravity_torque(arm, q))
    assert inverse_dynamics(arm, q, qd, qdd) == pytest.approx(parts, abs=AGREEMENT)


def test_torque_at_rest_equals_gravity():
    q = random_states(np.random.default_rng(47), 100)[0]
    still = np.zeros_like(q)
    torque = inverse_dynamics(RobotModel(), q, still, still)
    assert torque == pytest.approx(gravity_torque(RobotModel(), q), abs=AGREEMENT)


@pytest.mark.parametrize('arm', ARMS)
def test_inertia_is_symmetric_and_positive_definite(arm):
    H = inertia_matrix(arm, random_states(np.random.default_rng(48), 2000)[0])
    assert (H == np.swapaxes(H, -1, -2)).all()
    assert np.linalg.eigvalsh(H).min() > 0.0


@pytest.mark.parametrize('arm', ARMS)
def test_coriolis_torques_are_christoffel_s_symbols_of_the_inertia(arm):
    for q, qd, _ in zip(*random_states(np.random.default_rng(49), 30)):
        dH = np.array([central_difference(
            lambda x, d=d, q=q: inertia_matrix(arm, q + x * d), 0.0, 1e-3) for d in np.eye(3)])
        # h_i = sum over j, k of (dH_ij/dq_k - (dH_jk/dq_i) / 2) qd_j qd_k
        h = np.einsum('kij,j,k->i', dH, qd, qd) - 0.5 * np.einsum('ijk,j,k->i', dH, qd, qd)
        assert coriolis_torque(arm, q, qd) == pytest.approx(h, abs=DIFFERENCES)


@pytest.mark.parametrize('arm', ARMS)
def test_coriolis_torques_do_the_work_that_changing_inertia_takes(arm):
    # dH/dt - 2 C is skew-symmetric: qd . h = qd . (dH/dt) qd / 2.
    q, qd, _ = random_states(np.random.default_rng(50), 200)
    rate = central_difference(lambda t: inertia_matrix(arm, q + t * qd), 0.0, 2e-4)
    half = 0.5 * np.einsum('ni,nij,nj->n', qd, rate, qd)
    power = np.einsum('ni,ni->n', qd, coriolis_torque(arm, q, qd))
    assert power == pytest.approx(half, abs=10 * DIFFERENCES)


@pytest.mark.parametrize('arm', ARMS)
def test_gravity_torque_is_the_slope_of_potential_energy(arm):
    q = random_states(np.random.default_rng(51), 200)[0]
    slopes = [central_difference(lambda x, d=d: potential_energy(arm, q + x * d), 0.0, 1e-3)
              for d in np.eye(3)]
    assert gravity_torque(arm, q) == pytest.approx(np.transpose(slopes), abs=DIFFERENCES)


@pytest.mark.parametrize('arm', ARMS)
def test_energies_agree_with_pinocchio(arm):
    reference = PinocchioArm(arm)
    q, qd, _ = random_states(np.random.default_rng(52), 200)
    expected = np.array([reference.kinetic_energy(a, b) for a, b in zip(q, qd)])
    assert kinetic_energy(arm, q, qd) == pytest.approx(expected, abs=AGREEMENT)
    # Ours is zero with the links level with the shoulder, which holds link 1's centre of mass.
    shift = arm.mass.sum() * arm.g * arm.d1
    expected = np.array([reference.potential_energy(a) - shift for a in q])
    assert potential_energy(arm, q) == pytest.approx(expected, abs=AGREEMENT)


@pytest.mark.parametrize('arm', ARMS)
def test_power_of_the_motors_is_the_change_of_energy(arm):
    q, qd, qdd = random_states(np.random.default_rng(53), 200)

    def energy(t):
        position, velocity = q + t * qd + 0.5 * t * t * qdd, qd + t * qdd
        return kinetic_energy(arm, position, velocity) + potential_energy(arm, position)

    power = np.einsum('ni,ni->n', inverse_dynamics(arm, q, qd, qdd), qd)
    by_differences = central_difference(energy, 0.0, 2e-4)
    assert power == pytest.approx(by_differences, rel=1e-8, abs=10 * DIFFERENCES)


def test_unactuated_arm_keeps_its_energy_for_ten_seconds():
    arm, start = RobotModel(), np.array([0.3, 0.4, 1.0, 0.5, 0.0, 0.0])
    fall = solve_ivp(
        lambda _, x: np.concatenate((x[3:], forward_dynamics(arm, x[:3], x[3:], np.zeros(3)))),
        (0.0, 10.0), start, method='DOP853', rtol=1e-11, atol=1e-11)
    q, qd = fall.y[:3].T, fall.y[3:].T
    energy = kinetic_energy(arm, q, qd) + potential_energy(arm, q)
    assert np.ptp(kinetic_energy(arm, q, qd)) > 100.0  # it does fall [J]
    assert energy == pytest.approx(np.full(len(q), energy[0]), abs=1e-6)


def test_inertia_of_the_stretched_arm_is_what_a_hand_calculation_gives():
    # Level and straight: r2 = 0.5 m, r3 = 1.4 m from joint axis 1.
    H = inertia_matrix(RobotModel(), (0.7, 0.0, np.pi / 2))
    assert H == pytest.approx(np.array([
        [0.1 + 0.12 + 0.12 + 16 * 0.25 + 12 * 1.96, 0.0, 0.0],
        [0.0, 0.01 + 0.12 + 16 * 0.25 + 12 * 1.96, 0.12 + 12 * 1.4 * 0.5],
        [0.0, 0.12 + 12 * 1.4 * 0.5, 0.12 + 12 * 0.25]]), abs=1e-13)


def test_gravity_on_the_stretched_arm_is_what_a_hand_calculation_gives():
    g = gravity_torque(RobotModel(), (0.7, 0.0, np.pi / 2))
    assert g == pytest.approx((0.0, 9.81 * (16 * 0.5 + 12 * 1.4), 9.81 * 12 * 0.5), abs=1e-12)


def test_arm_pointing_straight_up_needs_no_torque():
    g = gravity_torque(RobotModel(), (0.7, np.pi / 2, np.pi / 2))
    assert g == pytest.approx(np.zeros(3), abs=1e-12)


def test_spinning_stretched_arm_needs_no_torque_but_a_raised_forearm_does():
    # Level and straight, centrifugal forces point along the arm; with the forearm raised to
    # vertical, 12 kg at 0.9 m from the axis pull it outward over a lever of 0.5 m.
    still = coriolis_torque(RobotModel(), (0.0, 0.0, np.pi / 2), (3.0, 0.0, 0.0))
    assert still == pytest.approx(np.zeros(3), abs=1e-13)
    h = coriolis_torque(RobotModel(), (0.0, 0.0, np.pi), (3.0, 0.0, 0.0))
    assert h[2] == pytest.approx(12 * 0.9 * 0.5 * 9.0, abs=1e-12)


def test_potential_energy_is_zero_with_both_links_level_with_the_shoulder():
    assert potential_energy(RobotModel(), (0.0, 0.0, np.pi / 2)) == pytest.approx(0.0, abs=1e-13)
    lifted = potential_energy(RobotModel(), (0.0, np.pi / 2, np.pi / 2))
    assert lifted == pytest.approx(9.81 * (16 * 0.5 + 12 * 1.4), abs=1e-12)


@pytest.mark.parametrize('name', thesis.POINTS)
def test_holding_torque_of_joint_2_at_the_thesis_s_points(name):
    position, _, torque = thesis.POINTS[name]
    q = inverse_kinematics(RobotModel(), position, 'up')
    assert gravity_torque(RobotModel(), q)[1] == pytest.approx(
        torque, abs=thesis.TORQUE_TOLERANCE)


def test_last_point_of_table_6_3_alone_is_beyond_joint_2_s_torque_on_both_branches():
    limit = JointLimits().max_effort[1]
    beyond = [name for name, (position, _, _) in thesis.POINTS.items() if gravity_torque(
        RobotModel(), inverse_kinematics(RobotModel(), position))[1] > limit]
    assert beyond == [thesis.POINT_THAT_CANNOT_BE_HELD]
    down = inverse_kinematics(RobotModel(), thesis.POINTS[beyond[0]][0], 'down')
    assert gravity_torque(RobotModel(), down)[1] == pytest.approx(
        thesis.HOLDING_TORQUE_THERE_ELBOW_DOWN, abs=thesis.TORQUE_TOLERANCE)


def test_many_states_at_once_equal_one_by_one():
    arm = ARMS[3]
    q, qd, qdd = (v.reshape(4, 5, 3) for v in random_states(np.random.default_rng(54), 20))
    cases = [(inertia_matrix, (q,)), (gravity_torque, (q,)), (coriolis_torque, (q, qd)),
             (inverse_dynamics, (q, qd, qdd)), (forward_dynamics, (q, qd, qdd)),
             (kinetic_energy, (q, qd)), (potential_energy, (q,))]
    for function, arguments in cases:
        at_once = function(arm, *arguments)
        for i in np.ndindex(4, 5):
            one = function(arm, *(a[i] for a in arguments))
            assert np.shape(at_once[i]) == np.shape(one)
            assert at_once[i] == pytest.approx(one, rel=1e-12, abs=1e-10)


def test_floats_and_arrays_give_the_same_equations():
    arm = random_arm(1)
    dynamics = ArmDynamics(arm)
    for q, qd, x in zip(*(v.tolist() for v in random_states(np.random.default_rng(55), 100))):
        t = dynamics((*q, *qd))
        assert all(type(value) is float for value in t)
        assert torques(t, *x) == pytest.approx(
            inverse_dynamics(arm, [q], [qd], [x])[0], rel=1e-12, abs=1e-10)
        assert accelerations(t, *x) == pytest.approx(
            forward_dynamics(arm, [q], [qd], [x])[0], rel=1e-11, abs=1e-10)


@pytest.mark.parametrize('function', [inverse_dynamics, forward_dynamics])
def test_one_state_goes_with_many(function):
    many = random_states(np.random.default_rng(56), 20)
    for mixed in ((many[0][0], many[1], many[2]), (many[0], many[1][0], many[2][0]),
                  (many[0][0], many[1][0], many[2])):
        expected = function(RobotModel(), *np.broadcast_arrays(*mixed))
        assert function(RobotModel(), *mixed) == pytest.approx(expected, rel=1e-12, abs=1e-10)


@pytest.mark.parametrize('function', [inverse_dynamics, forward_dynamics])
@pytest.mark.parametrize('value', [np.inf, -np.inf, np.nan])
@pytest.mark.parametrize('shape', [(3,), (4, 3)])
def test_position_that_is_no_number_is_refused(function, value, shape):
    still = np.zeros(shape)
    q = still.copy()
    q[..., 1] = value
    where = r'q\[1\]' if len(shape) == 1 else r'q\[0\]\[1\]'
    with pytest.raises(InvalidInputError, match=f'^{where} is {value}, must be finite$'):
        function(RobotModel(), q, still, still)


@pytest.mark.parametrize('function', [inverse_dynamics, forward_dynamics])
def test_states_of_different_numbers_are_refused(function):
    with pytest.raises(InvalidInputError, match=(
            r'^shapes do not go together: q \(4, 3\), qd \(5, 3\), \w+ \(3,\)$')):
        function(RobotModel(), np.zeros((4, 3)), np.zeros((5, 3)), np.zeros(3))


@pytest.mark.parametrize(('function', 'names'), [
    (inertia_matrix, ['q']), (gravity_torque, ['q']), (coriolis_torque, ['q', 'qd']),
    (inverse_dynamics, ['q', 'qd', 'qdd']), (forward_dynamics, ['q', 'qd', 'tau']),
    (kinetic_energy, ['q', 'qd']), (potential_energy, ['q'])])
def test_wrong_shape_is_refused_by_name(function, names):
    for name in names:
        values = {n: np.zeros(3) for n in names}
        values[name] = np.zeros((3, 2))
        with pytest.raises(InvalidInputError,
                           match=rf'^{name} has shape \(3, 2\), must have \(\.\.\., 3\)$'):
            function(RobotModel(), **values)
