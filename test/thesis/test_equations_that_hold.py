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

"""Numbered equations that hold as printed and have no function of the package to test them by."""

from helpers import table_5_1
from helpers.comparison import length, rate, ROUNDING
from helpers.random_cases import ARMS, random_states
import numpy as np
import pytest
from rrr_traj_planner.core.dynamics.rigid_body import kinetic_energy

T_ACC, T_1 = 0.5, 1.3                                 # s
DELTA_B, DELTA_C, B = -0.35, 0.8, 0.6                 # rad
POINTS = np.array([[1.02, 0.59, 0.97], [0.46, 0.55, 1.44], [0.45, 0.38, 1.45]])


def test_3_2_is_the_derivative_of_3_1():
    mu, sigma, t = 0.4, 0.3, np.linspace(0.0, 1.0, 9)

    def gauss(x):
        return np.exp(-0.5 * ((x - mu) / sigma) ** 2) / (np.sqrt(2.0 * np.pi) * sigma)

    printed = -(t - mu) / (np.sqrt(2.0 * np.pi) * sigma ** 3) * np.exp(
        -0.5 * ((t - mu) / sigma) ** 2)
    assert printed == pytest.approx(rate(gauss, t), abs=ROUNDING)


def test_3_5_to_3_7_are_derivative_and_integrals_of_3_4():
    a, b, c, d, e = 0.21, 0.8, 1.1, -0.3, 0.4
    t = np.linspace(0.0, 2.0, 9)

    def position(x):
        return 0.5 * c * x ** 2 + d * x + b * a ** 2 * np.cos(x / a) + e

    def velocity(x):
        return c * x - b * a * np.sin(x / a) + d

    def acceleration(x):
        return c - b * np.cos(x / a)

    for lower, higher in ((position, velocity), (velocity, acceleration),
                          (acceleration, lambda x: b / a * np.sin(x / a))):
        assert rate(lower, t) == pytest.approx(higher(t), abs=ROUNDING)


def test_5_29_s_trace_is_the_square_of_the_speed():
    for arm in ARMS:
        for q, qd, _ in zip(*random_states(np.random.default_rng(401), 10)):
            energy = 0.5 * arm.inertia[0, 1] * qd[0] ** 2  # link 1 turns about its y axis
            for link in (2, 3):
                V = rate(lambda x, i=link, a=arm: table_5_1.centre_of_mass(a, x, i), q, qd)
                w = table_5_1.angular_velocity(arm, q, qd, link)
                energy += 0.5 * np.trace(arm.mass[link - 1] * np.outer(V, V))
                energy += 0.5 * w @ np.diag(arm.inertia[link - 1]) @ w
            assert kinetic_energy(arm, q, qd) == pytest.approx(energy, abs=1e-10)


def curve(t):
    """Return a curve in space, run at a changing speed."""
    return np.stack([np.cos(t) + 0.3 * t ** 2, np.sin(2.0 * t), 0.5 * t + 0.2 * t ** 3], axis=-1)


def curve_velocity(t):
    return np.stack([-np.sin(t) + 0.6 * t, 2.0 * np.cos(2.0 * t), 0.5 + 0.6 * t ** 2], axis=-1)


@pytest.mark.parametrize('t', [0.2, 0.7, 1.4])
def test_3_13_to_3_15_and_5_55_give_the_radius_of_curvature(t):
    v, a = rate(curve, t), rate(curve_velocity, t)
    assert v == pytest.approx(curve_velocity(t), abs=ROUNDING)
    turning = rate(lambda x: curve_velocity(x) / length(curve_velocity(x)), t)
    assert length(turning) / length(v) == pytest.approx(
        length(np.cross(v, a)) / length(v) ** 3, abs=ROUNDING)


