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
Integration step with friction and bumpers, between events.

The Nyström method of `time_step`; the energy dissipated is integrated with it, to the same order.
"""

from __future__ import annotations

from typing import NamedTuple

from rrr_traj_planner.core.dynamics.arm_dynamics import accelerations, ArmDynamics, Terms
from rrr_traj_planner.core.dynamics.constrained import held
from rrr_traj_planner.core.simulation.joint_stops import Contact, FREE
from rrr_traj_planner.core.simulation.soft_stops import SoftStops
from rrr_traj_planner.core.states import State, Triple


class Load(NamedTuple):
    """Torques and constraints on the joints until the next event."""

    torque: Triple    # constant: motors and disturbance, less Coulomb friction [N m]
    viscous: Triple   # [N m s/rad]
    lock: Contact     # not 0 for each joint held at rest
    sides: Contact    # 1 for each joint in its lower bumper, -1 in its upper one
    edges: Triple     # where those bumpers begin [rad]
    bumper: SoftStops


class Dissipation(NamedTuple):
    """Energy dissipated during a step [J], or the power [W]."""

    viscous: float
    bumpers: float


def rates(load: Load, t: Terms, q: Triple, qd: Triple) -> tuple[Triple, Dissipation]:
    """
    Return accelerations and losses at a state.

    Parameters
    ----------
    load : Load
        What acts on the joints.
    t : Terms
        At the state.
    q, qd : tuple of 3 floats
        Positions [rad] and velocities [rad/s].

    Returns
    -------
    accelerations : tuple of 3 floats
        [rad/s^2].
    losses : Dissipation
        [W].

    """
    (n1, n2, n3), (v1, v2, v3), (qd1, qd2, qd3) = load.torque, load.viscous, qd
    n = (n1 - v1 * qd1, n2 - v2 * qd2, n3 - v3 * qd3)
    lost = 0.0
    if load.sides != FREE:
        pushes = [0.0, 0.0, 0.0]
        for i, side in enumerate(load.sides):
            if side:
                push, heat = load.bumper.push(side * (load.edges[i] - q[i]), -side * qd[i])
                pushes[i] = side * push
                lost += heat
        n = (n[0] + pushes[0], n[1] + pushes[1], n[2] + pushes[2])
    a = accelerations(t, *n)
    if load.lock != FREE:
        a = held(t, a, load.lock)
    return a, Dissipation(v1 * qd1 * qd1 + v2 * qd2 * qd2 + v3 * qd3 * qd3, lost)


def friction_step(arm: ArmDynamics, t: Terms, state: State, load: Load,
                  h: float) -> tuple[State, Dissipation]:
    """
    Return the state after a time step, and the energy dissipated.

    Parameters
    ----------
    arm : ArmDynamics
        The arm.
    t : Terms
        At the state.
    state : tuple of 6 floats
        Positions [rad] and velocities [rad/s]; those of joints that are held must be 0.
    load : Load
        What acts on the joints.
    h : float
        Length of the step [s].

    Returns
    -------
    state : tuple of 6 floats
        Positions [rad] and velocities [rad/s].
    losses : Dissipation
        [J].

    """
    if all(load.lock):
        return state, Dissipation(0.0, 0.0)
    q, qd, half = state[:3], state[3:], 0.5 * h
    a, lost_a = rates(load, t, q, qd)
    middle = _along(q, half, _along(qd, 0.5 * half, a))
    later = _along(qd, half, a)
    b, lost_b = rates(load, arm(middle + later), middle, later)
    later = _along(qd, half, b)
    c, lost_c = rates(load, arm(middle + later), middle, later)
    end, later = _along(q, h, _along(qd, half, c)), _along(qd, h, c)
    d, lost_d = rates(load, arm(end + later), end, later)
    sixth = h / 6.0
    (a1, a2, a3), (b1, b2, b3), (c1, c2, c3), (d1, d2, d3) = a, b, c, d
    mean = _along(qd, sixth, (a1 + b1 + c1, a2 + b2 + c2, a3 + b3 + c3))
    after = _along(q, h, mean) + _along(qd, sixth, (
        a1 + 2.0 * (b1 + c1) + d1, a2 + 2.0 * (b2 + c2) + d2, a3 + 2.0 * (b3 + c3) + d3))
    return after, Dissipation(*(sixth * (l1 + 2.0 * (l2 + l3) + l4)
                                for l1, l2, l3, l4 in zip(lost_a, lost_b, lost_c, lost_d)))


def _along(x: Triple, h: float, rate: Triple) -> Triple:
    return x[0] + h * rate[0], x[1] + h * rate[1], x[2] + h * rate[2]
