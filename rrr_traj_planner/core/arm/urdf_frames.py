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

"""The frames of a URDF's links in their parents: fixed, or moving with the arm's joints."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import cos, sin
from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arm.urdf_document import Joint, read_document
from rrr_traj_planner.core.arm.urdf_locked import followed, locked_at, pose_after, unit_axis
from rrr_traj_planner.core.arm.urdf_tree import LinkTree
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.rotations import Quaternion, quaternion, quaternion_product
from rrr_traj_planner.core.states import Triple


class Placement(NamedTuple):
    """Where a frame is in its parent."""

    origin: Triple  # [m]
    turn: Quaternion


@dataclass(frozen=True)
class LinkFrame:
    """
    The frame of a link that is fixed to its parent.

    Parameters
    ----------
    parent, child : str
        Names of the links.
    placement : Placement
        Of the child in the parent.

    """

    parent: str
    child: str
    placement: Placement


@dataclass(frozen=True)
class MovingFrame(LinkFrame):
    """
    The frame of a link that moves with one of the arm's joints, as placed at position zero.

    Parameters
    ----------
    joint : int
        Index of the arm's joint.
    axis : tuple of 3 floats
        The direction in which it turns, of length 1, in the child; zero: it does not turn.
    slide : tuple of 3 floats
        The direction in which it slides, in the parent; zero: it does not slide.
    factor, offset : float
        It turns by factor * q + offset [rad], or slides so far [m]: 1 and 0 for the arm's joints,
        others for joints that mimic them.

    """

    joint: int
    axis: Triple
    slide: Triple
    factor: float = 1.0
    offset: float = 0.0

    def at(self, q: Sequence[float]) -> Placement:
        """
        Return where the frame is.

        Parameters
        ----------
        q : sequence of 3 floats
            The arm's joint positions [rad].

        Returns
        -------
        Placement
            In the parent.

        """
        s = self.factor * q[self.joint] + self.offset
        (x, y, z), (a, b, c), (u, v, w) = self.placement.origin, self.axis, self.slide
        if a == b == c == 0.0:
            return Placement((x + s * u, y + s * v, z + s * w), self.placement.turn)
        sine = sin(0.5 * s)
        return Placement((x, y, z), quaternion_product(
            self.placement.turn, (sine * a, sine * b, sine * c, cos(0.5 * s))))


class UrdfFrames(NamedTuple):
    """The frames of all links but the root."""

    fixed: tuple[LinkFrame, ...]
    moving: tuple[MovingFrame, ...]


def urdf_frames(text: str, joint_names: Sequence[str]) -> UrdfFrames:
    """
    Return the frames of a URDF's links.

    Parameters
    ----------
    text : str
        The URDF.
    joint_names : sequence of str
        The arm's joints; others that move are locked where `locked_poses` locks them, unless they
        mimic one of these.

    Returns
    -------
    UrdfFrames
        In the order of the text.

    Raises
    ------
    InvalidInputError
        If the text is no URDF, its links are no tree, or an axis is zero.

    """
    document = read_document(text)
    tree, fixed, moving = LinkTree(document), [], []
    for joint in document.joints:
        leader, factor, offset = followed(tree, joint)
        if joint.kind != 'fixed' and leader is not None and leader.name in joint_names:
            moving.append(_moving(joint, list(joint_names).index(leader.name), factor, offset))
        else:
            position = 0.0 if joint.kind == 'fixed' else locked_at(tree, joint)
            fixed.append(LinkFrame(joint.parent, joint.child, _placement(joint, position)))
    return UrdfFrames(tuple(fixed), tuple(moving))


def _moving(joint: Joint, number: int, factor: float, offset: float) -> MovingFrame:
    """Return the frame of a joint that moves with one of the arm's."""
    axis, still, slides = unit_axis(joint), np.zeros(3), joint.kind == 'prismatic'
    turn, slide = (still, joint.pose[:3, :3] @ axis) if slides else (axis, still)
    return MovingFrame(joint.parent, joint.child, _placement(joint, 0.0), number, _triple(turn),
                       _triple(slide), factor, offset)


def _placement(joint: Joint, position: float) -> Placement:
    pose = pose_after(joint, np.eye(4), position)
    return Placement(_triple(pose[:3, 3]), quaternion(pose[:3, :3]))


def _triple(values: Array) -> Triple:
    x, y, z = values.tolist()
    return x, y, z
