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

"""The seventh-order transition against appendix C."""

import numpy as np
from numpy.polynomial import Polynomial
import pytest
from rrr_traj_planner.core.motion_laws.septic import SEPTIC

CASES = [(0.3, -0.4, 0.9, 0.7), (-1.0, 0.5, 0.5, 1.3), (0.0, 1.0, -0.2, 0.4)]  # A, C, D, T


def appendix_c(A, C, D, T):
    """Return the polynomial in t of C.1 to C.9 (corrected), with the end position of C.10."""
    B = A + T * (C + D)
    even, odd = C - D, A - B + (C + D) * T
    return Polynomial([
        (16 * (A + B) + 11 * even * T) / 32, -(35 * (A - B) + 19 * (C + D) * T) / (32 * T),
        -15 * even / (32 * T), 35 * odd / (32 * T ** 3), 5 * even / (32 * T ** 3),
        -21 * odd / (32 * T ** 5), -even / (32 * T ** 5), 5 * odd / (32 * T ** 7)])


@pytest.mark.parametrize('case', CASES)
def test_transition_is_appendix_c_s_polynomial_and_its_derivatives(case):
    A, C, D, T = case
    printed, t = appendix_c(*case), np.linspace(-T, T, 41)
    ours = SEPTIC.transition(2.0 * T, A, C, D).at((t + T) / (2.0 * T))
    for order, values in enumerate(ours):
        expected = printed.deriv(order)(t) if order else printed(t)
        assert values == pytest.approx(expected, abs=1e-11)


def test_transition_at_full_acceleration_lasts_1_875_times_change_over_peak():
    # C.11: T = 15 |C - D| / (16 alpha), and the transition lasts 2 T.
    T = 15.0 * 1.2 / (16.0 * 2.0)
    assert SEPTIC.peak_acceleration * 1.2 / 2.0 == 2.0 * T
    piece = SEPTIC.transition(2.0 * T, 0.0, 0.0, 1.2)
    assert piece.at(0.5)[2] == pytest.approx(2.0)


def test_jerk_is_zero_at_the_ends_and_largest_at_t_over_root_3():
    # d/dx (1 - x^2)^2 = -4 x (1 - x^2), largest at x = 1 / sqrt(3).
    assert SEPTIC.jerk(np.array([0.0, 0.5, 1.0])).tolist() == [0.0, 0.0, 0.0]
    at = 0.5 * (1.0 - 1.0 / np.sqrt(3.0))
    assert SEPTIC.jerk(at) == pytest.approx(SEPTIC.peak_jerk, rel=1e-14)
    assert SEPTIC.peak_jerk == pytest.approx(10.0 / 3.0 ** 0.5)
