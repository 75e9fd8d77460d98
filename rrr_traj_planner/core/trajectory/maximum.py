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
Maxima over time of piecewise smooth quantities: sampling, then successive parabolic interpolation.

The interpolation within a bracket is that of Brent, Algorithms for Minimization without
Derivatives, 1973, chapter 5, here for many brackets at once and with several points a round.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array, IntArray

# Sampling around the vertex of the parabola through three points, at these fractions of the
# distance to the outer two: a bracket narrows to a 64th where the parabola fits well, at worst to
# a half. The error of a smooth peak's value is of the order of the square. Chosen.
ZOOM_ROUNDS = 12
OFFSETS = np.array([-32.0, -8.0, -1.0, 0.0, 1.0, 8.0, 32.0]) / 64.0
# A local maximum is refined if it might exceed the highest value found by more than NEGLIGIBLE
# (relative). Bounds on the rise between samples, in second differences: an eighth for a smooth
# quantity on an equal grid, a half with corners (RISE), seven quarters with neighbouring steps of
# ratio seven (ZOOMED_RISE, rounded up).
RISE, ZOOMED_RISE, NEGLIGIBLE = 0.5, 2.0, 1e-8
# Points no further apart are the two sides of a knot: ten times ONE_SIDED. Chosen.
SAME_TIME = 1e-8  # s


class Extreme(NamedTuple):
    """The largest value of a quantity over a motion, for each joint."""

    value: Array  # shape (3,)
    time: Array   # when [s], shape (3,)


def maximum_over_time(quantity: Callable[[Array], Array], grid: Array,
                      values: Array | None = None) -> Extreme:
    """
    Return the maxima of a piecewise smooth quantity, refined between the points of a grid.

    Parameters
    ----------
    quantity : callable
        Values of shape (n, K) at times of shape (n,).
    grid : ndarray
        Increasing times [s], dense enough to resolve each high local maximum.
    values : ndarray, shape (n, K), optional
        The quantity at the grid, where it is known.

    Returns
    -------
    Extreme
        For each column.

    """
    values = quantity(grid) if values is None else values
    best = values.argmax(axis=0)
    value, time = values[best, np.arange(len(best))], grid[best]
    t, f, column = _brackets(values, grid)
    at_end = np.zeros(len(column), bool)
    for _ in range(ZOOM_ROUNDS if np.isfinite(value).all() else 0):
        if not len(column):
            break
        inner = _around_vertices(t, f)
        at = quantity(inner.ravel()).reshape(*inner.shape, -1)
        own = np.take_along_axis(at, column[:, np.newaxis, np.newaxis], axis=2)[..., 0]
        t = np.concatenate((t[:, :1], inner, t[:, 2:]), axis=1)
        f = np.concatenate((f[:, :1], own, f[:, 2:]), axis=1)
        rows, top = np.arange(len(t)), f.argmax(axis=1)
        highest = f[rows, top]
        rising = np.argsort(highest)  # the last of a column is its highest
        rising = rising[highest[rising] > value[column[rising]]]
        value[column[rising]], time[column[rising]] = highest[rising], t[rising, top[rising]]
        beside = np.clip(top[:, np.newaxis] + (-1, 0, 1), 0, t.shape[1] - 1)
        t, f = t[rows[:, np.newaxis], beside], f[rows[:, np.newaxis], beside]
        fall = 2.0 * highest - f[:, 0] - f[:, 2]
        promising = highest + ZOOMED_RISE * fall > value[column] * (1.0 + NEGLIGIBLE)
        was, at_end = at_end, (t[:, 1] == t[:, 0]) | (t[:, 1] == t[:, 2])
        promising &= ~(was & at_end)  # at the bracket's end in two rounds: the maximum is there
        t, f, column, at_end = t[promising], f[promising], column[promising], at_end[promising]
    return Extreme(value, time)


def _brackets(values: Array, grid: Array) -> tuple[Array, Array, IntArray]:
    """Return brackets of local maxima that may contain a column's maximum: t, f, column."""
    local = values > 0.0
    local[1:] &= values[1:] >= values[:-1]
    local[:-1] &= values[:-1] >= values[1:]
    with np.errstate(invalid='ignore'):
        local &= (values + RISE * _second_differences(values)
                  > values.max(axis=0) * (1.0 + NEGLIGIBLE))
    column, row = np.nonzero(local.T)
    apart = np.diff(grid, prepend=grid[0], append=grid[-1]) > SAME_TIME
    beside = np.stack((row - apart[row], row, row + apart[row + 1]), axis=1)
    return grid[beside], values[beside, column[:, np.newaxis]], column


def _around_vertices(t: Array, f: Array) -> Array:
    """Return times around the vertices of parabolas through three points, (k, len(OFFSETS))."""
    before, after = t[:, 1] - t[:, 0], t[:, 2] - t[:, 1]
    rise, fall = f[:, 1] - f[:, 0], f[:, 1] - f[:, 2]
    with np.errstate(divide='ignore', invalid='ignore'):
        shift = 0.5 * (rise * after ** 2 - fall * before ** 2) / (rise * after + fall * before)
    top = np.clip(t[:, 1] + np.where(np.isfinite(shift), shift, 0.0), t[:, 0], t[:, 2])
    reach = np.maximum(top - t[:, 0], t[:, 2] - top)
    return np.clip(top[:, np.newaxis] + reach[:, np.newaxis] * OFFSETS, t[:, :1], t[:, 2:])


def _second_differences(values: Array) -> Array:
    """Return the largest second difference at or next to each point."""
    if len(values) < 3:
        return np.full(values.shape, np.inf)
    second = np.pad(np.abs(np.diff(values, 2, axis=0)), ((2, 2), (0, 0)), mode='edge')
    return np.asarray(np.max([second[k:k + len(values)] for k in range(3)], axis=0))
