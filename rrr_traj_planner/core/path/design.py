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

"""The paths of thesis section 5.4 through any number of points, and their largest radii."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from rrr_traj_planner.core.arrays import Array, bound_array, finite_array, IntArray
from rrr_traj_planner.core.cancellation import never, ShouldStop
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.path.arc_zone import ArcZones
from rrr_traj_planner.core.path.cartesian_path import CartesianPath, Zones
from rrr_traj_planner.core.path.fitting_radii import fit_radii
from rrr_traj_planner.core.path.polynomial_zone import PolynomialZones
from rrr_traj_planner.core.path.tangent_lines import frames, Tangents
from rrr_traj_planner.core.path.three_point_arc import three_point_arc
from rrr_traj_planner.core.path.zone_kind import ZoneKind
from rrr_traj_planner.core.rounding import TIP_ROUNDING

REVERSAL = 1e-6  # rad, by which a turn must stay below half a revolution; chosen


def line_arc(points: ArrayLike, radii: ArrayLike,
             should_stop: ShouldStop = never, side: ArrayLike = 0) -> CartesianPath:
    """
    Return lines and arcs of circles; the tangent is continuous, curvature steps at the joins.

    Through three points this is the thesis's construction (5.63-5.68 with unit vectors in 5.56
    and 5.64). With more, consecutive circles lie in different planes and lines tangent to both
    exist only where each zone's tangent follows from its two lines, which move instead.

    Parameters
    ----------
    points : array_like, shape (n, 3)
        Via points [m], at least two.
    radii : array_like, shape (n - 2,) or ()
        Radius at each interior point [m]; reduced where neighbouring arcs would overlap.
    should_stop : callable
        See `fit_radii`.
    side : array_like of int, shape (n - 2,) or ()
        Position of the via point in each zone, see `ZoneKind`; 0: in its middle.

    Returns
    -------
    CartesianPath
        Through every point.

    Raises
    ------
    InvalidInputError
        If points repeat, the path reverses, or a radius is not positive.
    ConvergenceError
        If no lines were found.

    """
    points, requested, side = _checked(points, radii, side)
    if len(points) == 3 and not side.any():
        arc = three_point_arc(points, float(requested[0]))
        return CartesianPath(points, requested, np.array([arc.radius]), arc.lines,
                             arc.tangent, arc.normal, ArcZones([arc.before], [arc.after]), side)
    fitted = fit_radii(points, requested, ZoneKind(ArcZones.ends, side), should_stop)
    half = fitted.lines.angle
    return _path(points, requested, fitted.radii, fitted.lines, ArcZones(half, half), side)


def line_polynomial(points: ArrayLike, radii: ArrayLike,
                    should_stop: ShouldStop = never, side: ArrayLike = 0) -> CartesianPath:
    """
    Return lines and polynomial curved zones (3.18); curvature is continuous.

    Parameters
    ----------
    points : array_like, shape (n, 3)
        Via points [m], at least two.
    radii : array_like, shape (n - 2,) or ()
        Least radius of curvature of each zone [m], which is met at the via point; reduced where
        neighbouring zones would overlap.
    should_stop : callable
        See `fit_radii`.
    side : array_like of int, shape (n - 2,) or ()
        Position of the via point in each zone, see `ZoneKind`; 0: in its middle.

    Returns
    -------
    CartesianPath
        Through every point.

    Raises
    ------
    InvalidInputError
        If points repeat, the path reverses, or a radius is not positive.
    ConvergenceError
        If no lines were found.

    """
    points, requested, side = _checked(points, radii, side)
    fitted = fit_radii(points, requested, ZoneKind(PolynomialZones.ends, side), should_stop)
    return _path(points, requested, fitted.radii, fitted.lines,
                 PolynomialZones(fitted.lines.angle), side)


def _path(points: Array, requested: Array, radii: Array, lines: Tangents,
          zones: Zones, side: IntArray) -> CartesianPath:
    """Return the path of lines between symmetric zones."""
    T, N = frames(lines.direction[:-1], lines.direction[1:])
    return CartesianPath(points, requested, radii, lines, T, N, zones, side)


def check_points(points: ArrayLike) -> Array:
    """
    Return via points that a path can pass without a stop.

    Parameters
    ----------
    points : array_like, shape (n, 3)
        Via points [m].

    Returns
    -------
    ndarray, shape (n, 3)
        The same, read-only.

    Raises
    ------
    InvalidInputError
        If there are fewer than two, one repeats the one before, or the path reverses.

    """
    points = finite_array('points', points, (-1, 3))
    if len(points) < 2:
        raise InvalidInputError(f'a path needs at least 2 points, not {len(points)}')
    legs = np.diff(points, axis=0)
    lengths = np.linalg.norm(legs, axis=1)
    for i in np.flatnonzero(lengths <= TIP_ROUNDING):
        raise InvalidInputError(
            f'via point {i + 1} repeats via point {i}: {lengths[i]:.3g} m apart', int(i) + 1)
    u = legs / lengths[:, np.newaxis]
    left = 2.0 * np.arctan2(np.linalg.norm(u[1:] + u[:-1], axis=1),
                            np.linalg.norm(u[1:] - u[:-1], axis=1))
    for j in np.flatnonzero(left <= REVERSAL):
        raise InvalidInputError(
            f'via point {j + 1}: the path reverses there, by {np.degrees(np.pi - left[j]):.6f} '
            'deg, and would have to stop', int(j) + 1)
    return points


def _checked(points: ArrayLike, radii: ArrayLike,
             side: ArrayLike) -> tuple[Array, Array, IntArray]:
    """Return via points, and a radius and a side for each interior one."""
    points = check_points(points)
    given = bound_array('radii', radii)
    if given.ndim == 0:
        given = np.full(len(points) - 2, float(given))
    requested = finite_array('radii', given, (len(points) - 2,))
    for j in np.flatnonzero(requested <= 0.0):
        raise InvalidInputError(
            f'via point {j + 1}: radius is {requested[j]:.6g} m, must be positive', int(j) + 1)
    return points, requested, np.broadcast_to(np.asarray(side, dtype=np.intp), requested.shape)
