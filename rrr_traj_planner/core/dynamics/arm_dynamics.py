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
Dynamics at one state as floats, for the simulation's inner loop and the controller.

tau = M(q) qdd + b(q, qd), where b is the torque of velocity and gravity.
"""

from __future__ import annotations

import ctypes
from typing import NamedTuple

from rrr_traj_planner.core.arm.compiled_arm import compiled, KERNELS
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.states import State, Triple


class Terms(NamedTuple):
    """The terms of the equations of motion at a state."""

    M11: float  # elements of the inertia matrix [kg m^2]
    M12: float
    M13: float
    M22: float
    M23: float
    M33: float
    b1: float   # Coriolis, centrifugal and gravity torques [N m]
    b2: float
    b3: float


class ArmDynamics:
    """
    The terms of an arm's equations of motion as a function of the state.

    Not to be called from two threads at once.

    Parameters
    ----------
    model : RobotModel
        The arm.

    """

    def __init__(self, model: RobotModel) -> None:
        self._arm, self._kernel = compiled(model), KERNELS.arm_inertia_and_bias
        self._state, self._terms = (ctypes.c_double * 6)(), (ctypes.c_double * 9)()
        size = ctypes.sizeof(ctypes.c_double)
        state, terms = map(ctypes.addressof, (self._state, self._terms))
        self._arguments = (
            self._arm.address, 1, state, state + 3 * size, terms, terms + 6 * size)

    def __call__(self, state: State) -> Terms:
        """
        Return the terms at a state.

        Parameters
        ----------
        state : tuple of 6 floats
            Positions [rad] and velocities [rad/s].

        Returns
        -------
        Terms
            There.

        """
        self._state[:] = state  # type: ignore[call-overload]  # any sequence
        self._kernel(*self._arguments)
        return Terms(*self._terms)


def torques(t: Terms, a1: float, a2: float, a3: float) -> Triple:
    """
    Return the joint torques of accelerations: inverse dynamics.

    Parameters
    ----------
    t : Terms
        At the state.
    a1, a2, a3 : float
        Accelerations of the joints [rad/s^2].

    Returns
    -------
    tuple of 3 floats
        [N m].

    """
    M11, M12, M13, M22, M23, M33, b1, b2, b3 = t
    return (M11 * a1 + M12 * a2 + M13 * a3 + b1, M12 * a1 + M22 * a2 + M23 * a3 + b2,
            M13 * a1 + M23 * a2 + M33 * a3 + b3)


def accelerations(t: Terms, n1: float, n2: float, n3: float) -> Triple:
    """
    Return the accelerations that torques cause: forward dynamics.

    Parameters
    ----------
    t : Terms
        At the state.
    n1, n2, n3 : float
        Torques on the joints [N m].

    Returns
    -------
    tuple of 3 floats
        [rad/s^2].

    """
    return solved(t, n1 - t.b1, n2 - t.b2, n3 - t.b3)


def solved(t: Terms, n1: float, n2: float, n3: float) -> Triple:
    """
    Return the changes of rates that torques or impulses cause: n divided by M.

    Parameters
    ----------
    t : Terms
        At the position.
    n1, n2, n3 : float
        On the joints [N m], [N m s].

    Returns
    -------
    tuple of 3 floats
        [rad/s^2], [rad/s].

    """
    M11, M12, M13, M22, M23, M33 = t[:6]
    C11, C12, C13 = M22 * M33 - M23 * M23, M13 * M23 - M12 * M33, M12 * M23 - M13 * M22
    C22, C23, C33 = M11 * M33 - M13 * M13, M12 * M13 - M11 * M23, M11 * M22 - M12 * M12
    det = M11 * C11 + M12 * C12 + M13 * C13
    return ((C11 * n1 + C12 * n2 + C13 * n3) / det, (C12 * n1 + C22 * n2 + C23 * n3) / det,
            (C13 * n1 + C23 * n2 + C33 * n3) / det)


def kinetic_energy(t: Terms, qd: Triple) -> float:
    """
    Return the kinetic energy.

    Parameters
    ----------
    t : Terms
        At the position.
    qd : tuple of 3 floats
        Joint velocities [rad/s].

    Returns
    -------
    float
        [J].

    """
    v1, v2, v3 = qd
    return (0.5 * (t.M11 * v1 * v1 + t.M22 * v2 * v2 + t.M33 * v3 * v3)
            + t.M12 * v1 * v2 + t.M13 * v1 * v3 + t.M23 * v2 * v3)
