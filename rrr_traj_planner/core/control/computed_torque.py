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
Computed-torque control of the arm.

Siciliano et al., Robotics, 2009, section 8.5.2; Lynch and Park, Modern Robotics, 2017, section
11.4.
"""

from __future__ import annotations

from dataclasses import dataclass

from rrr_traj_planner.core.dynamics.arm_dynamics import Terms, torques
from rrr_traj_planner.core.scalars import positive
from rrr_traj_planner.core.states import Desired, State, Triple


@dataclass(frozen=True)
class ControllerGains:
    """
    Gains: the tracking error of every joint is a second-order system.

    Parameters
    ----------
    natural_frequency : float
        wn [rad/s], positive.
    damping_ratio : float
        zeta, positive; 1 is critical.

    Raises
    ------
    InvalidInputError
        If a value is not positive and finite.

    """

    natural_frequency: float = 30.0
    damping_ratio: float = 1.0

    def __post_init__(self) -> None:
        """Check both values."""
        for name, unit in (('natural_frequency', 'rad/s'), ('damping_ratio', '')):
            object.__setattr__(self, name, positive(name, getattr(self, name), unit))

    @property
    def stiffness(self) -> float:
        """Acceleration for a position error: wn^2 [1/s^2]."""
        return self.natural_frequency ** 2

    @property
    def damping(self) -> float:
        """Acceleration for a velocity error: 2 zeta wn [1/s]."""
        return 2.0 * self.damping_ratio * self.natural_frequency


def computed_torque(t: Terms, stiffness: float, damping: float, state: State,
                    desired: Desired) -> Triple:
    """
    Return M (qdd_des + 2 zeta wn ed + wn^2 e) + C qd + g, with e = q_des - q.

    With an exact model the error satisfies edd + 2 zeta wn ed + wn^2 e = 0, without a steady-state
    error under gravity. The result is not saturated (`saturated`).

    Parameters
    ----------
    t : Terms
        At the state.
    stiffness, damping : float
        wn^2 [1/s^2] and 2 zeta wn [1/s].
    state : tuple of 6 floats
        Positions [rad] and velocities [rad/s].
    desired : tuple of 9 floats
        Positions [rad], velocities [rad/s], accelerations [rad/s^2].

    Returns
    -------
    tuple of 3 floats
        Joint torques [N m].

    """
    q1, q2, q3, qd1, qd2, qd3 = state
    p1, p2, p3, v1, v2, v3, a1, a2, a3 = desired
    return torques(t, a1 + damping * (v1 - qd1) + stiffness * (p1 - q1),
                   a2 + damping * (v2 - qd2) + stiffness * (p2 - q2),
                   a3 + damping * (v3 - qd3) + stiffness * (p3 - q3))


def with_friction(torque: Triple, friction: tuple[Triple, Triple], desired: Desired) -> Triple:
    """
    Return torques with those that overcome the friction of the desired motion.

    Parameters
    ----------
    torque : tuple of 3 floats
        Commanded without friction [N m].
    friction : tuple of two tuples of 3 floats
        Viscous [N m s/rad] and Coulomb friction [N m].
    desired : tuple of 9 floats
        As in `computed_torque`.

    Returns
    -------
    tuple of 3 floats
        With viscous qd_des + coulomb sign(qd_des) [N m].

    """
    (n1, n2, n3), ((b1, b2, b3), (c1, c2, c3)) = torque, friction
    v1, v2, v3 = desired[3:6]
    return (n1 + b1 * v1 + c1 * ((v1 > 0.0) - (v1 < 0.0)),
            n2 + b2 * v2 + c2 * ((v2 > 0.0) - (v2 < 0.0)),
            n3 + b3 * v3 + c3 * ((v3 > 0.0) - (v3 < 0.0)))


def saturated(torque: Triple, limit: Triple) -> Triple:
    """
    Return torques saturated at the motors' limits.

    Parameters
    ----------
    torque : tuple of 3 floats
        Commanded [N m].
    limit : tuple of 3 floats
        Largest magnitude of each [N m]; may be infinite.

    Returns
    -------
    tuple of 3 floats
        Torques [N m], each within its limit.

    """
    (tau1, tau2, tau3), (m1, m2, m3) = torque, limit
    if -m1 <= tau1 <= m1 and -m2 <= tau2 <= m2 and -m3 <= tau3 <= m3:
        return torque
    return (min(max(tau1, -m1), m1), min(max(tau2, -m2), m2), min(max(tau3, -m3), m3))
