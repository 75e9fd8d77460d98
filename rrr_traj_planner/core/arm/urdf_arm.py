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

"""An arm of three revolute joints, read from a URDF."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
import os
from pathlib import Path

import numpy as np
from rrr_traj_planner.core.arm.chain import Chain, UnsupportedChainError
from rrr_traj_planner.core.arm.friction import Friction
from rrr_traj_planner.core.arm.urdf_document import (
    BEFORE_XML,
    Joint,
    read_document,
    UrdfWarning,
)
from rrr_traj_planner.core.arm.urdf_inertia import lumped, mended, placed
from rrr_traj_planner.core.arm.urdf_limits import limits_of
from rrr_traj_planner.core.arm.urdf_locked import locked_poses, MOVING, pose_after, unit_axis
from rrr_traj_planner.core.arm.urdf_tree import LinkTree
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.errors import counted, InvalidInputError, quoted, shown
from rrr_traj_planner.core.read_only import ReadOnlyArrays
from rrr_traj_planner.core.scalars import text as checked_text


@dataclass(frozen=True, eq=False)
class UrdfArm(ReadOnlyArrays):
    """
    What a URDF says of an arm.

    Attributes
    ----------
    chain : Chain
        Axes, tip and masses, in the frame of the base link with all joints at zero.
    joint_names : tuple of str
        The three joints, from the base.
    link_names : tuple of str
        The link after each of them.
    min_position, max_position : ndarray, shape (3,)
        Ranges [rad]; infinite where there is none.
    max_velocity, max_effort : ndarray, shape (3,)
        Limits [rad/s, N m]; infinite where there is none.
    friction : Friction
        Damping as viscous, friction as Coulomb friction.
    base, tip : str
        The links between which the arm is.
    warnings : tuple of UrdfWarning
        What is odd, and what was made of it.
    text : str
        The URDF.

    """

    chain: Chain
    joint_names: tuple[str, str, str]
    link_names: tuple[str, str, str]
    min_position: Array
    max_position: Array
    max_velocity: Array
    max_effort: Array
    friction: Friction
    base: str
    tip: str
    warnings: tuple[UrdfWarning, ...]
    text: str

    @property
    def has_masses(self) -> bool:
        """Return whether any link has a mass or an inertia."""
        return self.chain.has_masses


def read_urdf(text_or_path: str | os.PathLike[str], base: str = '', tip: str = '') -> UrdfArm:
    """
    Read an arm of three revolute joints from a URDF.

    The arm's joints are those that turn on the way from the base to the tip. What hangs from its
    links is lumped to them, joints locked; what hangs from the base otherwise is left out.

    Parameters
    ----------
    text_or_path : str or path
        The URDF, or the path of its file: a text that does not begin with '<'.
    base : str
        Name of the link in whose frame the arm is given; empty: the root of the tree.
    tip : str
        Name of the link whose origin is the tip; empty: the only leaf below the base.

    Returns
    -------
    UrdfArm
        Infinite limits for none; warnings for what was mended.

    Raises
    ------
    InvalidInputError
        If the text is no URDF, there is no such file or link, the way from base to tip has not
        three joints that turn, has joints that move otherwise or mimic others, axes 1 and 2 are
        parallel, the tip is on axis 3, or a range is empty. Names the file, if it is one, and the
        joint or link.

    """
    given = os.fspath(text_or_path) if isinstance(text_or_path, os.PathLike) else text_or_path
    given = checked_text('text_or_path', given)
    base, tip = checked_text('base', base), checked_text('tip', tip)
    if given.lstrip(BEFORE_XML).startswith('<'):
        return _read(given.lstrip('\ufeff'), base, tip)
    text = _content(given)
    try:
        return _read(text, base, tip)
    except InvalidInputError as error:
        raise InvalidInputError(f'{given}: {error}') from None


def _content(path: str) -> str:
    """Return a file's text."""
    if not path.strip():
        raise InvalidInputError("the URDF is empty, must be its text or a file's path")
    try:
        return Path(path).read_text(encoding='utf-8-sig')
    except (OSError, ValueError) as error:  # no such file, a folder, a null character, no UTF-8
        why = error.strerror if isinstance(error, OSError) else str(error)
        raise InvalidInputError(
            f"{shown(path)} is neither a URDF, whose text begins with '<', nor a file that can be "
            f'read: {why}') from None


