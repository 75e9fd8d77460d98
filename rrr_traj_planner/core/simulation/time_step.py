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
Integration step of the simulated arm between events, with friction, bumpers and held joints.

Nyström's method of fourth order for second-order equations (Hairer, Nørsett and Wanner, Solving
Ordinary Differential Equations I, section II.14). Torques are constant over a step (zero-order
hold); the energy dissipated is integrated with it, to the same order.
"""

from __future__ import annotations

import ctypes
from ctypes import c_double, c_int32, c_void_p
from math import inf
from typing import NamedTuple

from rrr_traj_planner.core.arm.compiled_arm import compiled
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.kernels import declared, same_size_as
from rrr_traj_planner.core.states import State, Triple

KERNELS = declared({
    'arm_rates': (None, [c_void_p] * 5),
    'arm_step': (None, [c_void_p, c_void_p, c_double, c_double, *[c_void_p] * 3]),
})


@same_size_as('size_of_load')
class Load(ctypes.Structure):
    """
    Torques and constraints on the joints until the next event, as in native/step.c.

    `torque`: constant, of motors and disturbance, less Coulomb friction [N m]. `viscous`
    [N m s/rad]. `edges`: where the bumpers begin that joints are in [rad]; `sides`: 1 for each
    joint in its lower bumper, -1 in its upper one; `stiffness` [N m/rad], `damping` [s/rad].
    `lock`: not 0 for each joint held at rest.
    """

    _fields_ = [*((name, c_double * 3) for name in ('torque', 'viscous', 'edges')),
                *((name, c_double) for name in ('stiffness', 'damping')),
                *((name, c_int32 * 3) for name in ('lock', 'sides'))]


class Dissipation(NamedTuple):
    """Energy dissipated during a step [J]."""

    viscous: float
    bumpers: float


class TimeStep:
    """
    The integration step of an arm. Not to be called from two threads at once.

    Parameters
    ----------
    model : RobotModel
        The arm.
    longest : float
        [s]; what is asked for is divided into equal steps that are not longer. See
        `step_stability`.

    """

    def __init__(self, model: RobotModel, longest: float = inf) -> None:
        self._arm, self._longest = compiled(model), longest
        self._before, self._after = (c_double * 6)(), (c_double * 6)()
        self._lost = (c_double * 2)()
        self._results = tuple(map(ctypes.addressof, (self._before, self._after, self._lost)))

    def __call__(self, state: State, load: Load, h: float) -> State:
        """
        Return the state after a time; what was dissipated is then in `dissipated`.

        Parameters
        ----------
        state : tuple of 6 floats
            Positions [rad] and velocities [rad/s]; those of joints that are held must be 0.
        load : Load
            What acts on the joints.
        h : float
            [s].

        Returns
        -------
        tuple of 6 floats
            Positions [rad] and velocities [rad/s].

        """
        self._before[:] = state  # type: ignore[call-overload]  # any sequence
        KERNELS.arm_step(self._arm.address, ctypes.addressof(load), h, self._longest,
                         *self._results)
        q1, q2, q3, qd1, qd2, qd3 = self._after
        return q1, q2, q3, qd1, qd2, qd3

    @property
    def dissipated(self) -> Dissipation:
        """Return what the last step dissipated."""
        return Dissipation(*self._lost)

    def accelerations(self, state: State, load: Load) -> Triple:
        """
        Return the accelerations at a state.

        Parameters
        ----------
        state, load
            As when it is called.

        Returns
        -------
        tuple of 3 floats
            [rad/s^2].

        """
        self._before[:] = state  # type: ignore[call-overload]  # any sequence
        before, after, lost = self._results
        KERNELS.arm_rates(self._arm.address, ctypes.addressof(load), before, after, lost)
        a1, a2, a3 = self._after[:3]
        return a1, a2, a3
