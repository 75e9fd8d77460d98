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
Integration step of qdd = f(q, qd), of fourth order.

Nyström's method for second-order equations (Hairer, Nørsett and Wanner, Solving Ordinary
Differential Equations I, section II.14): the two inner stages share one position. Torques are
constant over a step (zero-order hold).
"""

from __future__ import annotations

from rrr_traj_planner.core.dynamics.arm_dynamics import accelerations, ArmDynamics, Terms
from rrr_traj_planner.core.dynamics.constrained import held
from rrr_traj_planner.core.simulation.joint_stops import Contact, FREE
from rrr_traj_planner.core.states import State, Triple


def free_step(arm: ArmDynamics, t: Terms, state: State, torque: Triple, h: float) -> State:
    """
    Return the state after a time step of an arm without stops.

    Parameters
    ----------
    arm : ArmDynamics
        The arm.
    t : Terms
        At the state.
    state : tuple of 6 floats
        Positions [rad] and velocities [rad/s].
    torque : tuple of 3 floats
        Joint torques [N m], held over the step.
    h : float
        Length of the step [s].

    Returns
    -------
    tuple of 6 floats
        Positions [rad] and velocities [rad/s].

    """
    q1, q2, q3, qd1, qd2, qd3 = state
    n1, n2, n3 = torque
    half = 0.5 * h
    eighth = 0.5 * half * half
    a1, a2, a3 = accelerations(t, n1, n2, n3)
    m1, m2, m3 = (q1 + half * qd1 + eighth * a1, q2 + half * qd2 + eighth * a2,
                  q3 + half * qd3 + eighth * a3)
    b1, b2, b3 = accelerations(arm((m1, m2, m3, qd1 + half * a1, qd2 + half * a2,
                                    qd3 + half * a3)), n1, n2, n3)
    c1, c2, c3 = accelerations(arm((m1, m2, m3, qd1 + half * b1, qd2 + half * b2,
                                    qd3 + half * b3)), n1, n2, n3)
    d1, d2, d3 = accelerations(arm((
        q1 + h * (qd1 + half * c1), q2 + h * (qd2 + half * c2), q3 + h * (qd3 + half * c3),
        qd1 + h * c1, qd2 + h * c2, qd3 + h * c3)), n1, n2, n3)
    sixth = h / 6.0
    return (q1 + h * (qd1 + sixth * (a1 + b1 + c1)),
            q2 + h * (qd2 + sixth * (a2 + b2 + c2)),
            q3 + h * (qd3 + sixth * (a3 + b3 + c3)),
            qd1 + sixth * (a1 + 2.0 * (b1 + c1) + d1),
            qd2 + sixth * (a2 + 2.0 * (b2 + c2) + d2),
            qd3 + sixth * (a3 + 2.0 * (b3 + c3) + d3))


def held_step(arm: ArmDynamics, t: Terms, state: State, torque: Triple, h: float,
              lock: Contact) -> State:
    """
    Return the state after a time step in which stops hold some joints at rest.

    The same method as `free_step`, with the held joints' accelerations zero.

    Parameters
    ----------
    arm, t, state, torque, h
        As in `free_step`.
    lock : tuple of 3 ints
        Not 0 for each joint that is held; its velocity must be 0.

    Returns
    -------
    tuple of 6 floats
        Positions [rad] and velocities [rad/s].

    """
    if lock == FREE:
        return free_step(arm, t, state, torque, h)

    def acceleration(at: Terms) -> Triple:
        return held(at, accelerations(at, *torque), lock)

    q, qd = state[:3], state[3:]
    a = acceleration(t)
    middle = _moved(q, qd, a, 0.5 * h)
    b = acceleration(arm(middle + _added(qd, a, 0.5 * h)))
    c = acceleration(arm(middle + _added(qd, b, 0.5 * h)))
    d = acceleration(arm(_moved(q, qd, c, h) + _added(qd, c, h)))
    sixth = h / 6.0
    return _moved(q, qd, _added(_added(a, b, 1.0), c, 1.0), h, sixth) + _added(
        qd, _added(_added(a, d, 1.0), _added(b, c, 1.0), 2.0), sixth)


def _moved(q: Triple, qd: Triple, a: Triple, h: float, factor: float | None = None) -> Triple:
    """Return q + h (qd + factor a); the factor is h / 2 for a constant acceleration."""
    factor = 0.5 * h if factor is None else factor
    return (q[0] + h * (qd[0] + factor * a[0]), q[1] + h * (qd[1] + factor * a[1]),
            q[2] + h * (qd[2] + factor * a[2]))


def _added(x: Triple, y: Triple, factor: float) -> Triple:
    """Return x + factor y."""
    return x[0] + factor * y[0], x[1] + factor * y[1], x[2] + factor * y[2]
