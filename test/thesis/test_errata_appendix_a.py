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

"""Appendix A as printed and as corrected: motion with Gauss's function as its acceleration."""

from math import factorial

from helpers.comparison import differ, rate
import numpy as np
from numpy.polynomial import Polynomial
import pytest
from scipy.integrate import quad

MU, SIGMA = 0.42, 0.35
DURATION = 1.6                                # t_j [s]
START, VELOCITY, ACCELERATION = 0.3, -0.4, 0.5  # theta_s and its rates
TERMS = 40
# Alternating sums whose largest terms are about 10.
SUMMATION = 1e-12
T = np.linspace(0.0, 1.0, 11)


def series(s, order, terms=TERMS):
    """Return the sums of A.4, A.3 and A.2: Gauss's function integrated order times."""
    u, total = (s - MU) / SIGMA, 0.0
    for n in range(terms):
        factor = np.prod([2.0 * n + k for k in range(1, order + 1)])
        total = total + (-0.5) ** n / factorial(n) * SIGMA ** order * u ** (2 * n + order) / factor
    return total / (SIGMA * np.sqrt(2.0 * np.pi))


C0 = -series(0.0, 0) + ACCELERATION * DURATION ** 2
C1 = -series(0.0, 1) + VELOCITY * DURATION
C2 = -series(0.0, 2) + START


def position(s):
    """Return A.2 with the corrected constants."""
    return series(s, 2) + 0.5 * C0 * s ** 2 + C1 * s + C2


def scaled_acceleration(s):
    """Return Gauss's function itself, moved to start at the given acceleration; by T twice."""
    gauss = [np.exp(-0.5 * ((x - MU) / SIGMA) ** 2) / (SIGMA * np.sqrt(2.0 * np.pi))
             for x in (s, 0.0)]
    return gauss[0] - gauss[1] + ACCELERATION * DURATION ** 2


# What the motion comes to, by quadrature; position by Cauchy's repeated integral.
END_VELOCITY = VELOCITY + quad(scaled_acceleration, 0.0, 1.0, epsabs=1e-13)[0] / DURATION
END = START + VELOCITY * DURATION + quad(
    lambda s: (1.0 - s) * scaled_acceleration(s), 0.0, 1.0, epsabs=1e-13)[0]
END_ACCELERATION = scaled_acceleration(1.0) / DURATION ** 2


def test_a_1_is_the_acceleration():
    by_series = series(T, 0) + C0
    assert by_series == pytest.approx(scaled_acceleration(T), abs=SUMMATION)
    assert differ(by_series, position(T))  # printed as q(T)


def test_a_2_is_the_motion():
    assert position(0.0) == pytest.approx(START, abs=SUMMATION)
    assert position(1.0) == pytest.approx(END, abs=SUMMATION)


def test_a_3_has_1_over_t_j_before_its_last_term():
    true = rate(position, T) / DURATION
    assert (series(T, 1) + C0 * T + C1) / DURATION == pytest.approx(true, abs=SUMMATION)
    for read_as in (1.0, DURATION):  # a tau that says nothing, or the duration itself
        assert differ(series(T, 1) / DURATION + read_as * (C0 * T + C1), true)


def test_a_4_lacks_1_over_t_j_squared_under_c0():
    def velocity(s):
        return (series(s, 1) + C0 * s + C1) / DURATION

    true = rate(velocity, T) / DURATION
    assert scaled_acceleration(T) / DURATION ** 2 == pytest.approx(true, abs=SUMMATION)
    assert (series(T, 0) + C0) / DURATION ** 2 == pytest.approx(true, abs=SUMMATION)
    assert differ(series(T, 0) / DURATION ** 2 + C0, true)


@pytest.mark.parametrize(('order', 'start', 'end'), [
    (0, ACCELERATION, END_ACCELERATION),
    (1, VELOCITY, END_VELOCITY),
    (2, START, END)])
def test_a_5_to_a_7_take_the_start_s_values(order, start, end):
    # At T = 0 the polynomial's own part is C0, C1 or C2 alone.
    power = DURATION ** (2 - order)
    for value, holds in ((end, False), (start, True)):
        constant = -series(0.0, order) + value * power
        at_start = (series(0.0, order) + constant) / power
        assert differ(at_start, start) is not holds
        assert (abs(at_start - start) < SUMMATION) == holds


def test_a_8_has_wrong_terms():
    grown = series(1.0, 2) - series(0.0, 2)
    corrected = (grown - series(0.0, 1) - 0.5 * series(0.0, 0) + START - END
                 + DURATION * VELOCITY + 0.5 * DURATION ** 2 * ACCELERATION)
    assert corrected == pytest.approx(0.0, abs=SUMMATION)
    sums = grown - series(0.0, 1) - series(0.0, 0)
    start, end = (START, VELOCITY, ACCELERATION), (END, END_VELOCITY, END_ACCELERATION)
    for s, e in ((start, end), (end, start)):      # as printed, and with both letters exchanged
        for divisor in (DURATION ** 2, 1.0):       # as printed, and without
            for acceleration in (e[2], s[2]):      # as printed, and the other end's
                printed = (sums / divisor + e[0] - s[0] + DURATION * (s[1] - e[1])
                           - DURATION ** 2 * acceleration)
                assert differ(printed, 0.0)


def test_a_9_takes_the_start_s_acceleration():
    sums = (series(1.0, 1) - series(0.0, 1) - series(0.0, 0)) / DURATION
    change = VELOCITY - END_VELOCITY
    assert sums + change + DURATION * ACCELERATION == pytest.approx(0.0, abs=SUMMATION)
    assert differ(sums + change + DURATION * END_ACCELERATION, 0.0)


def test_without_an_amplitude_a_transition_only_speeds_up_and_by_less_than_1_over_t_j():
    # No acceleration at either end: mu = 1/2, and only sigma is left to choose.
    def gained(sigma, amplitude=1.0):
        peak = amplitude / (sigma * np.sqrt(2.0 * np.pi))
        return quad(lambda s: peak * (np.exp(-0.5 * ((s - 0.5) / sigma) ** 2)
                                      - np.exp(-0.125 / sigma ** 2)), 0.0, 1.0, points=[0.5])[0]

    printed = np.array([gained(sigma) for sigma in np.geomspace(0.02, 20.0, 60)])
    assert (printed > 0.0).all()
    assert (printed < 1.0 + SUMMATION).all()
    for wanted in (-2.4, -0.6, 1.8):  # t_j times the change of velocity
        assert np.abs(printed - wanted).min() > 0.5
        amplitude = wanted / gained(0.2)
        assert gained(0.2, amplitude) == pytest.approx(wanted)


def test_nine_terms_make_a_position_of_degree_20():
    acceleration = Polynomial(np.ones(2 * 9 + 1))  # powers of T up to 2 n, n = 9
    assert acceleration.degree() == 18
    assert acceleration.integ(2).degree() == 20
