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

"""Chapter 3 as printed and as corrected: Gauss's series, the cycloid, tangent and curvature."""

from math import factorial

from helpers.comparison import differ, length, rate, ROUNDING
import numpy as np
import pytest
from rrr_traj_planner.core.motion_laws.cycloid import CycloidPiece

RADIUS = 1.7        # m
TIMES = np.linspace(0.1, 0.9, 9)


def test_3_3_sum_starts_at_0():
    mu, sigma, t = 0.45, 0.3, np.linspace(0.0, 1.0, 11)

    def series(first):
        return sum((-0.5) ** n / factorial(n) * ((t - mu) / sigma) ** (2 * n)
                   for n in range(first, 40)) / (np.sqrt(2.0 * np.pi) * sigma)

    gauss = np.exp(-0.5 * ((t - mu) / sigma) ** 2) / (np.sqrt(2.0 * np.pi) * sigma)
    assert differ(series(1), gauss)
    assert series(0) == pytest.approx(gauss, abs=ROUNDING)


def test_3_4_offset_determines_initial_acceleration_not_jerk():
    b, w = 0.8, 2.0 * np.pi
    starts = [CycloidPiece(1.3, 0.2, 0.4, c, b, w).at(0.0) for c in (-0.5, 0.8, 2.0)]
    assert [float(start[3]) for start in starts] == [0.0, 0.0, 0.0]
    assert [float(start[2]) for start in starts] == pytest.approx([-1.3, 0.0, 1.2], abs=ROUNDING)


def quarter_circle(angle):
    """Return a point of a circle in a plane that is not a coordinate plane."""
    e1, e2 = np.array([0.6, 0.8, 0.0]), np.array([0.0, 0.0, 1.0])
    return RADIUS * (np.cos(angle) * e1 + np.sin(angle) * e2)


def test_3_10_and_3_11_need_arc_length_not_the_normalised_parameter():
    arc = 0.5 * np.pi * RADIUS

    def tangent(s, whole):  # s runs from 0 to whole: 1, or the arc's length
        return rate(lambda x: quarter_circle(0.5 * np.pi * x / whole), s)

    def curvature(s, whole):
        h = 1e-4 * whole
        return length(tangent(s + h, whole) - tangent(s - h, whole)) / (2.0 * h)

    assert length(tangent(0.3, 1.0)) == pytest.approx(arc, abs=ROUNDING)  # not a unit vector
    assert differ(curvature(0.3, 1.0), 1.0 / RADIUS)
    assert length(tangent(0.3 * arc, arc)) == pytest.approx(1.0, abs=ROUNDING)
    assert curvature(0.3 * arc, arc) == pytest.approx(1.0 / RADIUS, abs=1e-7)  # differences


def angle_in_time(t):
    """Return the angle on the circle of a motion whose speed changes."""
    return 0.4 * t + 0.7 * t ** 2


def velocity(t):
    return rate(lambda x: quarter_circle(angle_in_time(x)), t)


def acceleration(t):
    """Return the second derivative, by the chain rule from the circle's own."""
    d, dd = 0.4 + 1.4 * t, 1.4
    return -d ** 2 * quarter_circle(angle_in_time(t)) + dd * rate(quarter_circle, angle_in_time(t))


def test_3_16_holds_at_constant_speed_alone():
    for t in TIMES:
        v, a = velocity(t), acceleration(t)
        printed = length(a) / length(v) ** 2
        assert differ(printed, 1.0 / RADIUS)
        assert length(np.cross(v, a)) / length(v) ** 3 == pytest.approx(
            1.0 / RADIUS, abs=ROUNDING)
        # The part of the acceleration across the path would do: all of it at constant speed.
        across = a - v * (v @ a) / (v @ v)
        assert length(across) / length(v) ** 2 == pytest.approx(1.0 / RADIUS, abs=ROUNDING)


def test_3_16_gives_a_straight_line_a_curvature():
    # x = t^2 along a line: 2 / (2 t)^2 as printed.
    direction = np.array([0.6, 0.8, 0.0])
    v, a = 2.0 * 0.5 * direction, 2.0 * direction
    assert length(a) / length(v) ** 2 == pytest.approx(2.0)
    assert length(np.cross(v, a)) / length(v) ** 3 == pytest.approx(0.0, abs=ROUNDING)


def test_3_17_is_the_whole_acceleration_not_the_tangential_one():
    for t in TIMES:
        v, a = velocity(t), acceleration(t)
        tangential = RADIUS * 1.4  # d(speed)/dt of this motion
        assert differ(length(a), tangential)
        assert v @ a / length(v) == pytest.approx(tangential, abs=ROUNDING)
