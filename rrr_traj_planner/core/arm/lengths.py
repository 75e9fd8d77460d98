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

"""The thesis's kind of arm by its lengths, masses and inertias (section 5.2, appendix B)."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from rrr_traj_planner.core.arm.chain import Chain
from rrr_traj_planner.core.arrays import Array, finite_array
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.read_only import ReadOnlyArrays
from rrr_traj_planner.core.scalars import finite, positive

LENGTHS = ('d1', 'a2', 'd4', 'l2', 'l3')


def _default(*values: object) -> Array:
    return field(default_factory=lambda: np.array(values, dtype=float))


@dataclass(frozen=True, eq=False)
class ArmLengths(ReadOnlyArrays):
    """
    A vertical joint, then two parallel horizontal ones.

    The defaults are the thesis's arm (appendix B). Frames follow Denavit-Hartenberg as in
    section 5.2; centres of mass lie on joint axis 1, at l2 along x2 from joint axis 2, and at
    l3 along z3 from joint axis 3.

    Parameters
    ----------
    d1 : float
        Height of joint axis 2 above the base [m].
    a2, d4 : float
        Length of the upper arm and of the forearm [m].
    l2, l3 : float
        Distance from joint axis to centre of mass, links 2 and 3 [m].
    mass : array_like, shape (3,)
        Masses of the links [kg].
    inertia : array_like, shape (3, 3)
        A row for each link: Ix, Iy, Iz about its centre of mass, in the axes of its frame
        [kg m^2].

    Raises
    ------
    InvalidInputError
        If a value is not finite, a length a2 or d4 is not positive, or a mass or inertia is
        negative.

    """

    d1: float = 0.5
    a2: float = 0.9
    d4: float = 0.7
    l2: float = 0.5
    l3: float = 0.5
    mass: Array = _default(40.0, 16.0, 12.0)
    inertia: Array = _default((1.5, 0.1, 1.5), (0.12, 0.12, 0.01), (0.12, 0.12, 0.01))

    def __post_init__(self) -> None:
        """Check every value and make the arrays read-only."""
        for name in LENGTHS:
            object.__setattr__(self, name, finite(name, getattr(self, name), 'm'))
        object.__setattr__(self, 'mass', finite_array('mass', self.mass, (3,)))
        object.__setattr__(self, 'inertia', finite_array('inertia', self.inertia, (3, 3)))
        for name in ('a2', 'd4'):
            positive(name, getattr(self, name), 'm')
        for name in ('mass', 'inertia'):
            if (getattr(self, name) < 0.0).any():
                raise InvalidInputError(f'{name} is {getattr(self, name)}, must not be negative')
        for name, mass, length in (('l2', self.mass[1], self.l2), ('l3', self.mass[2], self.l3)):
            with np.errstate(over='ignore'):
                moment = mass * np.square(length)
            if not np.isfinite(moment):
                raise InvalidInputError(
                    f'{name} is {length} m: the inertia of {mass} kg there is not finite')

    def chain(self) -> Chain:
        """
        Return joints and links, in the base frame with all joints at zero.

        Returns
        -------
        Chain
            Joint axis 1 is the base's z axis; the arm lies in the plane of x and z, the upper arm
            along x and the forearm downwards.

        """
        elbow = np.array((self.a2, 0.0, self.d1))
        shoulder = np.array((0.0, 0.0, self.d1))
        (I1, I2, I3), down = self.inertia, np.array((0.0, 0.0, -1.0))
        return Chain(
            axis=np.array(((0.0, 0.0, 1.0), (0.0, -1.0, 0.0), (0.0, -1.0, 0.0))),
            point=np.array((shoulder, shoulder, elbow)), tip=elbow + self.d4 * down,
            mass=self.mass, centre=np.array((
                shoulder, shoulder + (self.l2, 0.0, 0.0), elbow + self.l3 * down)),
            inertia=np.array((np.diag(I1[[0, 2, 1]]), np.diag(I2[[0, 2, 1]]), np.diag(I3))))
