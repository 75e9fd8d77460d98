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

"""The payload: a point mass at the tip, added to the inertial parameters of link 3."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.scalars import not_negative, truth


@dataclass(frozen=True)
class Payload:
    """
    A point mass at the tip.

    Parameters
    ----------
    mass : float
        [kg], not negative.
    known_to_controller : bool
        Whether the controller's model has it too.

    Raises
    ------
    InvalidInputError
        If the mass is negative or not finite, or a value of another kind.

    """

    mass: float = 0.0
    known_to_controller: bool = False

    def __post_init__(self) -> None:
        """Check the values."""
        object.__setattr__(self, 'mass', not_negative('mass', self.mass, 'kg'))
        object.__setattr__(self, 'known_to_controller', truth(
            'known_to_controller', self.known_to_controller))


def with_payload(model: RobotModel, mass: float) -> RobotModel:
    """
    Return the arm with a point mass at its tip.

    Link 3 and the point mass are one body, with another mass, centre of mass and inertia
    (parallel-axis theorem).

    Parameters
    ----------
    model : RobotModel
        The bare arm.
    mass : float
        At the tip [kg].

    Returns
    -------
    RobotModel
        The same object if the mass is 0.

    Raises
    ------
    InvalidInputError
        If the mass is negative or not finite.

    """
    mass = not_negative('mass', mass, 'kg')
    if mass == 0.0:
        return model
    chain = model.chain
    both = chain.mass[2] + mass
    lever = chain.tip - chain.centre[2]
    reduced = chain.mass[2] * mass / both
    inertia = chain.inertia.copy()
    inertia[2] += reduced * (lever @ lever * np.eye(3) - np.outer(lever, lever))
    masses, centre = chain.mass.copy(), chain.centre.copy()
    masses[2], centre[2] = both, chain.centre[2] + mass / both * lever
    return replace(model, chain=replace(chain, mass=masses, centre=centre, inertia=inertia))
