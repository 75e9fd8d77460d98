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
A chain of three revolute joints: its axes, its tip and the masses of its links.

Everything is given in the base frame with all joints at zero (product of exponentials: Lynch and
Park, Modern Robotics, 2017, section 4.1), so that no convention for the links' frames is needed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from rrr_traj_planner.core.arrays import Array, finite_array
from rrr_traj_planner.core.errors import InvalidInputError, quoted
from rrr_traj_planner.core.read_only import ReadOnlyArrays
from rrr_traj_planner.core.rotations import rotation

# Sine of the angle between joint axes 1 and 2 up to which they count as parallel: descriptions
# from CAD are rounded to 1e-4 rad at worst.
PARALLEL = 1e-3

# Distance of the tip from joint axis 3, over the arm's size, up to which it counts as on the axis:
# rounding of descriptions. Chosen.
ON_AXIS = 1e-6

# Part of an inertia tensor up to which it may be asymmetric, or a principal moment negative:
# rounding of descriptions with seven digits. Chosen.
INERTIA_TOLERANCE = 1e-6


class UnsupportedChainError(InvalidInputError):
    """
    A chain of a kind that is not planned for.

    Parameters
    ----------
    template : str
        Message, with {} for each joint.
    joints : tuple of int
        The joints at fault, from 1.

    """

    def __init__(self, template: str, joints: tuple[int, ...]) -> None:
        super().__init__(template.format(*joints))
        self.template = template
        self.joints = joints

    def named(self, joint_names: Sequence[str]) -> InvalidInputError:
        """
        Return the same error with names in place of numbers.

        Parameters
        ----------
        joint_names : sequence of str
            Of the three joints.

        Returns
        -------
        InvalidInputError
            To be raised.

        """
        return InvalidInputError(
            self.template.format(*(quoted(joint_names[joint - 1]) for joint in self.joints)))


