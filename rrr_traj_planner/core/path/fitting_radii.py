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
Radii of curved zones, reduced where neighbouring zones would overlap.

Our own method: radii grow together from a feasible size until zones touch.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.core.cancellation import never, ShouldStop
from rrr_traj_planner.core.errors import ConvergenceError
from rrr_traj_planner.core.path.tangent_lines import (
    Accuracy,
    EXACT,
    nearly_tangent_lines,
    Tangents,
)
from rrr_traj_planner.core.path.zone_kind import ZoneKind

# Growth of radii; all values are chosen.
MAX_GROWTH = 1.5    # largest factor from one step to the next
MIN_GROWTH = 1.005  # a zone that cannot grow by this factor touches a neighbour
REGROWTH = 1.05     # first factor of a second pass: blocked zones may grow where neighbours grew
NEIGHBOURHOOD = 12  # zones to either side of an infeasible line whose growth it slows
OFFENDER_FRACTION = 0.5  # of the largest error, from which a line counts as infeasible
TIE_TOLERANCE = 1e-4     # of a leg, by which the slack of zones that stop together may differ
LEAST_FRACTION = 0.5 ** 60  # of the requested radius, the smallest that is tried
GROWTH_STEPS, MOST_ZONE_STEPS = 1000, 60_000  # at most; the second over the number of zones
COARSE = Accuracy(1e-8, 1e-8, 10, 3)  # of lines while radii grow
SHRINKING = 1.0 - 1e-3 * 2.0 ** np.arange(10)  # successive factors on radii that grew too large
SHORTEST_LINE = 1e-3  # of a leg: the time along shorter lines is ill-conditioned


class Fitted(NamedTuple):
    """Feasible radii, and the lines between the zones."""

    radii: Array  # [m], shape (n - 2,)
    lines: Tangents


def fit_radii(points: Array, radii: Array, kind: ZoneKind,
              should_stop: ShouldStop = never) -> Fitted:
    """
    Return the requested radii, or the largest that are feasible where zones would overlap.

    If they are too large, all radii grow together from a feasible size. Where a step makes zones
    overlap, they and their neighbourhood take smaller steps; a zone that touches a neighbour stops
    growing, the others continue. A change of one radius affects only nearby lines, so the number
    of steps hardly grows with the number of points.

    Parameters
    ----------
    points : ndarray, shape (n, 3)
        Via points [m].
    radii : ndarray, shape (n - 2,)
        Least radius requested at each interior point [m].
    kind : ZoneKind
        The kind of zone.
    should_stop : callable
        Polled in every step; after True, radii stop growing and are only reduced as far as
        feasibility requires.

    Returns
    -------
    Fitted
        Radii, none larger than requested, and the lines.

    Raises
    ------
    ConvergenceError
        If not even very small zones are feasible.

    """
    lines, infeasible = _lines_for(points, radii, kind, None)
    if not infeasible.any():
        return Fitted(radii, lines)
    if should_stop():  # shrink from the requested radii instead of growing from much smaller ones
        fitted = _shrunk(points, radii, LEAST_FRACTION * radii, kind, lines.direction, should_stop)
        if fitted is not None:
            return fitted
    smaller, accuracy = radii.copy(), COARSE
    while (smaller > LEAST_FRACTION * radii).any():
        should_stop()
        if infeasible.any():
            smaller[_near(infeasible, smaller > LEAST_FRACTION * radii)] *= 0.5
        elif accuracy is EXACT:
            return _grown(points, radii, kind, Fitted(smaller, lines), should_stop)
        accuracy = COARSE if infeasible.any() else EXACT
        lines, infeasible = _lines_for(points, smaller, kind, None, accuracy)
    raise ConvergenceError(f'no curved zones are feasible, not even radii {smaller.tolist()} m')


def _grown(points: Array, radii: Array, kind: ZoneKind, least: Fitted,
           should_stop: ShouldStop) -> Fitted:
    """Return radii grown from smaller ones until zones touch."""
    grown, lines = (_grown_alone if len(radii) == 1 else _grown_together)(
        points, radii, kind, least, should_stop)
    return _shrunk(points, grown, least.radii, kind, lines.direction, should_stop) or least


