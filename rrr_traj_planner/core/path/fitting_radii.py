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

"""Radii of curved zones, shrunk where neighbouring zones would overlap."""

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

FASTEST = 1.5    # radii, from one step to the next
SLOWEST = 1.005  # a zone that cannot grow by this much touches a neighbour
REACH = 12       # zones up to so many from a line that overlaps them take smaller steps with it
THAWED = 1.05    # growth to begin with where they may be able to grow again
BLAMED = 0.5     # of the largest miss, of lines whose zones are too large to have tangents
TIE = 1e-4       # of a line, by which zones may differ that stop together
PASSES = 2       # of growth: zones that were stopped grow again where neighbours grew later
LEAST = 0.5 ** 60  # of what was asked for
STEPS, MOST_ZONE_STEPS = 1000, 60_000  # of growth, at most; the second over the number of zones
ROUGH = Accuracy(1e-8, 1e-8, 10, 3)  # of lines while radii grow
SHRINKING = 1.0 - 1e-3 * 2.0 ** np.arange(10)  # parts, again and again, of zones that grew too far
SHORTEST_LINE = 1e-3  # of a leg: the time along shorter ones is ill-conditioned, for little gained


class Fitted(NamedTuple):
    """Radii that fit, and the lines between the zones."""

    radii: Array  # [m], shape (n - 2,)
    lines: Tangents


def fit_radii(points: Array, radii: Array, kind: ZoneKind,
              should_stop: ShouldStop = never) -> Fitted:
    """
    Return the radii asked for, or the largest that fit where zones would overlap.

    Too large ones are grown together from a size at which all fit. Where a step makes zones
    overlap, they and those near them take smaller steps; a zone that touches a neighbour stops
    growing, the others go on. What one zone does is not felt far along the path, so the number of
    steps hardly grows with the number of points.

    Parameters
    ----------
    points : ndarray, shape (n, 3)
        Via points [m].
    radii : ndarray, shape (n - 2,)
        Least radius asked for at each interior point [m].
    kind : ZoneKind
        The kind of zone.
    should_stop : callable
        Asked in every step; once it answers True, radii no longer grow, and those that fit nearly
        are shrunk no more than need be.

    Returns
    -------
    Fitted
        Radii, none larger than asked for, and the lines.

    Raises
    ------
    ConvergenceError
        If not even very small zones fit.

    """
    lines, hindered = _tried(points, radii, kind, None)
    if not hindered.any():
        return Fitted(radii, lines)
    if should_stop():  # not to grow from radii that are much smaller than need be
        fitted = _shrunk(points, radii, LEAST * radii, kind, lines.direction, should_stop)
        if fitted is not None:
            return fitted
    smaller, accuracy = radii.copy(), ROUGH
    while (smaller > LEAST * radii).any():
        should_stop()
        if hindered.any():
            smaller[_near(hindered, smaller > LEAST * radii)] *= 0.5
        elif accuracy is EXACT:
            return _grown(points, radii, kind, Fitted(smaller, lines), should_stop)
        accuracy = ROUGH if hindered.any() else EXACT
        lines, hindered = _tried(points, smaller, kind, None, accuracy)
    raise ConvergenceError(f'no curved zones fit, not even with radii {smaller.tolist()} m')


