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

"""Bernstein's form of polynomials, against their extremes at the roots of the derivative."""

import numpy as np
from numpy.polynomial import Polynomial
from rrr_traj_planner.core.trajectory.bernstein import bernstein_forms, halved, leaves

SEED, COUNT = 7, 300


def quintics():
    """Return coefficients (COUNT, 6) of quintics of all sizes, and widths of their intervals."""
    rng = np.random.default_rng(SEED)
    widths = 10.0 ** rng.uniform(-3.0, 3.0, COUNT)
    return rng.normal(size=(COUNT, 6)) / widths[:, np.newaxis] ** np.arange(6), widths


def extremes(c, width):
    """Return the least and the largest value on an interval from 0."""
    p = Polynomial(c)
    inner = [x.real for x in p.deriv().roots() if abs(x.imag) < 1e-9 * width]
    values = p(np.clip([0.0, width, *inner], 0.0, width))
    return values.min(), values.max()


def forms(c, widths):
    return [f[:, 0] for f in bernstein_forms(np.tile(c[:, np.newaxis], (1, 3, 1)), widths)]


def test_a_polynomial_leaves_bounds_that_its_extremes_are_beyond():
    c, widths = quintics()
    derivatives = c
    for form in forms(c, widths):
        low, high = np.array([extremes(*pair) for pair in zip(derivatives, widths)]).T
        for margin in 1e-7 * (high - low), 0.1 * (high - low):
            assert not leaves(form, low - margin, high + margin).any()
            assert leaves(form, low + margin, high + margin).all()
            assert leaves(form, low - margin, high - margin).all()
        derivatives = derivatives[:, 1:] * np.arange(1, derivatives.shape[1])


def test_halves_are_the_same_polynomial():
    c, widths = quintics()
    whole, half = forms(c, widths)[0], halved(forms(c, widths)[0])
    middle = np.array([Polynomial(p)(0.5 * w) for p, w in zip(c, widths)])
    np.testing.assert_allclose(half[:COUNT, -1], middle, atol=1e-12)
    np.testing.assert_allclose(half[COUNT:, 0], middle, atol=1e-12)
    np.testing.assert_array_equal(half[:COUNT, 0], whole[:, 0])
    np.testing.assert_array_equal(half[COUNT:, -1], whole[:, -1])
