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

"""Joint positions from tip positions: both elbow branches, wrapped into the joints' ranges."""

from __future__ import annotations

from math import atan2, ceil, cos, hypot, pi, sin, sqrt
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike
from rrr_traj_planner.core.arrays import Array, finite_array
from rrr_traj_planner.core.errors import InvalidInputError, UnreachableError
from rrr_traj_planner.core.limits import JointLimits
from rrr_traj_planner.core.model import RobotModel

Elbow = Literal['up', 'down']
ELBOWS: tuple[Elbow, Elbow] = ('up', 'down')

# A point that misses the workspace by no more than rounding of its coordinates is on its edge.
EDGE_TOLERANCE = 1e-9  # m

# A joint this close to an end of its range is at that end: a via point taught there must not be
# refused for the rounding of its coordinates.
RANGE_TOLERANCE = 1e-9  # rad


def inverse_kinematics(model: RobotModel, position: ArrayLike, elbow: Elbow = 'up',
                       previous: ArrayLike | None = None) -> Array:
    """
    Return joint positions that bring the tip to a point (5.8-5.12 corrected).

    On joint axis 1, where any theta_1 will do, theta_1 keeps its previous value, or is 0
    without one.

    Parameters
    ----------
    model : RobotModel
        The arm.
    position : array_like, shape (3,)
        Tip position in the base frame [m].
    elbow : {'up', 'down'}
        Branch: theta_3 = gamma - 90 deg, or 270 deg - gamma.
    previous : array_like, shape (3,), optional
        Joint positions [rad] of the point before.

    Returns
    -------
    ndarray, shape (3,)
        Joint positions [rad], each in (-pi, pi] but for theta_3, in [-pi/2, 3 pi/2].

    Raises
    ------
    InvalidInputError
        If the position is malformed or the elbow unknown.
    UnreachableError
        If the point is outside the workspace; with the distance by which it misses.

    """
    x, y, z = finite_array('position', position, (3,)).tolist()
    if elbow not in ELBOWS:
        raise InvalidInputError(f"elbow is '{elbow}', must be 'up' or 'down'")
    a2, d4 = model.a2, model.d4
    r, h = hypot(x, y), z - model.d1
    on_axis = r <= EDGE_TOLERANCE
    if on_axis:
        theta_1 = 0.0 if previous is None else float(finite_array('previous', previous, (3,))[0])
    else:
        theta_1 = _wrapped(atan2(y, x))
    W = _distance_in_reach(model, (x, y, z), hypot(r, h))
    # Half-angle and tangent forms of 5.9 and 5.11: exact to rounding at the workspace's edges too.
    least, most = model.reach
    gamma = 2.0 * atan2(sqrt((W - least) * (W + least)), sqrt((most - W) * (most + W)))
    lift = atan2(d4 * sin(gamma), a2 - d4 * cos(gamma))
    if elbow == 'up':
        return np.array([theta_1, _wrapped(atan2(h, r) + lift), gamma - pi / 2])
    return np.array([theta_1, _wrapped(atan2(h, r) - lift), 1.5 * pi - gamma])


def wrap_into_limits(q: ArrayLike, limits: JointLimits,
                     previous: ArrayLike | None = None) -> Array:
    """
    Return the same pose with whole turns added so that each joint is in its range.

    Parameters
    ----------
    q : array_like, shape (3,)
        Joint positions [rad].
    limits : JointLimits
        The ranges.
    previous : array_like, shape (3,), optional
        Where several turns fit, the one nearest to this is taken; without it, the one of
        least magnitude.

    Returns
    -------
    ndarray, shape (3,)
        Joint positions [rad]; a joint that fits with no whole turn is left as near to its
        range as turns bring it.

    """
    q = np.asarray(q, dtype=float)
    near = np.zeros(3) if previous is None else np.asarray(previous, dtype=float)
    turn = 2.0 * pi
    wanted = np.round((near - q) / turn)
    low, high = limits.min_position, limits.max_position
    least, most = np.ceil((low - q - RANGE_TOLERANCE) / turn), np.floor(
        (high - q + RANGE_TOLERANCE) / turn)
    fits = least <= most
    turns = np.where(fits, np.clip(wanted, least, most), _nearest_turn(q, low, high))
    wrapped: Array = q + turn * turns
    inside = (wrapped >= low - RANGE_TOLERANCE) & (wrapped <= high + RANGE_TOLERANCE)
    return np.where(inside, np.clip(wrapped, low, high), wrapped)


def _nearest_turn(q: Array, low: Array, high: Array) -> Array:
    """Return the turns that bring a joint that cannot be in its range nearest to it."""
    with np.errstate(invalid='ignore'):  # infinite ends, where every joint fits
        centre = 0.5 * (low + high)
    return np.round((np.where(np.isfinite(centre), centre, q) - q) / (2.0 * pi))


def _distance_in_reach(model: RobotModel, point: tuple[float, float, float], W: float) -> float:
    """Return W, moved onto the workspace's edge where rounding put it outside."""
    least, most = model.reach
    if W > most + EDGE_TOLERANCE or W < least - EDGE_TOLERANCE:
        miss = W - most if W > most else least - W
        side = (f"beyond the arm's reach of {most:.6g} m" if W > most
                else f'nearer than the arm can fold, {least:.6g} m')
        raise UnreachableError(
            f'({point[0]:.6g}, {point[1]:.6g}, {point[2]:.6g}) m is {W:.6g} m from the '
            f'shoulder, {side}: it misses by {miss:.6g} m', distance=miss)
    return min(max(W, least), most)


def _wrapped(angle: float) -> float:
    """Return the angle in (-pi, pi]."""
    return angle - 2.0 * pi * ceil((angle - pi) / (2.0 * pi))


def elbow_of(q: Array) -> Elbow:
    """
    Return the branch that a pose is on.

    Parameters
    ----------
    q : ndarray, shape (3,)
        Joint positions [rad].

    Returns
    -------
    {'up', 'down'}
        By the sign of cos theta_3 (5.10): up where theta_3 is within a right angle of 0.

    """
    return 'up' if np.cos(q[2]) >= 0.0 else 'down'
