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

"""An arm: its chain of joints and links, gravity, the motors' inertia, friction, joint names."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
import os

import numpy as np
from numpy.typing import ArrayLike
from rrr_traj_planner.core.arm.chain import Chain
from rrr_traj_planner.core.arm.friction import Friction
from rrr_traj_planner.core.arm.inertia_check import singular_inertia_reason
from rrr_traj_planner.core.arm.lengths import ArmLengths
from rrr_traj_planner.core.arm.tables import ArmTables, tables_of
from rrr_traj_planner.core.arrays import Array, finite_array
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.read_only import ReadOnlyArrays
from rrr_traj_planner.core.scalars import finite, kind_of, names

JOINT_NAMES = ('joint_1', 'joint_2', 'joint_3')
GRAVITY = 9.81  # m/s^2
GRAVITY_VECTOR = (0.0, 0.0, -GRAVITY)
NO_INERTIA = (0.0, 0.0, 0.0)  # kg m^2


def _default(*values: object) -> Array:
    return field(default_factory=lambda: np.array(values, dtype=float))


@dataclass(frozen=True, eq=False)
class RobotModel(ReadOnlyArrays):
    """
    An arm, leg or finger of three revolute joints.

    The default is the thesis's arm (appendix B). `from_lengths` makes others of its kind,
    `from_urdf` those of other kinds; joint axes 1 and 2 must not be parallel.

    Parameters
    ----------
    chain : Chain
        Joints and links.
    gravity : array_like, shape (3,)
        Acceleration of gravity in the base frame [m/s^2].
    rotor_inertia : array_like, shape (3,)
        Of the motors, reflected to the joints [kg m^2].
    friction : Friction
        Of the joints.
    joint_names : sequence of str
        Three distinct names.

    Raises
    ------
    InvalidInputError
        If a value is not finite or of another kind, a rotor's inertia is negative, or names
        repeat.

    """

    chain: Chain = field(default_factory=ArmLengths().chain)
    gravity: Array = _default(*GRAVITY_VECTOR)
    rotor_inertia: Array = _default(*NO_INERTIA)
    friction: Friction = field(default_factory=Friction)
    joint_names: Sequence[str] = JOINT_NAMES

    def __post_init__(self) -> None:
        """Check every value and make the arrays read-only."""
        kind_of('chain', self.chain, Chain)
        kind_of('friction', self.friction, Friction)
        for name in ('gravity', 'rotor_inertia'):
            object.__setattr__(self, name, finite_array(name, getattr(self, name), (3,)))
        object.__setattr__(self, 'joint_names', names('joint_names', self.joint_names))
        if (self.rotor_inertia < 0.0).any():
            raise InvalidInputError(
                f'rotor_inertia is {self.rotor_inertia.tolist()} kg m^2, must not be negative')
        found = self.joint_names
        if len(found) != 3 or len(set(found)) != 3 or '' in found:
            raise InvalidInputError(f'joint_names is {list(found)}, must be 3 distinct names')
        super().__post_init__()

    @classmethod
    def from_lengths(cls, lengths: ArmLengths, gravity: float = GRAVITY,
                     joint_names: Sequence[str] = JOINT_NAMES) -> RobotModel:
        """
        Return an arm of the thesis's kind.

        Parameters
        ----------
        lengths : ArmLengths
            Lengths, masses and inertias.
        gravity : float
            Acceleration of gravity along -z of the base [m/s^2].
        joint_names : sequence of str
            Three distinct names.

        Returns
        -------
        RobotModel
            The arm.

        Raises
        ------
        InvalidInputError
            If gravity is not finite, names repeat, or a joint has no inertia in some pose.

        """
        down = -finite('gravity', gravity, 'm/s^2')
        model = cls(lengths.chain(), np.array((0.0, 0.0, down)), joint_names=joint_names)
        if model.singular_inertia_reason:
            raise InvalidInputError(model.singular_inertia_reason)
        return model

    @classmethod
    def from_urdf(cls, text_or_path: str | os.PathLike[str], base: str = '', tip: str = '', *,
                  gravity: ArrayLike = GRAVITY_VECTOR, rotor_inertia: ArrayLike = NO_INERTIA
                  ) -> RobotModel:
        """
        Return the arm that a URDF describes.

        The names of the joints and their friction are the URDF's. This is
        `urdf_arm.read_urdf(...).model(...)`; what `read_urdf` returns has limits and warnings too.

        Parameters
        ----------
        text_or_path : str or path
            The URDF, or the path of its file: a text that does not begin with '<'.
        base : str
            Name of the link in whose frame the arm is given; empty: base_link if there is such a
            link, else the root of the tree.
        tip : str
            Name of the link whose origin is the tip; empty: tip if there is such a link below the
            base, else the only leaf below it.
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
            If there is no such file, or it describes no such arm.

        """
        from rrr_traj_planner.core.arm.urdf_arm import read_urdf  # which imports this module
        return read_urdf(text_or_path, base, tip).model(
            gravity=gravity, rotor_inertia=rotor_inertia)

    @cached_property
    def tables(self) -> ArmTables:
        """Coefficients of its kinematics and dynamics."""
        return tables_of(self.chain, self.gravity, self.rotor_inertia)

    @property
    def has_inertia(self) -> bool:
        """Return whether any link has a mass or an inertia, or any motor's rotor."""
        return self.chain.has_masses or bool(self.rotor_inertia.any())

    @cached_property
    def singular_inertia_reason(self) -> str:
        """Return why the inertia matrix is singular in some pose; '' where it never is."""
        if not self.has_inertia:
            return 'no link has a mass'
        return singular_inertia_reason(self.tables.inertia)