@dataclass(frozen=True, eq=False)
class Chain(ReadOnlyArrays):
    """
    Three revolute joints in series, and their links.

    All vectors are in the base frame with the joints at zero.

    Parameters
    ----------
    axis : array_like, shape (3, 3)
        A row for each joint: direction of its axis, normalised here.
    point : array_like, shape (3, 3)
        A point of each joint's axis [m].
    tip : array_like, shape (3,)
        Position of the tip, fixed to link 3 [m].
    mass : array_like, shape (3,)
        Masses of the links [kg].
    centre : array_like, shape (3, 3)
        Their centres of mass [m].
    inertia : array_like, shape (3, 3, 3)
        Their inertia tensors about their centres of mass [kg m^2].

    Raises
    ------
    InvalidInputError
        If a value is not finite, an axis is zero, a mass is negative, or an inertia tensor is not
        symmetric or has a negative principal moment.
    UnsupportedChainError
        If joint axes 1 and 2 are parallel, or the tip cannot leave a surface: it lies on joint
        axis 3, joint axes 2 and 3 are one line, or all three meet in one point.

    """

    axis: Array
    point: Array
    tip: Array
    mass: Array
    centre: Array
    inertia: Array

    def __post_init__(self) -> None:
        """Check the values, normalise the axes and make the arrays read-only."""
        for name, shape in (('axis', (3, 3)), ('point', (3, 3)), ('tip', (3,)), ('mass', (3,)),
                            ('centre', (3, 3)), ('inertia', (3, 3, 3))):
            object.__setattr__(self, name, finite_array(name, getattr(self, name), shape))
        length = np.linalg.norm(self.axis, axis=1)
        if (length == 0.0).any():
            raise InvalidInputError(f'axis of joint {int(length.argmin()) + 1} is zero')
        object.__setattr__(self, 'axis', self.axis / length[:, np.newaxis])
        super().__post_init__()
        self._check_geometry()
        self._check_inertia()

    def _check_geometry(self) -> None:
        """
        Refuse parallel first axes, and arms whose Jacobian is singular in every pose.

        It is s r Q' / 2 + a k' y (`core.kinematics.branch_factors`). Q' is zero in every pose if
        the tip is on joint axis 3, or the foot of the common normal of joint axes 1 and 2 is; then
        the rest is zero too if these meet (a = 0), or if joint axes 2 and 3 are parallel (k' = 0).
        """
        across = np.cross(self.axis[0], self.axis[1])
        s = float(np.linalg.norm(across))
        if s < PARALLEL:
            raise UnsupportedChainError(
                'joint axes {} and {} are parallel: planar and SCARA-like arms are not supported',
                (1, 2))
        lever = np.linalg.norm(np.cross(self.axis[2], self.tip - self.point[2]))
        if lever <= ON_AXIS * self.size:
            raise UnsupportedChainError(
                'the tip is on joint axis {}, which does not move it', (3,))
        between = self.point[1] - self.point[0]
        foot = self.point[1] + self.axis[1] * (np.cross(between, self.axis[0]) @ across / s ** 2)
        nothing = ON_AXIS * self.size
        if np.linalg.norm(np.cross(self.axis[2], foot - self.point[2])) > nothing:
            return
        if np.linalg.norm(np.cross(self.axis[1], self.axis[2])) <= ON_AXIS:
            raise UnsupportedChainError(
                'joint axes {} and {} are one line: the tip moves on a surface', (2, 3))
        if abs(between @ across / s) <= nothing:
            raise UnsupportedChainError(
                'joint axes {}, {} and {} meet in one point: the tip moves on a sphere', (1, 2, 3))

    def _check_inertia(self) -> None:
        """Refuse negative masses and tensors that no body has even without regard to its shape."""
        if (self.mass < 0.0).any():
            raise InvalidInputError(f'mass is {self.mass.tolist()} kg, must not be negative')
        for i, tensor in enumerate(self.inertia, 1):
            size = np.abs(tensor).max(initial=0.0)
            if np.abs(tensor - tensor.T).max() > INERTIA_TOLERANCE * size:
                raise InvalidInputError(f'inertia of link {i} is not symmetric')
            if np.linalg.eigvalsh(tensor)[0] < -INERTIA_TOLERANCE * size:
                raise InvalidInputError(f'inertia of link {i} has a negative principal moment')

    @property
    def has_masses(self) -> bool:
        """Return whether any link has a mass or an inertia."""
        return bool(self.mass.any() or self.inertia.any())

    @cached_property
    def size(self) -> float:
        """Upper bound on the tip's distance from joint axis 1 [m], for tolerances."""
        steps = np.diff(np.vstack((self.point, self.tip)), axis=0)
        return float(np.linalg.norm(steps, axis=1).sum())

    def link_poses(self, q: Array) -> list[tuple[Array, Array]]:
        """
        Return where the links are, as motions from where they are with all joints at zero.

        Parameters
        ----------
        q : ndarray, shape (..., 3)
            Joint positions [rad].

        Returns
        -------
        list of three tuples of ndarray
            Of each link, rotation R (..., 3, 3) and translation t (..., 3) [m]: what was at x is
            at R x + t.

        """
        R, t, poses = np.eye(3), np.zeros(3), []
        for j in range(3):
            turn = rotation(self.axis[j], q[..., j])
            centred = self.point[j] - turn @ self.point[j]
            t = t + np.asarray((R @ centred[..., np.newaxis])[..., 0])
            R = R @ turn
            poses.append((R, t))
        return poses

    def axes_at(self, poses: list[tuple[Array, Array]]) -> tuple[Array, Array]:
        """
        Return the joints' axes at given poses of the links.

        Parameters
        ----------
        poses : list of tuples
            As returned by `link_poses`.

        Returns
        -------
        tuple of ndarray, shape (..., 3, 3)
            A row for each joint: its direction, and a point of it [m].

        """
        moved = [(np.broadcast_to(self.axis[0], poses[0][1].shape),
                  np.broadcast_to(self.point[0], poses[0][1].shape))]
        moved += [(R @ axis, R @ point + t)
                  for (R, t), axis, point in zip(poses, self.axis[1:], self.point[1:])]
        directions, points = zip(*moved)
        return np.stack(directions, axis=-2), np.stack(points, axis=-2)
