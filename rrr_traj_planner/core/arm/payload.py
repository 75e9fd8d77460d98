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

    The tip is at d4, link 3's centre of mass at l3 along z3 from joint axis 3: together they are a
    link 3 with another mass, centre of mass and inertia (parallel-axis theorem).

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
    m1, m2, m3 = model.mass.tolist()
    l3 = (m3 * model.l3 + mass * model.d4) / (m3 + mass)
    parallel_axis = m3 * (model.l3 - l3) ** 2 + mass * (model.d4 - l3) ** 2
    inertia = model.inertia.copy()
    inertia[2, :2] += parallel_axis
    return replace(model, l3=l3, mass=np.array((m1, m2, m3 + mass)),
                   inertia=inertia)
