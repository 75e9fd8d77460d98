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

"""Gauss's function as an acceleration: closed form, Maclaurin series, its error, refusals."""

from math import exp, factorial
import re

from helpers.places import DOCS
import numpy as np
import pytest
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.motion_laws.gauss import (
    GAUSS,
    gauss,
    HALF_WIDTH,
    maclaurin,
    maclaurin_error,
)
from rrr_traj_planner.core.motion_laws.quartic import QUARTIC
from scipy.integrate import quad

S = np.linspace(0.0, 1.0, 41)
THOUSANDTH = 1e-3  # of the peak: what order 9 keeps and order 8 does not
DOCUMENT = DOCS / 'transition_functions.md'


@pytest.mark.parametrize('k', [0.8, 2.0, 3.0])
def test_acceleration_is_a_gauss_function_less_its_value_at_the_ends(k):
    # 3.1 with mu = 1/2 and sigma = 1/(2 k): the ends are k sigma from the middle.
    def lowered(s):
        return exp(-0.5 * ((s - 0.5) * 2.0 * k) ** 2) - exp(-0.5 * k ** 2)

    area = quad(lowered, 0.0, 1.0, epsabs=1e-13)[0]
    shape = gauss(k)
    assert [shape.acceleration(s) for s in S] == pytest.approx(
        [lowered(s) / area for s in S], abs=1e-11)
    assert shape.peak_acceleration == pytest.approx(lowered(0.5) / area, abs=1e-11)
    # The steepest place of a Gauss function is one sigma from its middle.
    at = min(1.0, k)
    assert shape.peak_jerk == pytest.approx(2.0 * k * at * exp(-0.5 * at ** 2) / area, abs=1e-10)


def test_order_9_is_needed_as_appendix_a_says_and_enough():
    assert maclaurin_error(9) < THOUSANDTH
    assert all(maclaurin_error(order) > THOUSANDTH for order in range(9))
    # By hand: at two sigma x = 2, and the rest of the alternating series is less than its first
    # term, 2^10 / 10!, by at most the second's part, 2 / 11.
    first = 2.0 ** 10 / factorial(10)
    assert first * (1.0 - 2.0 / 11.0) < maclaurin_error(9) < first


@pytest.mark.parametrize('order', [0, 1, 4, 9, 15])
def test_series_is_3_3_from_n_0(order):
    u = np.linspace(-2.5, 2.5, 11)
    printed = sum((-0.5) ** n / factorial(n) * u ** (2 * n) for n in range(order + 1))
    assert maclaurin(u, order) == pytest.approx(printed, abs=1e-12)


@pytest.mark.parametrize('order', [3, 8, 9, 12])
def test_error_of_the_series_is_largest_at_the_ends(order):
    u = np.linspace(-HALF_WIDTH, HALF_WIDTH, 801)
    errors = np.abs(maclaurin(u, order) - np.exp(-0.5 * u ** 2))
    assert errors.max() == pytest.approx(maclaurin_error(order), rel=1e-9)
    assert int(errors.argmax()) in (0, 800)


def test_transition_of_order_9_is_a_2_to_a_4_scaled_to_its_change_of_velocity():
    mu, sigma, terms = 0.5, 0.25, range(10)

    def series(s, order):
        total = 0.0
        for n in terms:
            factor = np.prod([2.0 * n + k for k in range(1, order + 1)])
            u = (s - mu) / sigma
            total = total + (-0.5) ** n / factorial(n) * sigma ** order * u ** (
                2 * n + order) / factor
        return total / (sigma * np.sqrt(2.0 * np.pi))

    # A.2 to A.4 without acceleration, velocity and position at the start; corrected constants.
    C0, C1, C2 = (-series(0.0, order) for order in range(3))
    curves = (series(S, 0) + C0, series(S, 1) + C0 * S + C1,
              series(S, 2) + 0.5 * C0 * S ** 2 + C1 * S + C2)
    shape, change = gauss(order=9), curves[1][-1]
    for ours, printed in zip((shape.acceleration, shape.velocity, shape.position), curves):
        assert ours(S) == pytest.approx(printed / change, abs=1e-12)


def test_transition_of_order_9_is_the_closed_form_to_a_thousandth_and_of_order_7_is_not():
    def apart(order):
        other = gauss(order=order)
        return np.abs(other.acceleration(S) - GAUSS.acceleration(S)).max()

    assert apart(9) < THOUSANDTH * GAUSS.peak_acceleration
    assert apart(7) > THOUSANDTH * GAUSS.peak_acceleration


def test_series_of_order_1_is_paul_s_function():
    # 1 - u^2 / 2, lowered, is a parabola: h (1 - h).
    for ours, paul in zip(gauss(order=1), QUARTIC):
        if callable(ours):
            assert ours(S) == pytest.approx(paul(S), abs=1e-13)


@pytest.mark.parametrize(('arguments', 'message'), [
    ((-1.0,), r'^half_width is -1\.0 sigma, must be positive$'),
    ((np.inf,), r'^half_width is inf sigma, must be finite$'),
    ((1e308,), r'^half_width is 1e\+308 sigma, must be in \[0\.1, 100\.0\] sigma$'),
    ((5e-324,), r'^half_width is 5e-324 sigma, must be in \[0\.1, 100\.0\] sigma$'),
    ((5e-324, 9), r'^half_width is 5e-324 sigma, must be in '),
    ((2.0, 10 ** 11), r'^order is 100000000000, must be at most 100$'),
    ((2.0, -1), '^order is -1, must be at least 0$'),
    ((2.0, 0), r'^order 0 of the series does not fall up to 2\.0 sigma$'),
    ((3.0, 4), r'^order 4 of the series does not fall up to 3\.0 sigma$')])
def test_impossible_shapes_are_refused(arguments, message):
    with pytest.raises(InvalidInputError, match=message):
        gauss(*arguments)


def test_document_s_figures_of_half_widths_and_orders_are_right():
    rows = re.findall(r'^\| ([\d.]+) σ \| ([\d.]+) \| ([\d.]+) \| ([\d.]+) % \| (\d+) \|$',
                      DOCUMENT.read_text(), re.MULTILINE)
    assert len(rows) >= 4
    for k, peak, jerk, step, needed in rows:
        shape = gauss(float(k))
        assert float(peak) == pytest.approx(shape.peak_acceleration, abs=5.1e-4)
        assert float(jerk) == pytest.approx(shape.peak_jerk, abs=5.1e-3)
        assert float(step) == pytest.approx(
            100.0 * shape.jerk(0.0) / shape.peak_jerk, abs=0.051)
        errors = [maclaurin_error(n, float(k)) < THOUSANDTH for n in range(40)]
        assert int(needed) == errors.index(True)
    orders = re.findall(r'^\| (\d+) \| ([\d.]+e-\d+) \|$', DOCUMENT.read_text(), re.MULTILINE)
    assert {int(n) for n, _ in orders} >= {8, 9, 10}
    for n, error in orders:
        assert float(error) == pytest.approx(maclaurin_error(int(n)), rel=0.05)


@pytest.mark.parametrize('u', [1e308, [0.0, -1e200], np.inf, np.nan])
def test_series_that_no_float_holds_is_refused(u):
    with pytest.raises(InvalidInputError, match='^u is .*, must be finite and small enough for a'):
        maclaurin(u, 9)


@pytest.mark.parametrize('half_width', [1e308, 5e-324, 1e154])
def test_error_of_a_series_over_a_width_that_no_float_holds_is_refused(half_width):
    with pytest.raises(InvalidInputError, match='^half_width is .* sigma, must be in '):
        maclaurin_error(9, half_width)
