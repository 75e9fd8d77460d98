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
Lines that are tangent to the curved zones at both ends, each zone through its via point.

Newton's method with step halving (Nocedal and Wright, Numerical Optimization, chapter 11).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.errors import ConvergenceError
from rrr_traj_planner.core.path.zone_kind import ZoneKind
from scipy.linalg import solve_banded

DIFFERENCE = 1e-7   # rad, step of the numerical derivative: root of the rounding, some 1e-15
LARGEST_STEP = 0.3  # rad, largest turn of a line in an iteration; chosen

# Each line's error depends on its own direction and its two neighbours' alone: in the numerical
# derivative, every third line is turned together.
COLOURS = 3
BAND = 3  # half bandwidth of the matrix: 2 components of 3 lines

# Cyclic permutations of coordinates: what is y, and what is z, for x, y, z.
NEXT, AFTER_NEXT = np.array((1, 2, 0)), np.array((2, 0, 1))


class Accuracy(NamedTuple):
    """Convergence tolerances and iteration limits of the Newton method."""

    aimed_at: float   # largest error of a line at a zone's end, relative to the largest extent
    tolerance: float  # the same, accepted where the iteration does not converge further
    iterations: int
    halvings: int     # of a step that does not reduce the error


# As exact as rounding allows. Of 839 sets of lines half took at most 3 iterations, 1 % all 40.
EXACT = Accuracy(1e-14, 2e-13, 40, 12)


class Tangents(NamedTuple):
    """Lines from zone to zone, n - 1 of them for n points."""

    direction: Array  # unit vectors, shape (..., n - 1, 3)
    start: Array      # where each line leaves the zone before it [m]
    stop: Array       # where it meets the zone after it [m]
    angle: Array      # half turn of each zone [rad], shape (..., n - 2)

    @property
    def length(self) -> Array:
        """Signed lengths of the lines [m]; negative where neighbouring zones overlap."""
        return np.asarray(np.einsum('...i,...i', self.direction, self.stop - self.start))


def tangents(points: Array, radii: Array, kind: ZoneKind, direction: Array) -> Tangents:
    """
    Return the lines for given directions; tangent to their zones for the right directions only.

    A zone whose lines have the directions d1 and d2 has its tangent along d1 + d2 and its normal
    along d2 - d1 in its middle (5.56 and 5.64 with unit vectors).

    Parameters
    ----------
    points : ndarray, shape (n, 3)
        Via points [m].
    radii : ndarray, shape (n - 2,)
        Least radius of each zone [m].
    kind : ZoneKind
        The kind of zone.
    direction : ndarray, shape (..., n - 1, 3)
        Unit vectors.

    Returns
    -------
    Tangents
        Lines, and half the angle between each two.

    """
    along = 0.5 * (direction[..., :-1, :] + direction[..., 1:, :])
    inward = 0.5 * (direction[..., 1:, :] - direction[..., :-1, :])
    cosine, sine = np.linalg.norm(along, axis=-1), np.linalg.norm(inward, axis=-1)
    angle = np.arctan2(sine, cosine)
    x, y = kind.ends(angle)
    straight = sine == 0.0
    forward = (radii * x / cosine)[..., np.newaxis] * along
    across = np.where(straight, 0.0, radii * y / np.where(straight, 1.0, sine))
    side = np.asarray(kind.side)[..., np.newaxis]
    centre = points[1:-1] + (1 - side ** 2) * across[..., np.newaxis] * inward + side * forward
    first = np.broadcast_to(points[:1], direction.shape[:-2] + (1, 3))
    last = np.broadcast_to(points[-1:], first.shape)
    return Tangents(direction, np.concatenate((first, centre + forward), axis=-2),
                    np.concatenate((centre - forward, last), axis=-2), angle)


def tangent_lines(points: Array, radii: Array, kind: ZoneKind,
                  near: Array | None = None) -> Tangents:
    """
    Return the lines that are tangent to every zone while each zone contains its via point.

    The corners where neighbouring lines meet lie outside the polyline.

    Parameters
    ----------
    points : ndarray, shape (n, 3)
        Via points [m].
    radii : ndarray, shape (n - 2,)
        Least radius of each zone [m].
    kind : ZoneKind
        The kind of zone.
    near : ndarray, shape (n - 1, 3), optional
        Directions to begin with; without them, the polyline's.

    Returns
    -------
    Tangents
        The lines; their lengths are negative where zones overlap.

    Raises
    ------
    ConvergenceError
        If there are no such lines, or none were found: the radii are too large.

    """
    lines, misses = nearly_tangent_lines(points, radii, kind, near)
    if not (misses <= EXACT.tolerance).all():
        raise ConvergenceError(
            f'no lines are tangent to zones with radii {radii.tolist()} m: the best miss by '
            f"{misses.max():.3g} of the path's extent")
    return lines


def nearly_tangent_lines(points: Array, radii: Array, kind: ZoneKind, near: Array | None = None,
                         accuracy: Accuracy = EXACT) -> tuple[Tangents, Array]:
    """
    Return the lines of `tangent_lines`, or the best found, and their errors.

    Newton's method on the directions of the lines, which stay well defined where the corners
    recede to infinity. A line's error depends on its own direction and its neighbours' alone: each
    step solves a band matrix, in time linear in the number of points.

    Parameters
    ----------
    points, radii, kind, near
        As of `tangent_lines`.
    accuracy : Accuracy
        Tolerances and iteration limits.

    Returns
    -------
    tuple of Tangents and ndarray, shape (n - 1,)
        The lines, and the distance of each from a zone's end, relative to the largest extent.

    """
    legs = np.diff(points, axis=0)
    direction = _unit(legs) if near is None else near
    scale = max(float(np.ptp(points, axis=0).max()), float(np.abs(points).max()))
    basis = _basis(direction)
    lines = tangents(points, radii, kind, direction)
    misses, before = _misses(lines, basis), np.inf
    for _ in range(accuracy.iterations):
        miss = _largest(misses)
        if miss <= accuracy.aimed_at * scale or 0.5 * before < miss <= accuracy.tolerance * scale:
            break
        step = _newton_step(points, radii, kind, lines, basis, misses)
        better = None if step is None else _damped(
            points, radii, kind, lines, basis, step, miss, accuracy.halvings)
        if better is None:
            break
        (lines, basis, misses), before = better, miss
    return lines, np.nan_to_num(np.abs(misses).max(axis=-1) / scale, nan=np.inf)


