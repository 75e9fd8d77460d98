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

"""Section 5.4 as printed and as corrected: directions at the via point, and the optimisation."""

from helpers.comparison import differ, length, ROUNDING
import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.dynamics.rigid_body import inverse_dynamics
from rrr_traj_planner.core.kinematics.forward import jacobian, jacobian_rate
from rrr_traj_planner.core.kinematics.inverse import inverse_kinematics

# Three points whose lines differ in length, as those of table 6.1 do [m].
BEFORE, VIA, AFTER = np.array([[1.02, 0.59, 0.97], [0.46, 0.55, 1.44], [0.45, 0.38, 1.45]])
# Three whose lines are equally long, where the printed forms hold.
EVEN = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]])


def unit(v):
    return v / length(v)


def directions(before, via, after, as_units):
    """Return tangent (5.56) and normal (5.64) of raw or of unit vectors along the lines."""
    first, second = via - before, after - via
    if as_units:
        first, second = unit(first), unit(second)
    return unit(first + second), unit(second - first)


def test_5_56_s_and_5_64_s_vectors_are_orthogonal_only_as_units():
    T, N = directions(BEFORE, VIA, AFTER, as_units=False)
    assert differ(T @ N, 0.0)
    T, N = directions(BEFORE, VIA, AFTER, as_units=True)
    assert T @ N == pytest.approx(0.0, abs=ROUNDING)
    T, N = directions(*EVEN, as_units=False)
    assert T @ N == pytest.approx(0.0, abs=ROUNDING)


def test_5_56_is_the_tangent_of_the_circle_only_with_unit_vectors():
    normal = directions(BEFORE, VIA, AFTER, as_units=True)[1]
    along = np.cross(np.cross(VIA - BEFORE, AFTER - VIA), normal)  # in the plane, across N
    for as_units, holds in ((False, False), (True, True)):
        T = directions(BEFORE, VIA, AFTER, as_units)[0]
        assert (length(np.cross(T, unit(along))) < ROUNDING) == holds


def test_5_64_halves_the_corner_only_with_unit_vectors():
    for as_units, holds in ((False, False), (True, True)):
        N = directions(BEFORE, VIA, AFTER, as_units)[1]
        gap = N @ unit(BEFORE - VIA) - N @ unit(AFTER - VIA)
        assert (abs(gap) < ROUNDING) == holds


def test_torque_constraint_needs_the_modulus():
    # A forearm swung down harder than the motor can: far below 200 N m as printed.
    limits = JointLimits()
    q, still = np.array([0.3, 0.9, 0.2]), np.zeros(3)
    torque = inverse_dynamics(RobotModel(), q, still, (0.0, -60.0, 0.0))
    assert (torque <= limits.max_effort).all()
    assert (np.abs(torque) > limits.max_effort).any()


def test_direction_constraints_need_their_signs():
    T = unit(np.array([0.6, -0.3, 0.5]))
    for signs in ((-1.0, -1.0, -1.0), (1.0, -1.0, 1.0)):
        v = 0.8 * T * signs  # backwards, and off to a side
        assert v ** 2 - T ** 2 * (v @ v) == pytest.approx(np.zeros(3), abs=ROUNDING)  # as printed
        assert differ(v, T * length(v))
    v = 0.8 * T
    assert v == pytest.approx(T * length(v), abs=ROUNDING)


def test_least_radius_has_no_minimum_above_0_unless_the_speed_is_given():
    arm, limits = RobotModel(), JointLimits()
    T, N = directions(BEFORE, VIA, AFTER, as_units=True)
    q, radii = inverse_kinematics(arm, VIA), []
    for speed in (0.1, 0.01, 0.001):
        J = jacobian(arm, q)
        qd = np.linalg.solve(J, speed * T)
        qdd = np.linalg.solve(J, 0.5 * N - jacobian_rate(arm, q, qd) @ qd)
        velocity, acceleration = J @ qd, J @ qdd + jacobian_rate(arm, q, qd) @ qd
        assert (np.abs(inverse_dynamics(arm, q, qd, qdd)) <= limits.max_effort).all()
        assert velocity @ acceleration == pytest.approx(0.0, abs=ROUNDING)  # 5.62
        radii.append(length(velocity) ** 3 / length(np.cross(velocity, acceleration)))  # 5.55
    assert radii == pytest.approx([2e-2, 2e-4, 2e-6], rel=1e-9)