def _grown_together(points: Array, radii: Array, kind: ZoneKind, least: Fitted,
                    should_stop: ShouldStop) -> Fitted:
    """Return radii grown from feasible ones until zones touch; feasible but for rounding."""
    fraction, lines = least.radii / radii, least.lines
    steps = min(GROWTH_STEPS, MOST_ZONE_STEPS // len(fraction))
    for first_growth in (MAX_GROWTH, REGROWTH):
        growing, factor = fraction < 1.0, np.full(len(fraction), first_growth)
        while growing.any() and steps and not should_stop():
            steps -= 1
            larger = np.where(growing, np.minimum(fraction * factor, 1.0), fraction)
            tried, infeasible = _lines_for(points, larger * radii, kind, lines.direction, COARSE)
            if not infeasible.any():
                fraction, lines = larger, tried
                growing &= fraction < 1.0
                factor = np.minimum(factor ** 2, MAX_GROWTH)  # the obstacle may be passed
                continue
            slower = _near(infeasible, growing)
            blocked = slower & (factor <= MIN_GROWTH)
            touching = blocked & ~_free_alone(points, radii, kind, fraction, lines, blocked)
            growing &= ~(touching if touching.any() else _tightest(points, lines, blocked))
            factor[slower] = np.maximum(np.sqrt(factor[slower]), MIN_GROWTH)
    return Fitted(fraction * radii, lines)


def _grown_alone(points: Array, radii: Array, kind: ZoneKind, least: Fitted,
                 should_stop: ShouldStop) -> Fitted:
    """Return the largest radius of the only zone, between a feasible and an infeasible one."""
    feasible, infeasible = least, radii
    while (infeasible > MIN_GROWTH * feasible.radii).any() and not should_stop():
        tried = np.sqrt(feasible.radii * infeasible)
        lines, too_large = _lines_for(points, tried, kind, feasible.lines.direction, COARSE)
        if too_large.any():
            infeasible = tried
        else:
            feasible = Fitted(tried, lines)
    return feasible


def _shrunk(points: Array, radii: Array, least: Array, kind: ZoneKind, near: Array,
            should_stop: ShouldStop) -> Fitted | None:
    """Return radii feasible for exact lines, reduced little by little where they are not."""
    for part in SHRINKING:
        lines, infeasible = _lines_for(points, radii, kind, near)
        if not infeasible.any():
            return Fitted(radii, lines)
        should_stop()
        radii = np.where(_near(infeasible, radii > least), np.maximum(part * radii, least), radii)
    return None


def _lines_for(points: Array, radii: Array, kind: ZoneKind, near: Array | None,
               accuracy: Accuracy = EXACT) -> tuple[Tangents, BoolArray]:
    """Return the lines between zones, and which are infeasible: not tangent, or too short."""
    with np.errstate(divide='ignore', invalid='ignore', over='ignore'):
        lines, misses = nearly_tangent_lines(points, radii, kind, near, accuracy)
        worst = misses.max()
        least = SHORTEST_LINE * np.linalg.norm(np.diff(points, axis=0), axis=1)
        return lines, np.asarray(misses >= OFFENDER_FRACTION * worst if worst > accuracy.tolerance
                                 else ~(lines.length >= least))


def _free_alone(points: Array, radii: Array, kind: ZoneKind, fraction: Array, lines: Tangents,
                zones: BoolArray) -> BoolArray:
    """Return which zones can grow while all in their neighbourhood keep their radii."""
    free = zones.copy()
    for first in range(NEIGHBOURHOOD):
        alone = np.zeros(len(zones), dtype=bool)
        alone[first::NEIGHBOURHOOD] = zones[first::NEIGHBOURHOOD]
        if alone.any():
            larger = np.where(alone, np.minimum(fraction * MIN_GROWTH, 1.0), fraction)
            _, infeasible = _lines_for(points, larger * radii, kind, lines.direction, COARSE)
            if infeasible.any():
                free &= ~_next_to(infeasible, alone)
    return free


def _tightest(points: Array, lines: Tangents, zones: BoolArray) -> BoolArray:
    """Return the zones with the smallest slack in their neighbourhood."""
    left = lines.length / np.linalg.norm(np.diff(points, axis=0), axis=1)
    # A zone's slack: the shorter of its lines, and the turn that remains to half a revolution.
    slack = np.minimum(np.minimum(left[:-1], left[1:]), np.cos(lines.angle))
    slack = np.where(zones, slack, np.inf)
    padded = np.pad(slack, NEIGHBOURHOOD, constant_values=np.inf)
    around = sliding_window_view(padded, 2 * NEIGHBOURHOOD + 1)
    return np.asarray(zones & (slack <= around.min(axis=1) + TIE_TOLERANCE))


def _near(lines: BoolArray, zones: BoolArray) -> BoolArray:
    """Return which of some zones are in the neighbourhood of lines; all if none is."""
    counts = np.convolve(lines, np.ones(2 * NEIGHBOURHOOD, dtype=int))
    nearby = (counts[NEIGHBOURHOOD:-NEIGHBOURHOOD] > 0) & zones
    return nearby if nearby.any() else zones


def _next_to(lines: BoolArray, zones: BoolArray) -> BoolArray:
    """Return which of some zones, NEIGHBOURHOOD apart, are nearest to a line."""
    at = np.flatnonzero(zones)
    found = np.zeros(len(zones), dtype=bool)
    position = np.flatnonzero(lines) - 0.5  # of a line: between the zones before and after it
    found[at[np.abs(position[:, np.newaxis] - at).argmin(axis=1)]] = True
    return found
