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
Soft joint stops: bumpers between the end of a joint's range and its hard stop.

A bumper compressed by x reacts with k x (1 + lambda xd) (Hunt and Crossley, ASME J. Applied
Mechanics 42, 1975): the torque is continuous at contact, and a bumper never pulls.
"""

from __future__ import annotations

import ctypes
from dataclasses import dataclass

from rrr_traj_planner.core.kernels import declared
from rrr_traj_planner.core.scalars import not_negative
from rrr_traj_planner.core.simulation.joint_stops import Contact
from rrr_traj_planner.core.states import State, Triple

KERNELS = declared({'bumper_torque': (ctypes.c_double, [*[ctypes.c_double] * 4, ctypes.c_void_p])})


@dataclass(frozen=True)
class SoftStops:
    """
    The bumpers of all joints; without a width there are none, and ranges end at hard stops.

    Parameters
    ----------
    width : float
        From the end of the range to the hard stop behind it [rad].
    stiffness : float
        k [N m/rad].
    damping : float
        lambda [s/rad].

    Raises
    ------
    InvalidInputError
        If a value is negative or not finite.

    """

    width: float = 0.0
    stiffness: float = 0.0
    damping: float = 0.0

    def __post_init__(self) -> None:
        """Check the values."""
        for name, unit in (('width', 'rad'), ('stiffness', 'N m/rad'), ('damping', 's/rad')):
            object.__setattr__(self, name, not_negative(name, getattr(self, name), unit))

    def sides(self, state: State, low: Triple, high: Triple) -> Contact:
        """
        Return the joints that compress their bumpers.

        Parameters
        ----------
        state : tuple of 6 floats
            Positions [rad] and velocities [rad/s].
        low, high : tuple of 3 floats
            Where the bumpers begin [rad].

        Returns
        -------
        tuple of 3 ints
            1 for the lower bumper, -1 for the upper one, 0 between.

        """
        if self.width == 0.0:
            return 0, 0, 0
        q1, q2, q3 = state[:3]
        return ((q1 < low[0]) - (q1 > high[0]), (q2 < low[1]) - (q2 > high[1]),
                (q3 < low[2]) - (q3 > high[2]))

    def push(self, depth: float, rate: float) -> tuple[float, float]:
        """
        Return the reaction of a compressed bumper.

        Parameters
        ----------
        depth : float
            x, its compression [rad].
        rate : float
            xd [rad/s].

        Returns
        -------
        torque : float
            Outwards [N m].
        dissipated : float
            Power dissipated [W].

        """
        dissipated = ctypes.c_double()
        torque = KERNELS.bumper_torque(self.stiffness, self.damping, depth, rate,
                                       ctypes.byref(dissipated))
        return torque, dissipated.value

    def energy(self, state: State, low: Triple, high: Triple) -> float:
        """
        Return the energy of the bumpers' springs.

        Parameters
        ----------
        state : tuple of 6 floats
            Positions [rad] and velocities [rad/s].
        low, high : tuple of 3 floats
            Where the bumpers begin [rad].

        Returns
        -------
        float
            [J].

        """
        if self.width == 0.0:
            return 0.0
        depths = (max(a - q, q - b, 0.0) for q, a, b in zip(state, low, high))
        return 0.5 * self.stiffness * sum(x * x for x in depths)
