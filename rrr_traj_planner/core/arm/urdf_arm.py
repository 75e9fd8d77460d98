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
from math import inf
import os

import numpy as np
from numpy.typing import ArrayLike
from rrr_traj_planner.core.arm.chain import Chain, UnsupportedChainError
from rrr_traj_planner.core.arm.friction import Friction
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import GRAVITY_VECTOR, NO_INERTIA, RobotModel
from rrr_traj_planner.core.arm.urdf_document import (
    Joint,
    read_document,
    UrdfWarning,
)
from rrr_traj_planner.core.arm.urdf_inertia import (
    body_in_base,
    composite_body,
    without_negative_inertia,
)
from rrr_traj_planner.core.arm.urdf_limits import limits_of
from rrr_traj_planner.core.arm.urdf_locked import locked_poses, MOVING, pose_after, unit_axis
from rrr_traj_planner.core.arm.urdf_tree import LinkTree
from rrr_traj_planner.core.arm.urdf_xml import file_text, is_xml
from rrr_traj_planner.core.arrays import Array, bound_array, finite_array
from rrr_traj_planner.core.errors import counted, InvalidInputError, quoted
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

    def joint_limits(self, max_acceleration: ArrayLike = inf, max_jerk: ArrayLike = inf
                     ) -> JointLimits:
        """
        Return the URDF's limits, with those that no URDF has.

        Parameters
        ----------
        max_acceleration, max_jerk : float or array_like, shape (3,)
            Bounds on the magnitude [rad/s^2, rad/s^3], for all joints or for each; infinite: none.
            Some planners need one on acceleration.

        Returns
        -------
        JointLimits
            Infinite where the URDF has no limit.

        Raises
        ------
        InvalidInputError
            If a bound is not positive.

        """
        return JointLimits(
            self.min_position, self.max_position, self.max_velocity,
            _for_each('max_acceleration', max_acceleration), _for_each('max_jerk', max_jerk),
            self.max_effort)

    def model(self, *, gravity: ArrayLike = GRAVITY_VECTOR, rotor_inertia: ArrayLike = NO_INERTIA
              ) -> RobotModel:
        """
        Return the arm's model: chain, friction and joint names of the URDF.

        Parameters
        ----------
        gravity : array_like, shape (3,)
            Acceleration of gravity in the base link's frame [m/s^2].
        rotor_inertia : array_like, shape (3,)
            Of the motors, reflected to the joints [kg m^2].

        Returns
        -------
        RobotModel
            The arm.

        Raises
        ------
        InvalidInputError
            If gravity or rotor_inertia is not finite, or an inertia is negative.

        """
        return RobotModel(
            self.chain, finite_array('gravity', gravity, (3,)),
            finite_array('rotor_inertia', rotor_inertia, (3,)), self.friction, self.joint_names)


def _for_each(name: str, value: ArrayLike) -> Array:
    """Return a bound for each joint."""
    bound = bound_array(name, value)
    return np.full(3, bound) if bound.ndim == 0 else bound


def read_urdf(text_or_path: str | os.PathLike[str], base: str = '', tip: str = '') -> UrdfArm:
    """
    Read an arm of three revolute joints from a URDF.

    The arm's joints are those that turn on the path from the base to the tip. Joints on side
    branches of its links are locked at zero, and links that are fixed to one another are one body;
    other branches of the base are left out.

    Parameters
    ----------
    text_or_path : str or path
        The URDF, or the path of its file: a text that does not begin with '<'.
    base : str
        Name of the link in whose frame the arm is given; empty: base_link if there is such a link,
        else the root of the tree.
    tip : str
        Name of the link whose origin is the tip; empty: tip if there is such a link below the
        base, else the only leaf below it.

    Returns
    -------
    UrdfArm
        Infinite limits for none; warnings for what was changed.

    Raises
    ------
    InvalidInputError
        If the text is no URDF, there is no such file or link, the path from base to tip has not
        three joints that turn, has joints that move otherwise or mimic others, axes 1 and 2 are
        parallel, the tip is on axis 3, or a range is empty. Names the file, if it is one, and the
        joint or link.

    """
    given = os.fspath(text_or_path) if isinstance(text_or_path, os.PathLike) else text_or_path
    given = checked_text('text_or_path', given)
    base, tip = checked_text('base', base), checked_text('tip', tip)
    if is_xml(given):
        return _read(given.lstrip('\ufeff'), base, tip)
    text = file_text(given)
    try:
        return _read(text, base, tip)
    except InvalidInputError as error:
        raise InvalidInputError(f'{given}: {error}') from None


def _read(text: str, base: str, tip: str) -> UrdfArm:
    document = read_document(text)
    tree, warnings = LinkTree(document), list(document.warnings)
    path = tree.path(base, tip)
    first, second, third = arm = _arm_joints(path)
    limits = [limits_of(joint, warnings) for joint in arm]
    lower, upper, velocity, effort = np.array(limits).T
    return UrdfArm(
        _chain(tree, path, arm, warnings), (first.name, second.name, third.name),
        (first.child, second.child, third.child), lower, upper, velocity, effort, _friction(arm),
        base=path[0].parent, tip=path[-1].child, warnings=tuple(warnings), text=text)


def _arm_joints(path: Sequence[Joint]) -> list[Joint]:
    """Return the joints that turn; refuse any number but three, and other motions."""
    moving = [joint for joint in path if joint.kind != 'fixed']
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


def _chain(tree: LinkTree, path: Sequence[Joint], arm: Sequence[Joint], warnings: list[UrdfWarning]
           ) -> Chain:
    """Return the arm's chain; the masses follow the geometry, with which they are compared."""
    pose, frames, start = np.eye(4), {}, np.eye(4)
    for joint in path:
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
        composite_body([body_in_base(without_negative_inertia(
            tree.links[name], chain.size, warnings), T) for name, T in links], at)
        for links, at in zip(locked_poses(tree, arm, start, warnings), point)]
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
