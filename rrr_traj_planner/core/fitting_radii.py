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
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.core.errors import ConvergenceError
from rrr_traj_planner.core.tangent_lines import tangent_lines, Tangents, ZoneEnds

# Zones grow together by steps of at most FASTEST until two touch, which then keep their radius;
# how near they come to touching is a matter of the last step, SLOWEST. Steps that fail are
# followed by shorter ones, others by longer ones.
FASTEST = 1.5
SLOWEST = 1.005
THAWED = 1.05
# Zones that are small against every line always fit: so many halvings at most to come there.
HALVINGS = 60
STEPS_PER_ZONE = 200


class Fitted(NamedTuple):
    """Radii that fit, and the lines between the zones."""

    radii: Array  # [m], shape (n - 2,)
    lines: Tangents


def fit_radii(points: Array, radii: Array, ends: ZoneEnds) -> Fitted:
    """
    Return the radii asked for, or the largest that fit where zones would overlap.

    Too large ones are grown together from a size at which all fit; zones that touch stop
    growing, the others go on.

    Parameters
    ----------
    points : ndarray, shape (n, 3)
        Via points [m].
    radii : ndarray, shape (n - 2,)
        Least radius asked for at each interior point [m].
    ends : callable
        The kind of zone.

    Returns
    -------
    Fitted
        Radii, none larger than asked for, and the lines.

    Raises
    ------
    ConvergenceError
        If not even very small zones fit.

    """
    lines = _fitting(points, radii, ends, None)
    if lines is not None:
        return Fitted(radii, lines)
    share = np.ones(len(radii))
    for _ in range(HALVINGS):
        share *= 0.5
        lines = _fitting(points, share * radii, ends, None)
        if lines is not None:
            return _grown(points, radii, ends, share, lines)
    raise ConvergenceError(
        f'no curved zones fit, not even with radii {(share * radii).tolist()} m')


def _grown(points: Array, radii: Array, ends: ZoneEnds, share: Array, lines: Tangents) -> Fitted:
    """Return radii grown from a share of what was asked for until zones touch."""
    growing = share < 1.0
    thawed = np.zeros(len(share), dtype=bool)
    factor = FASTEST
    for _ in range(STEPS_PER_ZONE * len(radii)):
        if not growing.any():
            # Where neighbours grew later there may be room again: once for each zone.
            growing = (share < 1.0) & ~thawed
            growing &= _free(points, radii, ends, share, lines, THAWED)
            if not growing.any():
                return Fitted(share * radii, lines)
            thawed |= growing
            factor = FASTEST
        larger = np.where(growing, np.minimum(share * factor, 1.0), share)
        tried = _fitting(points, larger * radii, ends, lines.direction)
        if tried is not None:
            share, lines = larger, tried
            growing = growing & (share < 1.0)
            factor = min(factor ** 2, FASTEST)  # whatever slowed it may lie behind
        elif factor > SLOWEST:
            factor = max(np.sqrt(factor), SLOWEST)
        else:
            free = _free(points, radii, ends, share, lines, SLOWEST)
            growing &= ~_hindered(points, lines, growing) if free[growing].all() else free
            factor = FASTEST
    raise ConvergenceError(f'radii {radii.tolist()} m could not be made to fit')


def _free(points: Array, radii: Array, ends: ZoneEnds, share: Array, lines: Tangents,
          factor: float) -> BoolArray:
    """Return the zones that can grow by a factor while all others stay as they are."""
    alone = np.where(np.eye(len(share), dtype=bool), np.minimum(share * factor, 1.0), share)
    return np.array([_fitting(points, one * radii, ends, lines.direction) is not None
                     for one in alone])


def _fitting(points: Array, radii: Array, ends: ZoneEnds, near: Array | None) -> Tangents | None:
    """Return the lines between zones that do not overlap, or None."""
    try:
        with np.errstate(divide='ignore', invalid='ignore', over='ignore'):
            lines = tangent_lines(points, radii, ends, near)
    except ConvergenceError:
        return None
    return lines if (lines.length >= 0.0).all() else None


def _hindered(points: Array, lines: Tangents, growing: BoolArray) -> BoolArray:
    """Return the growing zones next to the line that has least left, or that turn most."""
    legs = np.linalg.norm(np.diff(points, axis=0), axis=1)
    left = lines.length / legs
    # A zone has room on the shorter of its lines, and in what is left to half a revolution.
    room = np.minimum(np.minimum(left[:-1], left[1:]), np.cos(lines.angle))
    least: float = room[growing].min()
    return np.asarray(growing & (room <= least))
