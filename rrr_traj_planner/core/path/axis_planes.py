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
Pieces of a path in a plane through joint axis 1, where joint 1 is constant.

There are such pieces only for arms whose tip stays in a plane through that axis while joint 1 is
still (no lateral offset). Azimuths and points are in the frame of joint axis 1 (`AxisFrame`).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array, BoolArray, IntArray
from rrr_traj_planner.core.kinematics.along_path import PathPoints
from rrr_traj_planner.core.kinematics.axis_frame import axis_frame, AxisFrame
from rrr_traj_planner.core.path.cartesian_path import CartesianPath
from rrr_traj_planner.core.rounding import TIP_ROUNDING


class AxisPlanes(NamedTuple):
    """
    The beginning and the end of a path where they lie in a plane through joint axis 1.

    These are: a line that begins or ends on the axis; a whole path whose via points lie in such a
    plane; and lines that the zone beside them does not shift (`zone_sides`).
    """

    frame: AxisFrame
    first: float = 0.0  # azimuth [rad] of the first plane, its positive side the path's
    last: float = 0.0
    before: float = -np.inf  # m along the path: what comes before lies in the first plane
    after: float = np.inf    # m along the path: what comes after lies in the last plane

    def joint_1(self, near: float) -> float:
        """
        Return where joint 1 stands still at the beginning of the path.

        Parameters
        ----------
        near : float
            Its position but for where the tip is on its axis [rad].

        Returns
        -------
        float
            The nearest position with the arm in the first plane, to its front or back [rad]; the
            same where the path does not begin in a plane.

        """
        if self.before <= 0.0:
            return near
        return self.first + np.pi * round((near - self.first) / np.pi)

    def points(self, path: CartesianPath, s: Array, left: bool | BoolArray = False) -> PathPoints:
        """
        Return a path's points, with the planes in which they lie.

        Parameters
        ----------
        path : CartesianPath
            The path.
        s, left
            As when it is called.

        Returns
        -------
        PathPoints
            For the inverse kinematics.

        """
        if self.before == -np.inf and self.after == np.inf:
            return PathPoints(*path(s, left))
        normal = np.full((len(s), 3), np.nan)
        normal[(s < self.before) | (left & (s == self.before))] = self.frame.normal(self.first)
        normal[(s > self.after) | (~np.asarray(left) & (s == self.after))] = (
            self.frame.normal(self.last))
        return PathPoints(*path(s, left), normal)


def axis_planes(model: RobotModel, path: CartesianPath, theta_1: float) -> AxisPlanes:
    """
    Return which parts of a path lie in a plane through joint axis 1.

    Parameters
    ----------
    model : RobotModel
        The arm.
    path : CartesianPath
        The path.
    theta_1 : float
        Position of joint 1 [rad] if all of the path lies on the axis, where any is possible.

    Returns
    -------
    AxisPlanes
        The parts.

    """
    frame = axis_frame(model)
    planes = AxisPlanes(frame)
    if not frame.swings_in_plane:
        return planes
    points = frame.coordinates(path.points)

    def azimuth(s: float) -> float:
        return _azimuth(frame.coordinates(path(s)[0]))

    outward = _common_plane(points)
    if outward is not None:
        of_all = _azimuth(outward) if outward.any() else theta_1
        return AxisPlanes(frame, of_all, of_all, before=np.inf)
    on_axis = np.hypot(*points[[0, -1], :2].T) <= TIP_ROUNDING
    for k in np.flatnonzero(path.side > 0) + 1:
        planes = planes._replace(first=_azimuth(points[k]), before=float(path.via_s[k]))
    for k in np.flatnonzero(path.side < 0) + 1:
        planes = planes._replace(last=_azimuth(points[k]), after=float(path.via_s[k]))
    if not on_axis.any():
        return planes
    before, after = path.zone_ends[0, 0], path.zone_ends[-1, 1]
    if on_axis[0] and before > 0.0 and planes.before < 0.0:
        planes = planes._replace(first=azimuth(before), before=float(before))
    if on_axis[1] and after < path.length and planes.after > path.length:
        planes = planes._replace(last=azimuth(after), after=float(after))
    return planes


def zone_sides(model: RobotModel, tips: Array, started: bool) -> IntArray:
    """
    Return the via points at which a zone must not shift the lines on one side.

    A zone normally shifts both adjacent lines. A leg in a plane through joint axis 1 must not be
    shifted where the tip is on the axis or the start state fixes joint 1 there; its zone is then
    placed on the other side of the via point.

    Parameters
    ----------
    model : RobotModel
        The arm.
    tips : ndarray, shape (n, 3)
        Via points [m].
    started : bool
        Whether the path begins in given joint positions.

    Returns
    -------
    ndarray of int, shape (n - 2,)
        As of `ZoneKind`: 1 at the last via point in the first plane, -1 at the first in the last.

    """
    n, frame = len(tips), axis_frame(model)
    points = frame.coordinates(tips)
    side, on_axis = np.zeros(max(n - 2, 0), dtype=np.intp), np.hypot(
        *points[:, :2].T) <= TIP_ROUNDING
    if not frame.swings_in_plane or not on_axis.any() or _common_plane(points) is not None:
        return side
    last = max((k for k in range(1, n) if _in_half_plane(points[:k + 1])), default=0)
    first = min((k for k in range(n - 1) if _in_half_plane(points[k:])), default=n - 1)
    if on_axis[0 if started else 1:last + 1].any() and not on_axis[last]:
        side[last - 1] = 1
    if on_axis[first:n - 1].any() and not on_axis[first]:
        side[first - 1] = -1
    return side


def _in_half_plane(points: Array) -> bool:
    """Return whether points lie in a half plane bounded by joint axis 1."""
    return _common_plane(points) is not None and not _passes(points)


def _common_plane(points: Array) -> Array | None:
    """
    Return the plane through joint axis 1 in which points lie.

    Parameters
    ----------
    points : ndarray, shape (n, 3)
        Points [m].

    Returns
    -------
    ndarray, shape (2,), or None
        Unit vector in the plane (x, y), towards the first point that is not on the axis, zero
        where all are on it; None where points are in different planes.

    """
    r = np.hypot(points[:, 0], points[:, 1])
    off_axis = r > TIP_ROUNDING
    if not off_axis.any():
        return np.zeros(2)
    outward = np.asarray(points[r.argmax(), :2] / r.max())
    across = points[off_axis, :2] @ (outward[1], -outward[0])
    # A smaller distance from the plane, as a part of the path's extent, is rounding.
    if (np.abs(across) > 1e-12 * np.ptp(points, axis=0).max()).any():
        return None
    return outward if points[off_axis.argmax(), :2] @ outward > 0.0 else -outward


def passes_axis(model: RobotModel, tips: Array) -> bool:
    """
    Return whether a path passes joint axis 1 from one side to the other with joint 1 at rest.

    Parameters
    ----------
    model : RobotModel
        The arm.
    tips : ndarray, shape (n, 3)
        Via points [m].

    Returns
    -------
    bool
        True where all are in a plane through the axis, on both sides of it, in which the arm can
        move the tip with joint 1 at rest.

    """
    frame = axis_frame(model)
    return frame.swings_in_plane and _passes(frame.coordinates(tips))


def _passes(points: Array) -> bool:
    outward = _common_plane(points)
    return outward is not None and bool((points[:, :2] @ outward < -TIP_ROUNDING).any())


def _azimuth(p: Array) -> float:
    return float(np.arctan2(p[1], p[0]))
