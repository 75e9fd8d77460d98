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

"""One segment of the thesis's approach (a): a transition, then a cruise into the next segment."""

from __future__ import annotations

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.planners.transitions.largest_displacement import largest_displacement
from rrr_traj_planner.planners.transitions.transition_law import SegmentLimits, TransitionLaw


def cruise_velocity(limits: SegmentLimits, v0: Array, T: Array, D: Array) -> Array:
    """
    Return the cruise velocity that covers a displacement after a shortest transition.

    With t(u) the least duration of a change u, the displacement v T - (v - v0) t(v - v0) / 2 rises
    with the cruise velocity v: at most one v fits.

    Parameters
    ----------
    limits : SegmentLimits
        Transitions' least durations and the largest velocity.
    v0 : ndarray, shape (..., 3)
        Velocities at the start [rad/s].
    T : ndarray, shape (..., 1)
        Durations [s].
    D : ndarray, shape (..., 3)
        Displacements [rad].

    Returns
    -------
    ndarray, shape (..., 3)
        [rad/s], NaN where none fits.

    """
    ahead = D - v0 * T  # displacement beyond that at the start's velocity
    change = _change(limits.law, np.abs(ahead), T)
    v = v0 + np.sign(ahead) * change
    with np.errstate(invalid='ignore'):
        return np.where(np.abs(v) <= limits.max_velocity, v, np.nan)


def _change(law: TransitionLaw, ahead: Array, T: Array) -> Array:
    """Return u >= 0 with u T - u t(u) / 2 = ahead and t(u) <= T, NaN where there is none."""
    with np.errstate(invalid='ignore', divide='ignore'):
        u = 2.0 * ahead / (T + np.sqrt(T ** 2 - 2.0 * law.slope * ahead))
        jerk_limited = law.root * np.sqrt(u) > law.slope * u
        if jerk_limited.any():  # concave and increasing: Newton from below stays below the root
            x = ahead / T
            for _ in range(12):  # convergence is quadratic
                t = law.root * np.sqrt(x)
                x = x + np.maximum(ahead - x * T + 0.5 * x * t, 0.0) / (T - 0.75 * t)
            # Rounding is up to some 1e-15 of the displacement; a root that was missed leaves more
            # than this part of it. Chosen.
            fits = np.abs(x * T - 0.5 * x * law.least_time(x) - ahead) <= 1e-11 * ahead
            u = np.where(jerk_limited | np.isnan(u), np.where(fits, x, np.nan), u)
        u = np.where(ahead > 0.0, u, 0.0)
        return np.where(law.least_time(u) <= T, u, np.nan)


def can_stop(limits: SegmentLimits, v0: Array, T: Array, D: Array) -> Array:
    """
    Return whether transition, cruise, transition to rest can cover a displacement.

    Parameters
    ----------
    limits, v0, T, D
        As in `cruise_velocity`.

    Returns
    -------
    ndarray of bool, shape (...)
        Whether all three joints can.

    """
    rest = np.zeros_like(v0)
    forth = largest_displacement(limits, v0, rest, T)
    back = -largest_displacement(limits, -v0, rest, T)
    fits = (limits.law.least_time(v0) <= T) & (back <= D) & (D <= forth)
    return np.asarray(fits.all(axis=-1))


def stopping_time(limits: SegmentLimits, v0: Array, D: Array, grid: Array) -> Array:
    """
    Return the least duration of a last segment, to rest.

    Parameters
    ----------
    limits : SegmentLimits
        As in `cruise_velocity`.
    v0 : ndarray, shape (n, 3)
        Velocities at the start [rad/s].
    D : ndarray, shape (3,)
        Displacement [rad].
    grid : ndarray
        Increasing durations to try [s]; the result is refined between them by bisection.

    Returns
    -------
    ndarray, shape (n,)
        [s], infinite where no duration of the grid is feasible.

    """
    return bisected(limits, v0, D, *stopping_bracket(limits, v0, D, grid))


def stopping_bracket(limits: SegmentLimits, v0: Array, D: Array,
                     grid: Array) -> tuple[Array, Array]:
    """
    Return two durations of a last segment that ends at rest: one too short, the other feasible.

    Parameters
    ----------
    limits, v0, D, grid
        As in `stopping_time`.

    Returns
    -------
    tuple of ndarray, shape (n,)
        [s], infinite where no duration of the grid is feasible.

    """
    fits = can_stop(limits, v0[:, np.newaxis], grid[:, np.newaxis], D)
    first = fits.argmax(axis=1)
    low = np.where(first > 0, grid[np.maximum(first - 1, 0)], 0.5 * grid[0])
    found = fits[np.arange(len(v0)), first]
    return np.where(found, low, np.inf), np.where(found, grid[first], np.inf)


def bisected(limits: SegmentLimits, v0: Array, D: Array, low: Array, high: Array) -> Array:
    """
    Return the least durations of a last segment within brackets, by bisection.

    Parameters
    ----------
    limits, v0, D
        As in `stopping_time`.
    low, high : ndarray, shape (n,)
        As of `stopping_bracket` [s].

    Returns
    -------
    ndarray, shape (n,)
        [s], infinite where the bracket is.

    """
    found = np.isfinite(high)
    v0, low, least = v0[found], low[found], high.copy()
    for _ in range(26):  # to 1.5e-8 of the bracket
        middle = 0.5 * (low + least[found])
        fits = can_stop(limits, v0, middle[:, np.newaxis], D)
        low, least[found] = np.where(fits, low, middle), np.where(fits, middle, least[found])
    return least
