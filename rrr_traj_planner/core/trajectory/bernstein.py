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

"""
Polynomials on intervals in Bernstein form, whose coefficients bound them on both sides.

Farin, Curves and Surfaces for CAGD, chapter 4.
"""

from __future__ import annotations

from math import comb

import numpy as np
from rrr_traj_planner.core.arrays import Array, BoolArray

# From coefficients of 1, s, ..., s^5 to Bernstein's on [0, 1]: C(i, k) / C(5, k).
QUINTIC = np.array([[comb(i, k) / comb(5, k) for i in range(6)] for k in range(6)])


def bernstein_forms(coefficients: Array, widths: Array) -> tuple[Array, Array, Array]:
    """
    Return the Bernstein coefficients of quintics and of their first two derivatives.

    A polynomial lies within the convex hull of its Bernstein coefficients, the first and the last
    of which are its values at the ends.

    Parameters
    ----------
    coefficients : ndarray, shape (n, 3, 6)
        For each interval and joint, of 1, x, ..., x^5 with x the time since its beginning [s].
    widths : ndarray, shape (n,)
        Durations of the intervals [s].

    Returns
    -------
    tuple of ndarray, shapes (n, 3, 6), (n, 3, 5), (n, 3, 4)
        Of position [rad], velocity [rad/s] and acceleration [rad/s^2].

    """
    T = widths[:, np.newaxis, np.newaxis]
    q = (coefficients * T ** np.arange(6.0)) @ QUINTIC
    qd = 5.0 * np.diff(q) / T
    return q, qd, 4.0 * np.diff(qd) / T


def through_samples(samples: Array) -> Array:
    """
    Return the Bernstein coefficients of the polynomial through equally spaced samples.

    Parameters
    ----------
    samples : ndarray, shape (m + 1, ...)
        From the beginning to the end of an interval.

    Returns
    -------
    ndarray, shape (m + 1, ...)
        Of degree m.

    """
    m = len(samples) - 1
    s = np.linspace(0.0, 1.0, m + 1)[:, np.newaxis]
    k = np.arange(m + 1)
    basis = np.array([comb(m, i) for i in k]) * s ** k * (1.0 - s) ** (m - k)
    return np.tensordot(np.linalg.inv(basis), samples, axes=1)


def halved(form: Array) -> Array:
    """
    Return the Bernstein coefficients of polynomials on both halves of the interval (de Casteljau).

    Parameters
    ----------
    form : ndarray, shape (n, m + 1)
        On the whole interval.

    Returns
    -------
    ndarray, shape (2 n, m + 1)
        On all first halves, then on all second halves.

    """
    left, right = [form[:, 0]], [form[:, -1]]
    while form.shape[1] > 1:
        form = 0.5 * (form[:, 1:] + form[:, :-1])
        left.append(form[:, 0])
        right.append(form[:, -1])
    return np.concatenate((np.stack(left, axis=1), np.stack(right[::-1], axis=1)))


def leaves(form: Array, low: Array, high: Array) -> BoolArray:
    """
    Return which polynomials leave their bounds on [0, 1].

    Parameters
    ----------
    form : ndarray, shape (..., m + 1)
        Bernstein coefficients.
    low, high : ndarray, shape (...)
        The bounds.

    Returns
    -------
    ndarray of bool, shape (...)
        Exact but for polynomials that touch a bound from outside by less than rounding.

    """
    low, high = (np.broadcast_to(x, form.shape[:-1]).reshape(-1, 1) for x in (low, high))
    out = np.zeros(len(low), dtype=bool)
    index, parts = np.arange(len(low)), form.reshape(len(low), -1)
    # Bisections, chosen; then a polynomial that touches a bound counts as within it.
    for _ in range(24):
        beyond = (parts < low[index]) | (parts > high[index])
        out[index[beyond[:, 0] | beyond[:, -1]]] = True
        doubtful = beyond.any(axis=1) & ~out[index]
        if not doubtful.any():
            break
        parts, index = halved(parts[doubtful]), np.tile(index[doubtful], 2)
    return out.reshape(form.shape[:-1])
