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

In Lin's 4-3-4 the joins' times and positions are free. The motion's beginning and its end are
taken to be alike here: lift-off and set-down last the same part p of it and cover the same part of
the way. If p is the same for both, that costs nothing: peaks of the mean of a law and its reverse
are not above theirs, and the mean is a 4-3-4 law of the same p. Laws with unequal parts save at
most 1 % of time as long as lift-off only speeds up and set-down only slows down (figure 4.1).
Without that, a "set-down" that first goes on speeding up would save up to 9 %.

There are two numbers left, p and the bulge b = p k1 of the lift-off's acceleration, 0 <= b <= m
with m = 6 / (1 - p). By hand, from `lin_434`, peaks are

    velocity      3 / (2 (1 - p)) - b / 12                           half-way
    acceleration  (m p + b (1 - p))^2 / (4 b p), or m - b            in lift-off, or at its end
    jerk          (m + b (1 / p - 1)) / p and (m - b) / (1/2 - p)    at the start, in the cruise

- jerk alone: p = 1/4, b = 0, jerk of 32 way / duration^3, constant in three parts (the lift-off
  is a cubic then): the least of any motion from rest to rest;
- acceleration alone: 6 way / duration^2 for every p, with b = m p / (1 - p); p = 1/3 is taken, or
  what other limits leave that is nearest to it;
- velocity alone: b = m, the cruise at constant velocity, and the lift-off Paul's quartic (6.1).

Between these, b is found by bisection: velocity and the cruise's jerk fall with it, the jerk at
the start rises, acceleration falls, then rises; p by narrowing a grid.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.motion_laws.lin_434 import Law434
from rrr_traj_planner.planners.transitions.via_problem import ViaProblem

LEAST_PART, MOST_PART = 1e-7, 0.49  # of the duration, for lift-off; a cruise is always left
USUAL_PART = 1.0 / 3.0
# What a part that is not the usual one counts as longer: decides between parts that cost the same.
PREFERENCE = 1e-8
GRID = np.linspace(0.0, 1.0, 33)
ROUNDS = 7       # each narrows the grid to a sixteenth
BISECTIONS = 40


class Loads(NamedTuple):
    """
    What the limits ask of segments, fields of shape (n,): the largest way / limit of all joints.

    A law whose peaks are V, A and J lasts at least V velocity, sqrt(A acceleration) and
    cbrt(J jerk).
    """

    velocity: Array      # [s]
    acceleration: Array  # [s^2]
    jerk: Array          # [s^3]


def loads_of(problem: ViaProblem) -> Loads:
    """
    Return what the limits ask of each segment.

    Parameters
    ----------
    problem : ViaProblem
        Displacements and limits; the function's are those that the law has been made with.

    Returns
    -------
    Loads
        0 where nothing moves.

    """
    ways, law, function = np.abs(problem.displacements), problem.law, problem.function
    return Loads((ways / problem.max_velocity).max(axis=1),
                 (ways * law.slope / function.peak_acceleration).max(axis=1),
                 (ways * law.root ** 2 / function.peak_jerk).max(axis=1))


def least_time(law: Law434, loads: Loads) -> Array:
    """
    Return how long laws must last.

    Parameters
    ----------
    law : Law434
        One or more.
    loads : Loads
        What the limits ask; broadcasts with the law.

    Returns
    -------
    ndarray
        [s].

    """
    return np.asarray(np.maximum.reduce((
        loads.velocity * np.abs(law.velocities()).max(axis=0),
        np.sqrt(loads.acceleration * np.abs(law.accelerations()).max(axis=0)),
        np.cbrt(loads.jerk * np.abs(law.jerks()).max(axis=0)))))


def fastest_symmetric(loads: Loads) -> Law434:
    """
    Return the symmetric law of least time of each segment.

    Parameters
    ----------
    loads : Loads
        What the limits ask, shape (n,).

    Returns
    -------
    Law434
        Fields of shape (n,).

    """
    moving = loads.acceleration > 0.0
    loads = Loads(*(np.where(moving, load, 1.0)[:, np.newaxis] for load in loads))
    rows = np.arange(len(moving))
    low, high = (np.full(len(moving), np.log(part)) for part in (LEAST_PART, MOST_PART))
    for _ in range(ROUNDS):
        grid = low[:, np.newaxis] + (high - low)[:, np.newaxis] * GRID
        laws = _with_best_bulge(np.exp(grid), loads)
        best = (least_time(laws, loads) * (
            1.0 + PREFERENCE * (grid - np.log(USUAL_PART)) ** 2)).argmin(axis=1)
        low = grid[rows, np.maximum(best - 1, 0)]
        high = grid[rows, np.minimum(best + 1, len(GRID) - 1)]
    return Law434(*(field[rows, best] for field in laws))


def _with_best_bulge(part: Array, loads: Loads) -> Law434:
    """Return the laws of given lift-offs whose bulge gives the least time."""
    most = 6.0 / (1.0 - part)
    least_acceleration = most * part / (1.0 - part)
    low, high = np.zeros_like(most), most
    for _ in range(BISECTIONS):
        b = 0.5 * (low + high)
        acceleration = np.sqrt(loads.acceleration * np.where(
            b * (1.0 + part) < most * part, most - b,
            (most * part + b * (1.0 - part)) ** 2 / (4.0 * b * part)))
        falls = b < least_acceleration
        falling = np.maximum.reduce((
            loads.velocity * (1.5 / (1.0 - part) - b / 12.0),
            np.cbrt(loads.jerk * (most - b) / (0.5 - part)), np.where(falls, acceleration, 0.0)))
        rising = np.maximum(np.cbrt(loads.jerk * (most + b * (1.0 / part - 1.0)) / part),
                            np.where(falls, 0.0, acceleration))
        low, high = np.where(falling > rising, b, low), np.where(falling > rising, high, b)
    b = 0.5 * (low + high)
    return Law434(part, part, most - b, b - most)
