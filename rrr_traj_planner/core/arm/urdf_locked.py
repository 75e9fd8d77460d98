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

"""Where a URDF's links are with all joints at zero; joints on side branches are locked."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from rrr_traj_planner.core.arm.urdf_document import Joint, UrdfWarning
from rrr_traj_planner.core.arm.urdf_tree import LinkTree
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.errors import InvalidInputError, quoted
from rrr_traj_planner.core.rotations import rotation

MOVING = ('revolute', 'continuous')
UNITS = {'prismatic': 'm'}  # of positions; others: rad


def pose_after(joint: Joint, pose: Array, position: float = 0.0) -> Array:
    """
    Return the pose of a joint's child.

    Parameters
    ----------
    joint : Joint
        Of any kind; one that floats or moves in a plane is at zero.
    pose : ndarray, shape (4, 4)
        Of its parent in the base frame.
    position : float
        The joint's position [rad, or m].

    Returns
    -------
    ndarray, shape (4, 4)
        Of its child in the base frame.

    Raises
    ------
    InvalidInputError
        If the axis is zero, and the joint is not at zero.

    """
    pose = pose @ joint.pose
    if position == 0.0:
        return np.asarray(pose)
    axis, motion = unit_axis(joint), np.eye(4)
    if joint.kind == 'prismatic':
        motion[:3, 3] = position * axis
    else:
        motion[:3, :3] = rotation(axis, position)
    return np.asarray(pose @ motion)


def unit_axis(joint: Joint) -> Array:
    """
    Return the direction of a joint's axis, in its own frame.

    Parameters
    ----------
    joint : Joint
        A joint that moves.

    Returns
    -------
    ndarray, shape (3,)
        Of length 1.

    Raises
    ------
    InvalidInputError
        If the axis is zero.

    """
    length = np.linalg.norm(joint.axis)
    if length == 0.0:
        raise InvalidInputError(f'{joint.label}: its axis is zero, must have a direction')
    return np.asarray(joint.axis / length)


def locked_poses(tree: LinkTree, arm: Sequence[Joint], pose: Array, warnings: list[UrdfWarning]
                 ) -> list[list[tuple[str, Array]]]:
    """
    Return what moves with each of the arm's joints.

    Parameters
    ----------
    tree : LinkTree
        All links.
    arm : sequence of Joint
        The arm's three joints, from the base; they are at zero.
    pose : ndarray, shape (4, 4)
        Of the first one's parent in the base frame.
    warnings : list of UrdfWarning
        Gets one that names the joints that are locked, and one for each that mimics another that
        is not.

    Returns
    -------
    list of list of tuple
        For each joint the links that move with it, but not with a later one, and their poses in
        the base frame. Joints between them are locked at zero, or at the end of their range that
        is nearest to it.

    Raises
    ------
    InvalidInputError
        If the range of a locked joint is empty, or an axis zero.

    """
    numbers = {joint.name: i for i, joint in enumerate(arm)}
    first = pose_after(arm[0], pose)
    found: list[list[tuple[str, Array]]] = [[(arm[0].child, first)], [], []]
    place, texts = {arm[0].child: (0, first)}, []
    for joint in tree.subtree(arm[0].child):
        body, above = place[joint.parent]
        position = 0.0
        if joint.name not in numbers and joint.kind != 'fixed':
            position = locked_at(tree, joint, tuple(numbers), warnings)
            texts.append(f'{quoted(joint.name)} at {position:g} {UNITS.get(joint.kind, "rad")}')
        body = numbers.get(joint.name, body)
        place[joint.child] = body, pose_after(joint, above, position)
        found[body].append((joint.child, place[joint.child][1]))
    if texts:
        warnings.append(UrdfWarning(
            f'joints on side branches are locked: {", ".join(texts)}'))
    return found


def locked_at(tree: LinkTree, joint: Joint, arm: Sequence[str] = (),
              warnings: list[UrdfWarning] | None = None) -> float:
    """
    Return where a joint that is none of the arm's is locked.

    Parameters
    ----------
    tree : LinkTree
        All links.
    joint : Joint
        One that moves. If it mimics a locked joint, it follows it.
    arm : sequence of str
        The arm's joints, which are not locked.
    warnings : list of UrdfWarning, optional
        Gets one if the joint mimics one that it does not follow.

    Returns
    -------
    float
        Zero, or the end of its range that is nearest to it [rad, or m].

    Raises
    ------
    InvalidInputError
        If the range is empty.

    """
    leader, factor, offset = followed(tree, joint)
    if leader is not None and leader.name not in arm:
        return factor * _rest(leader) + offset
    if warnings is not None and joint.mimic is not None:
        warnings.append(UrdfWarning(
            f'{joint.label}, on a side branch, mimics {quoted(joint.mimic[0])}, which it does not '
            'follow here: the inertia is not exact'))
    return _rest(joint)


def followed(tree: LinkTree, joint: Joint) -> tuple[Joint | None, float, float]:
    """
    Return which joint another one mimics, in the end.

    Parameters
    ----------
    tree : LinkTree
        All links.
    joint : Joint
        A joint.

    Returns
    -------
    leader : Joint or None
        The joint itself if it mimics none; None if a joint is not there, or mimics itself.
    factor, offset : float
        The joint's position is factor * leader's position + offset [rad, or m].

    """
    factor, offset, seen = 1.0, 0.0, [joint]
    while (mimic := seen[-1].mimic) is not None:
        other = tree.joints.get(mimic[0])
        if other is None or any(other is joint for joint in seen):
            return None, factor, offset
        factor, offset = factor * mimic[1], offset + factor * mimic[2]
        seen.append(other)
    return seen[-1], factor, offset


def _rest(joint: Joint) -> float:
    """Return the position nearest to zero."""
    if joint.kind not in ('revolute', 'prismatic') or joint.position_range is None:
        return 0.0
    lower, upper = joint.position_range
    if lower > upper:
        raise InvalidInputError(f'{joint.label}: lower is {lower:g}, must not be above upper, '
                                f'{upper:g}')
    return min(max(0.0, lower), upper)
