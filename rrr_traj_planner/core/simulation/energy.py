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

"""Energy balance of the arm: work and losses."""

from __future__ import annotations

from dataclasses import dataclass, fields

from rrr_traj_planner.core.states import Triple


@dataclass
class EnergyLedger:
    """
    Work done on the arm, and energy dissipated, since the last `clear` [J].

    The energy in the arm (motion, height, bumpers' springs) changes by `supplied - dissipated`.

    Parameters
    ----------
    motors, disturbance : float
        Work of the motors and of the disturbance.
    payload : float
        Net energy brought by changes of the arm itself (payload, bumpers).
    viscous, coulomb : float
        Lost in friction.
    stops : float
        Lost in impacts on hard stops and in bumpers.

    """

    motors: float = 0.0
    disturbance: float = 0.0
    payload: float = 0.0
    viscous: float = 0.0
    coulomb: float = 0.0
    stops: float = 0.0

    @property
    def supplied(self) -> float:
        """Total energy supplied."""
        return self.motors + self.disturbance + self.payload

    @property
    def dissipated(self) -> float:
        """Total energy dissipated."""
        return self.viscous + self.coulomb + self.stops

    def clear(self) -> None:
        """Set all entries to zero."""
        for entry in fields(self):
            setattr(self, entry.name, 0.0)


def work(torque: Triple, before: tuple[float, ...], after: tuple[float, ...]) -> float:
    """
    Return the work of constant torques.

    Parameters
    ----------
    torque : tuple of 3 floats
        [N m].
    before, after : tuple of floats
        States, or positions [rad].

    Returns
    -------
    float
        [J], exact.

    """
    return (torque[0] * (after[0] - before[0]) + torque[1] * (after[1] - before[1])
            + torque[2] * (after[2] - before[2]))
