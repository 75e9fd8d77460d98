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

"""Geometric path of the tip: straight lines and curved zones through via points (thesis 3.3)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike
from rrr_traj_planner.core.arrays import Array, BoolArray, IntArray, parameter_values
from rrr_traj_planner.core.errors import format_distinct, InvalidInputError
from rrr_traj_planner.core.path.deviation import polyline_deviation
from rrr_traj_planner.core.path.tangent_lines import Tangents
from rrr_traj_planner.core.read_only import make_read_only, ReadOnlyArrays

# Zones of which both length and turn are no larger than these are omitted: some hundred times the
# rounding of positions of a metre, and of angles between lines. Chosen.
SHORTEST_ZONE = 1e-13  # m
SMALLEST_TURN = 5e-13  # rad, to either side of the via point
STEPS_PER_PIECE = 24   # of the path, in `grid`; chosen


class Zones(Protocol):
    """Curved zones of least radius 1, each in a plane of its own, its middle the origin."""

    before: Array  # length before the middle, in least radii, shape (k,)
    after: Array

    def outline(self, zone: IntArray, part: Array) -> tuple[Array, Array]:
        """
        Return x along the tangent and y along the normal.

        Parameters
        ----------
        zone : ndarray of int, shape (m,)
            Which zone.
        part : ndarray, shape (m,)
            Where: -1 and 1 are its ends, 0 is its middle; monotonic, not the length.

        Returns
        -------
        tuple of ndarray, shape (m,)
            x and y, in least radii.

        """

    def at(self, zone: IntArray, sigma: Array) -> Array:
        """
        Return x along the tangent and y along the normal, and three derivatives.

        Parameters
        ----------
        zone : ndarray of int, shape (m,)
            Which zone.
        sigma : ndarray, shape (m,)
            Length from the middle, in least radii.

        Returns
        -------
        ndarray, shape (4, 2, m)
            Position and derivatives by sigma.

        """


@dataclass(frozen=True, eq=False)
class CartesianPath(ReadOnlyArrays):
    """
    Lines and curved zones, one zone at each interior via point, by arc length s.

    Made by `line_arc` and `line_polynomial` in `path.design`.

    Parameters
    ----------
    points : ndarray, shape (n, 3)
        Via points [m].
    requested_radii, radii : ndarray, shape (n - 2,)
        Least radius of each zone [m]: requested, and used: smaller where zones would overlap.
    lines : Tangents
        The n - 1 lines between the zones.
    tangent, normal : ndarray, shape (n - 2, 3)
        Unit vectors of the path in the middles of the zones, where their via points are unless
        they are at a side (5.56, 5.64).
    zones : Zones
        Shapes of the zones.
    side : ndarray of int, shape (n - 2,)
        Position of the via point in each zone, see `ZoneKind`.

    """

    points: Array
    requested_radii: Array
    radii: Array
    lines: Tangents
    tangent: Array
    normal: Array
    zones: Zones
    side: IntArray

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        super().__post_init__()
        make_read_only((self.via_s, self.zone_ends))

    @cached_property
    def _bounds(self) -> Array:
        """Path coordinates of the pieces' ends: line, zone, line, ..., line [m]."""
        before, after = self._zone_lengths
        widths = np.zeros(2 * len(self.lines.direction) - 1)
        widths[::2] = np.maximum(self.lines.length, 0.0)
        widths[1::2] = before + after
        return np.concatenate(([0.0], np.cumsum(widths)))

    @cached_property
    def _zone_lengths(self) -> tuple[Array, Array]:
        """Lengths of the zones before and after their via points [m]."""
        before, after = self.radii * self.zones.before, self.radii * self.zones.after
        none = (before + after <= 2.0 * SHORTEST_ZONE) & (self.lines.angle <= SMALLEST_TURN)
        return np.where(none, 0.0, before), np.where(none, 0.0, after)

    @property
    def length(self) -> float:
        """Length of the path [m]."""
        return float(self._bounds[-1])

    @cached_property
    def _middles(self) -> Array:
        """Path coordinates of the zones' middles [m], shape (n - 2,)."""
        return np.asarray(self._bounds[1:-1:2] + self._zone_lengths[0])

    @cached_property
    def _origins(self) -> Array:
        """Positions of the zones' middles [m], shape (n - 2, 3)."""
        x, y = self.zones.at(np.arange(len(self.side)), self.zones.after)[0]
        along = (self.side * self.radii * x)[:, np.newaxis] * self.tangent
        inward = (self.side ** 2 * self.radii * y)[:, np.newaxis] * self.normal
        return np.asarray(self.points[1:-1] + along - inward)

    @cached_property
    def via_s(self) -> Array:
        """Path coordinates of the via points [m], shape (n,)."""
        inner = np.choose(self.side + 1, (
            self._bounds[2:-1:2], self._middles, self._bounds[1:-1:2]))
        return np.concatenate(([0.0], inner, self._bounds[-1:]))

    @cached_property
    def zone_ends(self) -> Array:
        """Path coordinates of both ends of zones [m], shape (n - 2, 2); equal where none is."""
        return np.stack((self._bounds[1:-1:2], self._bounds[2:-1:2]), axis=1)

    @property
    def joins(self) -> Array:
        """Path coordinates where pieces meet [m], increasing; curvature of arcs steps there."""
        ends = self.zone_ends[self.zone_ends[:, 1] > self.zone_ends[:, 0]]
        joins = np.unique(ends)
        return joins[(joins > 0.0) & (joins < self.length)]

    @property
    def grid(self) -> Array:
        """Path coordinates [m] that include every join and via point, with steps between them."""
        knots = np.unique(np.concatenate((self.via_s, self.joins)))
        fraction = np.arange(STEPS_PER_PIECE) / STEPS_PER_PIECE
        inner = knots[:-1, np.newaxis] + np.diff(knots)[:, np.newaxis] * fraction
        return np.concatenate((inner.ravel(), knots[-1:]))

    @property
    def shrunk(self) -> IntArray:
        """Numbers of the via points whose radius is smaller than requested."""
        return np.flatnonzero(self.radii < self.requested_radii) + 1

    @cached_property
    def deviation(self) -> Array:
        """Largest distance from the polyline near each interior via point [m]."""
        return polyline_deviation(self.points, self._outline)

    def __call__(self, s: ArrayLike, left: bool | BoolArray = False) -> tuple[
            Array, Array, Array, Array]:
        """
        Return position and its first three derivatives by arc length.

        Parameters
        ----------
        s : array_like, shape (m,) or ()
            Path coordinates [m].
        left : bool or ndarray of bool, shape (m,)
            At a join, the values of the piece that ends there instead of the one that begins.

        Returns
        -------
        tuple of ndarray, shape (m, 3) or (3,)
            p [m], dp/ds [1], d2p/ds2 [1/m], d3p/ds3 [1/m^2].

        Raises
        ------
        InvalidInputError
            If a path coordinate is beyond the path's ends by more than rounding.

        """
        given = parameter_values('s', s)
        flat = self._on_path(np.atleast_1d(given))
        # Zero-length pieces are never selected, from the left or from the right.
        inner = self._bounds[1:-1]
        piece = np.where(left, np.searchsorted(inner, flat, side='left'),
                         np.searchsorted(inner, flat, side='right'))
        values = np.zeros((4, len(flat), 3))
        self._fill_lines(values, flat, piece)
        self._fill_zones(values, flat, piece)
        if given.ndim == 0:
            values = values[:, 0]
        return values[0], values[1], values[2], values[3]

    def _outline(self, zone: IntArray, part: Array) -> Array:
        """Return points in zones [m], see `Zones.outline`."""
        x, y = (self.radii[zone] * f for f in self.zones.outline(zone, part))
        return np.asarray(self._origins[zone] + x[:, np.newaxis] * self.tangent[zone]
                          + y[:, np.newaxis] * self.normal[zone])

    def _on_path(self, s: Array) -> Array:
        """Return path coordinates, clipped to the path's ends where rounding put them beyond."""
        # A path coordinate no further beyond an end was put there by rounding.
        tolerance = 1e-9 * self.length
        bad = ~((s >= -tolerance) & (s <= self.length + tolerance))
        if bad.any():
            wrong, first, last = format_distinct(s[bad][0], 0.0, self.length)
            raise InvalidInputError(f's is {wrong} m, must be on the path, {first} to {last} m')
        return np.clip(s, 0.0, self.length)

    def _fill_lines(self, values: Array, s: Array, piece: IntArray) -> None:
        """Enter the samples on lines."""
        at = np.flatnonzero(piece % 2 == 0)
        line = piece[at] // 2
        offset = (s[at] - self._bounds[piece[at]])[:, np.newaxis]
        values[0, at] = self.lines.start[line] + offset * self.lines.direction[line]
        values[1, at] = self.lines.direction[line]

    def _fill_zones(self, values: Array, s: Array, piece: IntArray) -> None:
        """Enter the samples in curved zones."""
        at = np.flatnonzero(piece % 2 == 1)
        if not len(at):
            return
        zone = piece[at] // 2
        rho = self.radii[zone]
        x, y = np.moveaxis(self.zones.at(zone, self._sigma(s[at], piece[at])), 1, 0)
        power = rho ** (1.0 - np.arange(4.0))[:, np.newaxis]
        values[:, at] = ((power * x)[..., np.newaxis] * self.tangent[zone]
                         + (power * y)[..., np.newaxis] * self.normal[zone])
        values[0, at] += self._origins[zone]

    def _sigma(self, s: Array, piece: IntArray) -> Array:
        """Return lengths from the middle in radii, at the ends of a zone exactly its own."""
        zone = piece // 2
        first, last = -self.zones.before[zone], self.zones.after[zone]
        sigma = np.clip((s - self._middles[zone]) / self.radii[zone], first, last)
        sigma = np.where(s == self._bounds[piece], first, sigma)
        return np.where(s == self._bounds[piece + 1], last, sigma)