@pytest.mark.parametrize('t', [0.2, 0.7, 1.4])
def test_5_57_to_5_62_speed_and_its_rate(t):
    v, a = curve_velocity(t), rate(curve_velocity, t)
    speed_rate = rate(lambda x: length(curve_velocity(x)), t)  # of 5.59
    assert v @ a / length(v) == pytest.approx(speed_rate, abs=ROUNDING)
    # On a circle at constant speed both vanish together.
    circle = np.array([-2.0 * np.sin(2.0 * t), 2.0 * np.cos(2.0 * t)])
    assert circle @ (-4.0 * np.array([np.cos(2.0 * t), np.sin(2.0 * t)])) == pytest.approx(
        0.0, abs=ROUNDING)


def test_5_63_to_5_68_tangents_meet_the_circle_through_the_via_point():
    before, via, after = POINTS
    first, second = (after - via) / length(after - via), (before - via) / length(before - via)
    N = (first + second) / length(first + second)
    normal, rho = np.cross(before - via, after - via), 0.05
    centre = via + rho * N
    for point in (before, after):
        out, reach = point - centre, length(point - centre)
        across = np.cross(normal, out) / length(np.cross(normal, out))
        for side in (-1.0, 1.0):  # 5.67 has two solutions; the path takes the outer one
            contact = centre + rho * (rho * out / reach + side * np.sqrt(
                reach ** 2 - rho ** 2) * across) / reach
            assert length(contact - centre) == pytest.approx(rho, abs=ROUNDING)
            assert normal @ (contact - via) == pytest.approx(0.0, abs=ROUNDING)
            assert length(contact - point) ** 2 == pytest.approx(
                reach ** 2 - rho ** 2, abs=ROUNDING)
            assert (contact - point) @ (contact - centre) == pytest.approx(0.0, abs=ROUNDING)
    assert length(via - centre) == pytest.approx(rho, abs=ROUNDING)


def blend(t):
    """Return position, velocity, acceleration and jerk of 6.5 to 6.8 at t in [-t_acc, t_acc]."""
    h, change = (t + T_ACC) / (2.0 * T_ACC), DELTA_C * T_ACC / T_1 + DELTA_B
    return ((change * (2.0 - h) * h ** 2 - 2.0 * DELTA_B) * h + B + DELTA_B,
            (change * (1.5 - h) * 2.0 * h ** 2 - DELTA_B) / T_ACC,
            change * (1.0 - h) * 3.0 * h / T_ACC ** 2,
            change * (1.0 - 2.0 * h) * 3.0 / (2.0 * T_ACC ** 3))


def test_6_6_to_6_8_are_derivatives_of_6_5():
    t = np.linspace(-T_ACC, T_ACC, 9)
    for order in range(3):
        assert rate(lambda x, n=order: blend(x)[n], t) == pytest.approx(
            blend(t)[order + 1], abs=ROUNDING)


def test_6_5_joins_both_lines_with_their_velocities():
    start, end = blend(-T_ACC), blend(T_ACC)
    assert start[:3] == pytest.approx((B + DELTA_B, -DELTA_B / T_ACC, 0.0), abs=ROUNDING)
    assert end[:3] == pytest.approx(
        (B + DELTA_C * T_ACC / T_1, DELTA_C / T_1, 0.0), abs=ROUNDING)


def test_6_2_to_6_4_are_derivatives_of_6_1():
    a4, a3, a2, a1, a0, t = 0.7, -1.1, 0.4, 0.9, -0.2, np.linspace(-1.0, 1.0, 9)
    forms = (lambda x: a4 * x ** 4 + a3 * x ** 3 + a2 * x ** 2 + a1 * x + a0,
             lambda x: 4.0 * a4 * x ** 3 + 3.0 * a3 * x ** 2 + 2.0 * a2 * x + a1,
             lambda x: 12.0 * a4 * x ** 2 + 6.0 * a3 * x + 2.0 * a2,
             lambda x: 24.0 * a4 * x + 6.0 * a3)
    for lower, higher in zip(forms[:-1], forms[1:]):
        assert rate(lower, t) == pytest.approx(higher(t), abs=ROUNDING)
