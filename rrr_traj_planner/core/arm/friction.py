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

"""Viscous and Coulomb friction of the joints."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from rrr_traj_planner.core.arrays import Array, finite_array
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.read_only import ReadOnlyArrays
from rrr_traj_planner.core.scalars import truth

UNITS = {'viscous': 'N m s/rad', 'coulomb': 'N m'}


@dataclass(frozen=True, eq=False)
class Friction(ReadOnlyArrays):
    """
    Friction of the three joints: -viscous qd - coulomb sign(qd) while a joint moves.

    A joint at rest stays at rest while the torque that friction must supply for it is below its
    Coulomb friction.

    Parameters
    ----------
    viscous : array_like, shape (3,)
        [N m s/rad], not negative.
    coulomb : array_like, shape (3,)
        [N m], not negative.
    known_to_controller : bool
        Whether the controller adds the friction of the desired motion.

    Raises
    ------
    InvalidInputError
        If a value is negative, not finite or of another kind.

    """

    viscous: Array = field(default_factory=lambda: np.zeros(3))
    coulomb: Array = field(default_factory=lambda: np.zeros(3))
    known_to_controller: bool = False

    def __post_init__(self) -> None:
        """Check the values and make the arrays read-only."""
        for name, unit in UNITS.items():
            array = finite_array(name, getattr(self, name), (3,))
            object.__setattr__(self, name, array)
            if (array < 0.0).any():
                raise InvalidInputError(
                    f'{name} is {array.tolist()} {unit}, must not be negative')
        object.__setattr__(self, 'known_to_controller', truth(
            'known_to_controller', self.known_to_controller))

    @property
    def is_none(self) -> bool:
        """Whether no joint has any friction."""
        return not (self.viscous.any() or self.coulomb.any())
