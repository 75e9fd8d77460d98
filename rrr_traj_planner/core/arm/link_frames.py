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

"""Frames at an arm's joints and tip, and the lines along which its links are drawn."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arm.chain import Chain
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.rotations import rotation_z_to


class Frame(NamedTuple):
    """A frame in the base frame, all joints at zero."""

    R: Array   # its axes in columns, shape (3, 3)
    at: Array  # its origin [m], (3,)

    def inside(self, point: Array) -> Array:
        """
        Return a point's coordinates in this frame.

        Parameters
        ----------
        point : ndarray, shape (3,)
            In the base frame [m].

        Returns
        -------
        ndarray, shape (3,)
            In this frame [m].

        """
        return np.asarray(self.R.T @ (point - self.at))


class JointPoint(NamedTuple):
    """A joint's point, in the base frame with all joints at zero."""

    link: int  # that carries it: 0 for the base, 1 or 2
    at: Array  # [m], shape (3,)


class Line(NamedTuple):
    """A straight part of a drawn link, in the base frame with all joints at zero."""

    link: int     # 0 for the base, 1 to 3
    start: Array  # [m], shape (3,)
    end: Array    # [m], (3,)


def link_frames(chain: Chain) -> list[Frame]:
    """
    Return the frames of base, joints and tip.

    A joint's frame has its z axis along the joint's, the tip's along the line from the last
    joint's point; they are the base's frame, turned the shortest way (from the opposite
    direction: by half a turn about x). So the thesis's arm has its frames of section 5.2, without
    the constant transform that follows a joint's rotation there.

    Parameters
    ----------
    chain : Chain
        The arm's joints.

    Returns
    -------
    list of five Frames
        Joint 1's is in the base's origin if its axis passes through it; the others' are in the
        joints' points.

    """
    first = np.zeros(3) if _first_link(chain) == 1 else chain.point[0]
    origins = (first, chain.point[1], chain.point[2], chain.tip)
    axes = (*chain.axis, _direction(chain.point[2], chain.tip))
    return [Frame(np.eye(3), np.zeros(3)),
            *(Frame(rotation_z_to(axis), at) for axis, at in zip(axes, origins))]


def joint_points(chain: Chain) -> list[JointPoint]:
    """
    Return the joints' points, each fixed to a link.

    Parameters
    ----------
    chain : Chain
        The arm's joints.

    Returns
    -------
    list of JointPoint
        Where two joints have the same point, the last one's only.

    """
    carriers = (_first_link(chain), 1, 2)
    points = [JointPoint(link, at) for link, at in zip(carriers, chain.point)]
    return [a for a, b in zip(points, points[1:]) if (a.at != b.at).any()] + points[-1:]


def link_lines(chain: Chain) -> list[Line]:
    """
    Return the lines along which links are drawn.

    From the base's origin they pass through the joints' points to the tip, each fixed to a link.

    Parameters
    ----------
    chain : Chain
        The arm's joints.

    Returns
    -------
    list of Lines
        Of some length each.

    """
    points = (np.zeros(3), *chain.point, chain.tip)
    lines = [Line(link, a, b)
             for link, a, b in zip((_first_link(chain), 1, 2, 3), points, points[1:])]
    return [line for line in lines if (line.start != line.end).any()]


def _first_link(chain: Chain) -> int:
    """Return 1 if joint axis 1 passes through the base's origin, so that it is of link 1 too."""
    return 0 if np.cross(chain.axis[0], chain.point[0]).any() else 1


def _direction(start: Array, end: Array) -> Array:
    return np.asarray((end - start) / np.linalg.norm(end - start))
