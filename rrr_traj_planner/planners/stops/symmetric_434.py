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
The symmetric 4-3-4 law of least time, by limits on velocity, acceleration and jerk.

In Lin's 4-3-4 (thesis 2.2.2) the times and positions of the joins are free. Here lift-off and
set-down are symmetric: each lasts the same part p of the duration and covers the same
displacement. For equal parts symmetry costs no time: the mean of a law and its reverse is a 4-3-4
law of the same p, and its peaks are not larger. Laws with unequal parts save at most 1 % of the
time as long as lift-off only accelerates and set-down only decelerates (figure 4.1); otherwise a
"set-down" that accelerates first would save up to 9 %.

Two parameters remain: p, and b = p k1, with k1 the coefficient of x (1 - x) in the lift-off's
acceleration (`lin_434`), 0 <= b <= m with m = 6 / (1 - p). The peaks, for unit displacement and
duration, are

    velocity      3 / (2 (1 - p)) - b / 12                           half-way
    acceleration  (m p + b (1 - p))^2 / (4 b p), or m - b            in lift-off, or at its end
    jerk          (m + b (1 / p - 1)) / p and (m - b) / (1/2 - p)    at the start, in the cruise

- jerk alone: p = 1/4, b = 0, jerk of 32 displacement / duration^3, constant in three parts (the
  lift-off is then a cubic): the least of any motion from rest to rest;
- acceleration alone: 6 displacement / duration^2 for every p, with b = m p / (1 - p); p = 1/3 is
  chosen, or the nearest p that other limits allow;
- velocity alone: b = m, a cruise at constant velocity, and Paul's quartic (6.1) as lift-off.

In general b is found by bisection: the peak velocity and the cruise's jerk decrease with b, the
jerk at the start increases, the peak acceleration decreases, then increases. p is found by
narrowing a grid.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.motion_laws.lin_434 import Lin434
from rrr_traj_planner.planners.transitions.via_problem import ViaProblem

# Chosen values, without unit; parts are of the duration. Half and twice as fine a GRID change none
# of 10 random plans.
LEAST_PART, MOST_PART = 1e-7, 0.49  # of lift-off: the cruise has a positive duration
# Penalty, as a part of the time, on the squared logarithm of three times the part: of parts of
# equal time, that nearest to a third is preferred.
PREFERENCE = 1e-8
GRID = np.linspace(0.0, 1.0, 33)  # of the logarithm of p, in each round


class DisplacementRatios(NamedTuple):
    """
    The largest ratio of displacement to limit among the joints, fields of shape (n,).

    A law with peaks V, A and J for unit displacement and duration lasts at least V velocity,
    sqrt(A acceleration) and cbrt(J jerk).
    """

    velocity: Array      # [s]
    acceleration: Array  # [s^2]
    jerk: Array          # [s^3]


def displacement_ratios(problem: ViaProblem) -> DisplacementRatios:
    """
    Return the ratios of each segment's displacements to the limits.

    Parameters
    ----------
    problem : ViaProblem
        Displacements and limits.

    Returns
    -------
    DisplacementRatios
        0 where nothing moves.

    """
    D, law, function = np.abs(problem.displacements), problem.law, problem.function
    return DisplacementRatios((D / problem.max_velocity).max(axis=1),
                              (D * law.slope / function.peak_acceleration).max(axis=1),
                              (D * law.root ** 2 / function.peak_jerk).max(axis=1))


def least_time(law: Lin434, ratios: DisplacementRatios) -> Array:
    """
    Return the least durations of laws.

    Parameters
    ----------
    law : Lin434
        One or more.
    ratios : DisplacementRatios
        Of displacement to limits; broadcasts with the law.

    Returns
    -------
    ndarray
        [s].

    """
    return np.asarray(np.maximum.reduce((
        ratios.velocity * np.abs(law.velocities()).max(axis=0),
        np.sqrt(ratios.acceleration * np.abs(law.accelerations()).max(axis=0)),
        np.cbrt(ratios.jerk * np.abs(law.jerks()).max(axis=0)))))


def fastest_symmetric(ratios: DisplacementRatios) -> Lin434:
    """
    Return the symmetric law of least time of each segment.

    Parameters
    ----------
    ratios : DisplacementRatios
        Of displacement to limits, shape (n,).

    Returns
    -------
    Lin434
        Fields of shape (n,).

    """
    moving = ratios.acceleration > 0.0
    ratios = DisplacementRatios(*(np.where(moving, ratio, 1.0)[:, np.newaxis] for ratio in ratios))
    rows = np.arange(len(moving))
    low, high = (np.full(len(moving), np.log(part)) for part in (LEAST_PART, MOST_PART))
    for _ in range(7):  # each narrows the grid to a sixteenth
        grid = low[:, np.newaxis] + (high - low)[:, np.newaxis] * GRID
        laws = _with_best_b(np.exp(grid), ratios)
        best = (least_time(laws, ratios) * (
            1.0 + PREFERENCE * (grid - np.log(1.0 / 3.0)) ** 2)).argmin(axis=1)
        low = grid[rows, np.maximum(best - 1, 0)]
        high = grid[rows, np.minimum(best + 1, len(GRID) - 1)]
    return Lin434(*(field[rows, best] for field in laws))


def _with_best_b(part: Array, ratios: DisplacementRatios) -> Lin434:
    """Return the laws of given parts p with the b of least time."""
    most = 6.0 / (1.0 - part)
    least_acceleration = most * part / (1.0 - part)
    low, high = np.zeros_like(most), most
    for _ in range(40):  # of b: to 1e-12 of its range
        b = 0.5 * (low + high)
        acceleration = np.sqrt(ratios.acceleration * np.where(
            b * (1.0 + part) < most * part, most - b,
            (most * part + b * (1.0 - part)) ** 2 / (4.0 * b * part)))
        falls = b < least_acceleration
        falling = np.maximum.reduce((
            ratios.velocity * (1.5 / (1.0 - part) - b / 12.0),
            np.cbrt(ratios.jerk * (most - b) / (0.5 - part)), np.where(falls, acceleration, 0.0)))
        rising = np.maximum(np.cbrt(ratios.jerk * (most + b * (1.0 / part - 1.0)) / part),
                            np.where(falls, 0.0, acceleration))
        low, high = np.where(falling > rising, b, low), np.where(falling > rising, high, b)
    b = 0.5 * (low + high)
    return Lin434(part, part, most - b, b - most)
