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

"""The polynomial zone's shape: arc length, least curvature of its family, gentle rise."""

import numpy as np
from numpy.polynomial import Polynomial
import pytest
from rrr_traj_planner.core.path.polynomial_zone import ALPHA, BETA, PolynomialZones
from scipy.integrate import quad

ANGLES = np.radians([0.01, 1.0, 10.0, 30.0, 45.0, 60.0, 75.0, 85.0, 89.0, 89.9])


def bernstein(points, angle):
    """Return x and y of the quintic with control points at distances along the two lines."""
    tau = Polynomial([0.5, 0.5])
    basis = [c * tau ** i * (1.0 - tau) ** (5 - i) for i, c in enumerate((1, 5, 10, 10, 5, 1))]
    d = [*points, *points[::-1]]
    x = sum(b * v * np.cos(angle) * s for b, v, s in zip(basis, d, (-1, -1, -1, 1, 1, 1)))
    y = sum(b * v * np.sin(angle) for b, v in zip(basis, d))
    return x, y


def family_at(shapes, angle, u):
    """Return points and two derivatives of zones with these control points, each (2, n, u)."""
    units = [bernstein(unit, angle) for unit in np.eye(3)]  # a zone is linear in its shape
    return (np.array([shapes @ [zone[axis].deriv(order)(u) for zone in units] for axis in (0, 1)])
            for order in range(3))


@pytest.mark.parametrize('angle', [0.0, 1e-300, 1e-15, 1e-9])
def test_zone_of_no_turn_is_a_line_of_no_length(angle):
    zones = PolynomialZones([angle])
    assert 0.0 < zones.after[0] < 1e-8
    r = zones.at(np.zeros(11, dtype=int), np.linspace(-zones.after[0], zones.after[0], 11))
    assert np.isfinite(r).all()
    assert np.abs(r[0]).max() < 1e-8
    assert r[1] == pytest.approx(np.tile([[1.0], [0.0]], (1, 11)), abs=1e-8)


@pytest.mark.parametrize('angle', ANGLES)
def test_zone_turns_by_its_angle_and_curvature_falls_from_one_at_the_middle_to_zero(angle):
    zones = PolynomialZones([angle])
    sigma = np.linspace(-zones.after[0], zones.after[0], 2001)
    r = zones.at(np.zeros(2001, dtype=int), sigma)
    bend = r[1, 0] * r[2, 1] - r[1, 1] * r[2, 0]
    assert r[1, :, -1] == pytest.approx([np.cos(angle), np.sin(angle)], abs=1e-12)
    assert r[:, :, 1000].ravel() == pytest.approx(
        [0, 0, 1, 0, 0, 1, r[3, 0, 1000], 0], abs=1e-9)
    assert bend[[0, -1]] == pytest.approx([0.0, 0.0], abs=1e-9)
    assert bend.max() <= 1.0 + 1e-9
    assert bend.min() >= -1e-9
    assert zones.ends(np.array([angle]))[0] == pytest.approx(r[0, 0, -1:], rel=1e-12)
    assert zones.ends(np.array([angle]))[1] == pytest.approx(r[0, 1, -1:], rel=1e-10)


@pytest.mark.parametrize('angle', ANGLES)
def test_length_between_points_is_the_integral_of_the_curve(angle):
    zones = PolynomialZones([angle])
    sigma = np.linspace(0.0, zones.after[0], 400)
    xy = zones.at(np.zeros(400, dtype=int), sigma)
    # Turning: the integral of curvature by length is the angle.
    bend = xy[1, 0] * xy[2, 1] - xy[1, 1] * xy[2, 0]
    turned = np.trapezoid(bend, sigma)
    assert turned == pytest.approx(angle, rel=1e-4)
    chords = np.hypot(*np.diff(xy[0], axis=1)).sum()
    assert chords == pytest.approx(zones.after[0], rel=1e-5)
    assert chords <= zones.after[0]


@pytest.mark.parametrize('angle', ANGLES)
def test_lengths_stand_to_ten_digits_against_adaptive_quadrature_of_the_points(angle):
    zones = PolynomialZones([angle])

    c = np.cos(angle)
    alpha, beta = (1.0 - c * np.polynomial.polynomial.polyval(c, f) for f in (ALPHA, BETA))
    leg = zones.ends(np.array([angle]))[0][0] / c
    x, y = bernstein((leg, alpha * leg, beta * leg), angle)
    u = np.array([0.1, 0.5, 0.9, 1.0])
    sigma = [quad(lambda v: np.hypot(x.deriv()(v), y.deriv()(v)), 0.0, end, epsabs=1e-14,
                  epsrel=1e-13)[0] for end in u]
    at = zones.at(np.zeros(4, dtype=int), np.minimum(sigma, zones.after[0]))[0]
    assert at == pytest.approx(np.array([x(u), y(u) - y(0.0)]), abs=1e-11)
    assert zones.after[0] == pytest.approx(sigma[-1], rel=1e-11)


@pytest.mark.parametrize('angle_deg', [1.0, 20.0, 45.0, 70.0, 80.0])
def test_no_zone_of_the_family_has_three_per_cent_less_peak_curvature(angle_deg):
    angle = np.radians(angle_deg)
    X, Y = PolynomialZones.ends(np.array([angle]))
    own = X[0] / np.cos(angle)  # peak curvature 1: the end's distance from the corner
    u = np.linspace(0.0, 0.9995, 200)
    alpha, beta = (x.ravel() for x in np.meshgrid(
        np.linspace(0.55, 0.95, 41), np.linspace(0.2, 0.8, 31)))
    shapes = np.stack((np.ones(alpha.size), alpha, beta), axis=1)[beta < alpha]
    xy, (dx, dy), (ddx, ddy) = family_at(shapes, angle, u)
    k = (dx * ddy - dy * ddx) / np.hypot(dx, dy) ** 3
    chords, peak = np.hypot(*np.diff(xy, axis=-1)), k.max(axis=1)
    # Steepest change of curvature, times half the zone's length over the peak.
    rise = np.abs(np.diff(k) / chords).max(axis=1) * chords.sum(axis=1) / peak
    best = peak[(k.min(axis=1) >= -1e-3 * peak) & (rise <= 4.0)].min()
    # The grid's best is never better than the family's: its step costs about a per cent.
    assert own <= 1.03 * best
    assert own >= 0.9 * best