def _read(text: str, base: str, tip: str) -> UrdfArm:
    document = read_document(text)
    tree, warnings = LinkTree(document), list(document.warnings)
    way = tree.way(base, tip)
    first, second, third = arm = _arm_joints(way)
    limits = [limits_of(joint, warnings) for joint in arm]
    lower, upper, velocity, effort = np.array(limits).T
    return UrdfArm(
        _chain(tree, way, arm, warnings), (first.name, second.name, third.name),
        (first.child, second.child, third.child), lower, upper, velocity, effort, _friction(arm),
        base=way[0].parent, tip=way[-1].child, warnings=tuple(warnings), text=text)


def _arm_joints(way: Sequence[Joint]) -> list[Joint]:
    """Return the joints that turn; refuse any number but three, and other motions."""
    moving = [joint for joint in way if joint.kind != 'fixed']
    for joint in moving:
        if joint.kind not in MOVING:
            raise InvalidInputError(f'{joint.label}, between base and tip, is {joint.kind}: must '
                                    'be revolute, continuous or fixed')
        if joint.mimic is not None:
            raise InvalidInputError(f'{joint.label}, between base and tip, mimics '
                                    f'{quoted(joint.mimic[0])}: must move by itself')
    if len(moving) != 3:
        named = ': ' + ', '.join(quoted(joint.name) for joint in moving) if moving else ''
        raise InvalidInputError(f'{counted(len(moving), "joint")} between base and tip can turn'
                                f'{named}; must be 3')
    return moving


def _friction(arm: Sequence[Joint]) -> Friction:
    for joint in arm:
        for name, unit in (('damping', 'N m s/rad'), ('friction', 'N m')):
            if getattr(joint, name) < 0.0:
                raise InvalidInputError(f'{joint.label}: {name} is {getattr(joint, name):g} '
                                        f'{unit}, must not be negative')
    return Friction(np.array([joint.damping for joint in arm]),
                    np.array([joint.friction for joint in arm]))


def _chain(tree: LinkTree, way: Sequence[Joint], arm: Sequence[Joint], warnings: list[UrdfWarning]
           ) -> Chain:
    """Return the arm's chain; the masses follow the geometry, with which they are compared."""
    pose, frames, start = np.eye(4), {}, np.eye(4)
    for joint in way:
        if joint is arm[0]:
            start = pose
        pose = pose_after(joint, pose)
        frames[joint.name] = pose
    axis = np.array([frames[joint.name][:3, :3] @ unit_axis(joint) for joint in arm])
    point, nothing = np.array([frames[joint.name][:3, 3] for joint in arm]), np.zeros((3, 3, 3))
    try:
        chain = Chain(axis, point, pose[:3, 3], np.zeros(3), point, nothing)
    except UnsupportedChainError as error:
        raise error.named([joint.name for joint in arm]) from None
    bodies = [
        lumped([placed(mended(tree.links[name], chain.size, warnings), T) for name, T in links],
               at) for links, at in zip(locked_poses(tree, arm, start, warnings), point)]
    mass, centre, inertia = map(np.array, zip(*bodies))
    _warn_of_no_mass(arm, mass, inertia, warnings)
    return replace(chain, mass=mass, centre=centre, inertia=inertia)


def _warn_of_no_mass(arm: Sequence[Joint], mass: Array, inertia: Array, warnings: list[UrdfWarning]
                     ) -> None:
    empty = [quoted(joint.child) for joint, m, tensor in zip(arm, mass, inertia)
             if m == 0.0 and not tensor.any()]
    if len(empty) == 3:
        warnings.append(UrdfWarning('no link has a mass'))
    elif empty:
        warnings.append(UrdfWarning(
            f'{counted(len(empty), "link")} without mass: {", ".join(empty)}'))
