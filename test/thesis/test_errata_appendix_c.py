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

"""Appendix C as printed and as corrected: the seventh order, against a solved linear system."""

from helpers.comparison import differ
import numpy as np
from numpy.polynomial import Polynomial
import pytest

# Solutions of an 8 x 8 system whose condition is below 1e4.
SOLVED = 1e-10
CASES = [(*np.random.default_rng(seed).normal(0.0, 1.0, 4), 0.5 + 0.3 * seed)
         for seed in range(1, 6)]  # A, B, C, D, T


def solved(ends, T):
    """Return the polynomial of degree 7 with given values and derivatives at -T and T."""
    rows, values = [], []
    for order, pair in enumerate(ends):
        for t, value in zip((-T, T), pair):
            rows.append([Polynomial.basis(n).deriv(order)(t) if order else t ** n
                         for n in range(8)])
            values.append(value)
    return np.linalg.solve(rows, values)


def printed(A, B, C, D, T, last_power=5):
    """Return a0 to a7 of C.2 to C.9."""
    even, odd = C - D, A - B + (C + D) * T
    return np.array([
        (16 * (A + B) + 11 * even * T) / 32, -(35 * (A - B) + 19 * (C + D) * T) / (32 * T),
        -15 * even / (32 * T), 35 * odd / (32 * T ** 3), 5 * even / (32 * T ** 3),
        -21 * odd / (32 * T ** 5), -even / (32 * T ** 5), 5 * odd / (32 * T ** last_power)])


@pytest.mark.parametrize('case', CASES)
def test_c_2_to_c_8_hold(case):
    A, B, C, D, T = case
    true = solved(((A, B), (C, D), (0.0, 0.0), (0.0, 0.0)), T)
    assert printed(*case)[:7] == pytest.approx(true[:7], abs=SOLVED)


@pytest.mark.parametrize('case', CASES)
def test_c_9_needs_the_seventh_power_of_t(case):
    A, B, C, D, T = case
    true = solved(((A, B), (C, D), (0.0, 0.0), (0.0, 0.0)), T)[7]
    assert differ(printed(*case)[7], true)
    assert printed(*case, last_power=7)[7] == pytest.approx(true, abs=SOLVED)


@pytest.mark.parametrize('case', CASES)
def test_appendix_c_s_conditions_exchange_b_and_c(case):
    # Figure C.1 and the coefficients: A, B positions, C, D velocities. The list of conditions
    # has A, C for positions, B, D for velocities.
    A, B, C, D, T = case
    ours = printed(*case, last_power=7)
    assert ours == pytest.approx(
        solved(((A, B), (C, D), (0.0, 0.0), (0.0, 0.0)), T), abs=SOLVED)
    assert differ(ours, solved(((A, C), (B, D), (0.0, 0.0), (0.0, 0.0)), T))


@pytest.mark.parametrize(('v0', 'v1'), [(0.2, 1.0), (1.0, -0.6)])
def test_c_11_takes_the_modulus(v0, v1):
    largest = 1.5
    T = 15.0 * abs(v0 - v1) / (16.0 * largest)
    motion = Polynomial(printed(0.3, 0.3 + T * (v0 + v1), v0, v1, T, last_power=7))
    t = np.linspace(-T, T, 2001)
    assert np.abs(motion.deriv(2)(t)).max() == pytest.approx(largest, abs=SOLVED)
    assert motion.deriv(2)(0.0) == pytest.approx(np.sign(v1 - v0) * largest, abs=SOLVED)
    as_printed = 15.0 * (v0 - v1) / (16.0 * largest)
    assert (as_printed < 0.0) == (v1 > v0)  # no time where the joint speeds up


def test_c_10_leaves_no_cubic_or_higher_odd_term():
    A, _, C, D, T = CASES[0]
    coefficients = printed(A, A + T * (C + D), C, D, T, last_power=7)
    assert coefficients[3::2] == pytest.approx(np.zeros(3), abs=SOLVED)