def frames(first: Array, second: Array) -> tuple[Array, Array]:
    """
    Return the path's tangent and normal at via points from the directions before and after.

    5.56 and 5.64 with unit vectors in place of the legs; orthogonal to rounding however little
    or much the path turns.

    Parameters
    ----------
    first, second : ndarray, shape (k, 3)
        Unit vectors.

    Returns
    -------
    tuple of ndarray, shape (k, 3)
        Tangents and normals; a normal is zero where the path is straight.

    """
    along, inward = first + second, second - first
    cosine, sine = (np.linalg.norm(v, axis=-1, keepdims=True) for v in (along, inward))
    with np.errstate(divide='ignore', invalid='ignore'):
        T, N = along / cosine, np.where(sine > 0.0, inward / sine, 0.0)
    common = (T * N).sum(axis=-1, keepdims=True)
    T, N = (np.where(cosine < sine, _unit(T - common * N), T),
            np.where(cosine < sine, N, N - common * T))
    size = np.linalg.norm(N, axis=-1, keepdims=True)
    return T, N / np.where(size > 0.0, size, 1.0)


def _damped(points: Array, radii: Array, kind: ZoneKind, lines: Tangents, basis: Array,
            step: Array, miss: float, halvings: int) -> tuple[Tangents, Array, Array] | None:
    """
    Return the lines after the largest halving of a step that reduces their error, or None.

    With the vectors across them, and their misses.

    """
    fraction = min(1.0, LARGEST_STEP / max(float(np.abs(step).max()), 1e-300))
    for _ in range(halvings):
        tried = tangents(points, radii, kind, _turned(lines.direction, basis, fraction * step))
        across = _basis(tried.direction)
        misses = _misses(tried, across)
        if _largest(misses) < miss:
            return tried, across, misses
        fraction *= 0.5
    return None


def _newton_step(points: Array, radii: Array, kind: ZoneKind, lines: Tangents,
                 basis: Array, misses: Array) -> Array | None:
    """Return the Newton step: turns of the lines, shape (n - 1, 2) [rad]; None if singular."""
    n = len(lines.direction)
    turns = np.zeros((COLOURS, 2, n, 2))
    for colour in range(COLOURS):
        turns[colour, :, colour::COLOURS] = np.eye(2)[:, np.newaxis] * DIFFERENCE
    turned = tangents(points, radii, kind, _turned(lines.direction, basis, turns))
    slope = (_misses(turned, basis) - misses) / DIFFERENCE  # colour, turn, line, component
    band = np.zeros((2 * BAND + 1, n, 2))  # diagonals of LAPACK's band, by line and turn
    for offset in (-1, 0, 1):  # the turn of a line affects itself and its neighbours
        own = np.arange(max(-offset, 0), n - max(offset, 0))
        for component in range(2):
            for turn in range(2):
                band[BAND + 2 * offset + component - turn, own, turn] = slope[
                    own % COLOURS, turn, own + offset, component]
    if not np.isfinite(band).all():
        return None
    try:
        step = solve_banded((BAND, BAND), band.reshape(2 * BAND + 1, 2 * n), -misses.ravel(),
                            overwrite_ab=True, overwrite_b=True, check_finite=False)
    except np.linalg.LinAlgError:
        return None
    return np.asarray(step, dtype=float).reshape(n, 2)


def _misses(lines: Tangents, basis: Array) -> Array:
    """Return each line's distance from the end of the zone after it, across the line [m]."""
    offset = lines.stop - lines.start
    off = offset - lines.direction * lines.length[..., np.newaxis]
    return np.asarray(np.einsum('...ki,kji->...kj', off, basis))


def _largest(misses: Array) -> float:
    """Return the largest magnitude, infinite if one is not a number."""
    worst = float(np.abs(misses).max())
    return worst if np.isfinite(worst) else np.inf


def _turned(direction: Array, basis: Array, angles: Array) -> Array:
    """Return directions turned a little along their basis vectors."""
    return _unit(direction + np.einsum('...kj,kji->...ki', angles, basis))


def _basis(direction: Array) -> Array:
    """Return two unit vectors across each direction, shape (n, 2, 3)."""
    axis = np.eye(3)[np.abs(direction).argmin(axis=-1)]
    basis = np.empty(direction.shape[:-1] + (2, 3))
    basis[..., 0, :] = _unit(_cross(direction, axis))
    basis[..., 1, :] = _cross(direction, basis[..., 0, :])
    return basis


def _cross(a: Array, b: Array) -> Array:
    """Return products of vectors, many times faster than `numpy.cross`."""
    return np.asarray(a.take(NEXT, -1) * b.take(AFTER_NEXT, -1)
                      - a.take(AFTER_NEXT, -1) * b.take(NEXT, -1))


def _unit(vectors: Array) -> Array:
    return np.asarray(vectors / np.linalg.norm(vectors, axis=-1, keepdims=True), dtype=float)
