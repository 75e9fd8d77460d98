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
Zone radii under a bound on the deviation from the polyline: half of each leg at most, or maximal.

Our own method: the deviation is modelled as a power of the radius, and radii are corrected until
the deviation is at its bound.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import ArrayLike
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.cancellation import never, ShouldStop
from rrr_traj_planner.core.errors import ConvergenceError
from rrr_traj_planner.core.path.cartesian_path import CartesianPath
from rrr_traj_planner.core.path.design import check_points
from rrr_traj_planner.core.scalars import positive

Family = Callable[[Array, ArrayLike], CartesianPath]

MOST_LENGTHS = 10.0  # largest radius over the polyline's length, for slight turns; chosen
GROWTH_ROUNDS = 30   # in which radii may grow; then as many in which they only shrink. Chosen
TOLERANCE = 1e-4     # relative, by which the deviation may stay below its bound; chosen


def largest_radii(family: Family, points: ArrayLike, max_deviation: float,
                  should_stop: ShouldStop = never) -> CartesianPath:
    """
    Return the path with the largest radii under a bound on the deviation at every point.

    Parameters
    ----------
    family : callable
        `line_arc` or `line_polynomial`.
    points : array_like, shape (n, 3)
        Via points [m].
    max_deviation : float
        Largest distance between path and polyline [m].
    should_stop : callable
        Polled in every round; after True, radii are only reduced as far as feasibility requires.

    Returns
    -------
    CartesianPath
        Its `radii` are the largest; its `deviation` is at the bound unless a neighbouring zone
        or MOST_LENGTHS limits the radius.

    Raises
    ------
    InvalidInputError
        If the deviation is not positive, or no path passes the points without a stop.
    ConvergenceError
        If the radii were not found.

    """
    *_, path = paths_within(family, points, max_deviation, should_stop)
    return path


def paths_within(family: Family, points: ArrayLike, max_deviation: float,
                 should_stop: ShouldStop = never) -> Iterator[CartesianPath]:
    """
    Return paths under a bound on the deviation at every point.

    Zones of the largest radii compete for the legs: a large one may leave its neighbours little.
    The fastest motion is often along a path whose zones take half of each leg at most.

    Parameters
    ----------
    family, points, max_deviation, should_stop
        As of `largest_radii`.

    Returns
    -------
    iterator of CartesianPath
        Where zones compete, the path whose zones take half of each leg at most; then that of
        `largest_radii`.

    Raises
    ------
    InvalidInputError, ConvergenceError
        As `largest_radii`.

    """
    points = check_points(points)
    max_deviation = positive('max_deviation', max_deviation, 'm')
    legs = np.diff(points, axis=0)
    lengths = np.linalg.norm(legs, axis=1)
    u = legs / lengths[:, np.newaxis]
    half = 0.5 * np.linalg.norm(u[1:] - u[:-1], axis=1)  # sine of half the turn
    most = np.full(len(points) - 2, MOST_LENGTHS * lengths.sum())
    # The deviation of an arc between long legs, and half the leg that an arc needs.
    with np.errstate(divide='ignore'):
        radii = np.minimum(max_deviation / (1.0 - np.sqrt(np.maximum(1.0 - half ** 2, 0.0))),
                           np.minimum(lengths[1:], lengths[:-1]) / (2.0 * half))
    return _adjusted(family, points, np.minimum(radii, most), most, max_deviation, should_stop)


def _adjusted(family: Family, points: Array, radii: Array, most: Array, max_deviation: float,
              should_stop: ShouldStop) -> Iterator[CartesianPath]:
    """Yield the first path whose zones compete, then that with the largest radii."""
    power, before, has_competing = np.ones(len(radii)), None, False
    fitting, settled = radii, False
    for round_ in range(2 * GROWTH_ROUNDS):
        path = family(points, radii)
        if before is not None and not settled and should_stop():
            # Growth to these radii was interrupted: continue from the former ones.
            settled, radii = True, fitting
            continue
        power = power if before is None else _power(before, path, power)
        before = path
        # A radius limited by a neighbour can only become smaller.
        most = np.where(path.radii < path.requested_radii, path.radii, most)
        with np.errstate(divide='ignore'):
            factor = max_deviation * (1.0 - 0.5 * TOLERANCE) / path.deviation
        wanted = np.minimum(path.radii * np.clip(factor, 0.5, 2.0) ** (1.0 / power), most)
        within_deviation = path.deviation <= max_deviation
        # Radii of neighbouring zones may oscillate: after GROWTH_ROUNDS they only shrink.
        settled = settled or should_stop() or round_ >= GROWTH_ROUNDS
        if within_deviation.all() and (
                settled or (wanted <= path.radii * (1.0 + TOLERANCE)).all()):
            yield path
            return
        if not has_competing and within_deviation.all() and len(radii) > 1 and len(path.shrunk):
            has_competing = True
            yield path
        fitting = np.where(within_deviation, path.radii, np.minimum(wanted, path.radii))
        radii = fitting if settled else wanted
    raise ConvergenceError(
        f'largest radii not found: deviation is {path.deviation.tolist()} m after '
        f'{2 * GROWTH_ROUNDS} rounds, {max_deviation:.6g} m wanted')


def _power(before: CartesianPath, path: CartesianPath, known: Array) -> Array:
    """Return the exponents of the model deviation ~ radius^p, from two paths."""
    with np.errstate(divide='ignore', invalid='ignore'):
        larger = np.log(path.radii / before.radii)
        found = np.log(path.deviation / before.deviation) / larger
    usable = np.isfinite(found) & (np.abs(larger) > TOLERANCE)
    # Exponents p of the model deviation ~ radius^p are 1 to 4; chosen.
    return np.where(usable, np.clip(found, 1.0, 4.0), known)