def _grown(points: Array, radii: Array, kind: ZoneKind, least: Fitted,
           should_stop: ShouldStop) -> Fitted:
    """Return radii grown from smaller ones until zones touch."""
    share, lines = least.radii / radii, least.lines
    steps = min(STEPS, MOST_ZONE_STEPS // len(share))
    for fastest in (FASTEST,) + (PASSES - 1) * (THAWED,):
        growing, factor = share < 1.0, np.full(len(share), fastest)
        while growing.any() and steps and not should_stop():
            steps -= 1
            larger = np.where(growing, np.minimum(share * factor, 1.0), share)
            tried, hindered = _tried(points, larger * radii, kind, lines.direction, ROUGH)
            if not hindered.any():
                share, lines = larger, tried
                growing &= share < 1.0
                factor = np.minimum(factor ** 2, FASTEST)  # what slowed it may lie behind
                continue
            slower = _near(hindered, growing)
            stuck = slower & (factor <= SLOWEST)
            touching = stuck & ~_free_alone(points, radii, kind, share, lines, stuck)
            growing &= ~(touching if touching.any() else _tightest(points, lines, stuck))
            factor[slower] = np.maximum(np.sqrt(factor[slower]), SLOWEST)
    return _shrunk(points, share * radii, least.radii, kind, lines.direction,
                   should_stop) or least


def _shrunk(points: Array, radii: Array, least: Array, kind: ZoneKind, near: Array,
            should_stop: ShouldStop) -> Fitted | None:
    """Return radii that fit with exact lines, shrunk little by little where they do not."""
    for part in SHRINKING:
        lines, hindered = _tried(points, radii, kind, near)
        if not hindered.any():
            return Fitted(radii, lines)
        should_stop()
        radii = np.where(_near(hindered, radii > least), np.maximum(part * radii, least), radii)
    return None


def _tried(points: Array, radii: Array, kind: ZoneKind, near: Array | None,
           accuracy: Accuracy = EXACT) -> tuple[Tangents, BoolArray]:
    """Return the lines between zones, and which miss them most or are too short, (n - 1,)."""
    with np.errstate(divide='ignore', invalid='ignore', over='ignore'):
        lines, misses = nearly_tangent_lines(points, radii, kind, near, accuracy)
        worst = misses.max()
        least = SHORTEST_LINE * np.linalg.norm(np.diff(points, axis=0), axis=1)
        return lines, np.asarray(misses >= BLAMED * worst if worst > accuracy.tolerance
                                 else ~(lines.length >= least))


def _free_alone(points: Array, radii: Array, kind: ZoneKind, share: Array, lines: Tangents,
                zones: BoolArray) -> BoolArray:
    """Return which zones can grow while all near them stay as they are."""
    free = zones.copy()
    for first in range(REACH):
        alone = np.zeros(len(zones), dtype=bool)
        alone[first::REACH] = zones[first::REACH]
        if alone.any():
            larger = np.where(alone, np.minimum(share * SLOWEST, 1.0), share)
            _, hindered = _tried(points, larger * radii, kind, lines.direction, ROUGH)
            if hindered.any():
                free &= ~_next_to(hindered, alone)
    return free


def _tightest(points: Array, lines: Tangents, zones: BoolArray) -> BoolArray:
    """Return those of some zones that can grow no more than any other within reach."""
    left = lines.length / np.linalg.norm(np.diff(points, axis=0), axis=1)
    # A zone can grow by the shorter of its lines, and by what is left to half a revolution.
    slack = np.minimum(np.minimum(left[:-1], left[1:]), np.cos(lines.angle))
    slack = np.where(zones, slack, np.inf)
    around = sliding_window_view(np.pad(slack, REACH, constant_values=np.inf), 2 * REACH + 1)
    return np.asarray(zones & (slack <= around.min(axis=1) + TIE))


def _near(lines: BoolArray, zones: BoolArray) -> BoolArray:
    """Return which of some zones are within reach of lines; all of them where none is."""
    reached = np.convolve(lines, np.ones(2 * REACH, dtype=int))[REACH:-REACH] > 0
    return reached & zones if (reached & zones).any() else zones


def _next_to(lines: BoolArray, zones: BoolArray) -> BoolArray:
    """Return to which of zones that are REACH apart lines are nearest."""
    at = np.flatnonzero(zones)
    found = np.zeros(len(zones), dtype=bool)
    places = np.flatnonzero(lines) - 0.5  # of a line: between the zones before and after it
    found[at[np.abs(places[:, np.newaxis] - at).argmin(axis=1)]] = True
    return found
