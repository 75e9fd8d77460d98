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
The arm's physics: forward dynamics in fixed steps, between hard joint stops.

A step that meets a stop is integrated up to the impact, located by bisection, and continued from
the state after it. Friction and bumpers are in `friction_dynamics`.
"""

from __future__ import annotations

from math import copysign

from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.dynamics.arm_dynamics import (
    accelerations,
    ArmDynamics,
    kinetic_energy,
    Terms,
    torques,
)
from rrr_traj_planner.core.dynamics.constrained import held, held_and_stopped, permitted
from rrr_traj_planner.core.simulation.energy import EnergyLedger
from rrr_traj_planner.core.simulation.friction_dynamics import Bounds, FrictionDynamics
from rrr_traj_planner.core.simulation.joint_stops import (
    clipped,
    Contact,
    contact,
    FREE,
    SHORTEST_REBOUND,
    widened,
)
from rrr_traj_planner.core.simulation.saturation_and_contact import SaturationAndContactMonitor
from rrr_traj_planner.core.simulation.soft_stops import SoftStops
from rrr_traj_planner.core.simulation.step_stability import longest_step
from rrr_traj_planner.core.simulation.time_step import Load, TimeStep
from rrr_traj_planner.core.states import State, Triple


class ArmPhysics:
    """
    An arm between its stops: the state after a time step under given torques.

    Parameters
    ----------
    model : RobotModel
        The arm, with the friction of its joints.
    low, high : tuple of 3 floats
        Positions of the stops [rad]; infinite for none.
    soft_stops : SoftStops, optional
        Bumpers, from low and high on outwards; none by default.
    ledger : EnergyLedger, optional
        Receives the losses.
    monitor : SaturationAndContactMonitor, optional
        Receives the contacts with stops.

    Attributes
    ----------
    ledger : EnergyLedger
        The same.
    terms : ArmDynamics
        The terms of the equations of motion at a state.

    """

    def __init__(self, model: RobotModel, low: Triple, high: Triple,
                 soft_stops: SoftStops | None = None, ledger: EnergyLedger | None = None,
                 monitor: SaturationAndContactMonitor | None = None) -> None:
        self.low, self.high, self._monitor = low, high, monitor or SaturationAndContactMonitor()
        self.ledger = EnergyLedger() if ledger is None else ledger
        self._bumper, friction = soft_stops or SoftStops(), model.friction
        self.terms, self._load = ArmDynamics(model), Load()
        self._advanced = TimeStep(model, longest_step(model, self._bumper))
        self._viscous, self._coulomb = friction.viscous.tolist(), friction.coulomb.tolist()
        self._with_friction = None if friction.is_none and not self._bumper.width else (
            FrictionDynamics(self.terms, self._advanced, Bounds(low, high), friction,
                             self._bumper, self.ledger))

    def bumper_energy(self, state: State) -> float:
        """
        Return the energy of the bumpers' springs.

        Parameters
        ----------
        state : tuple of 6 floats
            Positions [rad] and velocities [rad/s].

        Returns
        -------
        float
            [J].

        """
        return self._bumper.energy(state, self.low, self.high)

    def step(self, t: Terms, state: State, torque: Triple, h: float) -> State:
        """
        Return the state after a time step.

        Parameters
        ----------
        t : Terms
            `terms(state)`.
        state : tuple of 6 floats
            Positions [rad] and velocities [rad/s].
        torque : tuple of 3 floats
            Of motors and disturbance [N m], held over the step.
        h : float
            Length of the step [s], positive.

        Returns
        -------
        tuple of 6 floats
            Positions and velocities; no joint further beyond a stop than it was before.

        """
        if self._with_friction is not None:
            after = self._with_friction.step(t, state, torque, h)
            return self._record_contacts(t, state, after, torque, h)
        (l1, l2, l3), (u1, u2, u3) = self.low, self.high
        q1, q2, q3 = state[:3]
        if l1 < q1 < u1 and l2 < q2 < u2 and l3 < q3 < u3:
            after = self._freely(state, torque, h)
            q1, q2, q3 = after[:3]
            if l1 <= q1 <= u1 and l2 <= q2 <= u2 and l3 <= q3 <= u3:
                return after
        after = self._step_with_stops(state, torque, h)
        return self._record_contacts(t, state, after, torque, h)

    def _freely(self, state: State, torque: Triple, h: float, lock: Contact = FREE) -> State:
        """Return the state after a time without impacts, with some joints held at rest."""
        self._load.torque, self._load.lock = torque, lock
        return self._advanced(state, self._load, h)

    def _record_contacts(self, t: Terms, state: State, after: State, torque: Triple,
                         h: float) -> State:
        """Report contacts with stops to the monitor, and return the state after the step."""
        (q1, q2, q3, qd1, qd2, qd3), low, high = state, self.low, self.high
        freely = (q1 + h * qd1, q2 + h * qd2, q3 + h * qd3, qd1, qd2, qd3)
        a, b = contact(after, low, high), contact(freely, low, high)  # b: it may have left again
        if a != FREE or b != FREE:
            at = (a[0] or b[0], a[1] or b[1], a[2] or b[2])
            v1, v2, v3 = after[3:]
            net = torques(t, (v1 - qd1) / h, (v2 - qd2) / h, (v3 - qd3) / h)
            r1, r2, r3 = (
                _beyond(total - own + viscous * v, coulomb) for total, own, v, viscous, coulomb in
                zip(net, torque, after[3:], self._viscous, self._coulomb))
            self._monitor.record_contact(
                at, contact(state, low, high), state[3:], (r1, r2, r3), torque)
        return after

    def _step_with_stops(self, state: State, torque: Triple, h: float) -> State:
        """Return the state after a step with impacts on stops."""
        (low, high), left = widened(state, self.low, self.high), h
        for _ in range(8):  # in a step, chosen; then joints at a stop are held there until its end
            t, at = self.terms(state), contact(state, low, high)
            qd = state[3:]
            state, lock = self._after_impact(t, state, torque, at, SHORTEST_REBOUND * h)
            self._record_impact(t, qd, state[3:])
            taken, state = self._until_impact(state, torque, left, lock, low, high)
            left -= taken
            if left <= 0.0:
                break
        at = contact(state, low, high)
        t = self.terms(state)
        if left > 0.0:
            qd = held(t, state[3:], at)
            self._record_impact(t, state[3:], qd)
            state = state[:3] + qd
            state = clipped(self._freely(state, torque, left, at), low, high)
            t, at = self.terms(state), contact(state, low, high)
        qd = permitted(t, state[3:], at)
        self._record_impact(t, state[3:], qd)
        return state[:3] + qd

    def _after_impact(self, t: Terms, state: State, torque: Triple, at: Contact,
                      shortest: float) -> tuple[State, Contact]:
        """
        Return the state after impacts, and the joints at rest on their stops.

        A joint is at rest if it is pressed into its stop without velocity, or with one so small
        that it would return within the shortest time [s].
        """
        if at == FREE:
            return state, FREE
        qd = qd1, qd2, qd3 = permitted(t, state[3:], at)
        a1, a2, a3 = accelerations(self.terms(state[:3] + qd), *torque)
        s1, s2, s3 = at
        reach = 0.5 * shortest
        slow = (s1 if s1 * qd1 <= -s1 * a1 * reach else 0,
                s2 if s2 * qd2 <= -s2 * a2 * reach else 0,
                s3 if s3 * qd3 <= -s3 * a3 * reach else 0)
        pressed = permitted(t, (a1, a2, a3), slow)
        lock = (s1 if slow[0] and pressed[0] == 0.0 else 0,
                s2 if slow[1] and pressed[1] == 0.0 else 0,
                s3 if slow[2] and pressed[2] == 0.0 else 0)
        qd, lock = held_and_stopped(t, qd, lock, at)
        return state[:3] + qd, lock

    def _record_impact(self, t: Terms, before: Triple, after: Triple) -> None:
        """Record the energy lost in an impact."""
        if after != before:
            self.ledger.stops += kinetic_energy(t, before) - kinetic_energy(t, after)

    def _until_impact(self, state: State, torque: Triple, h: float, lock: Contact,
                      low: Triple, high: Triple) -> tuple[float, State]:
        """Return the time [s] until a joint reaches a stop, or h, and the state then."""
        after = self._freely(state, torque, h, lock)
        if _overshoot(after, low, high) <= 0.0:
            return h, after
        before, taken = 0.0, h
        for _ in range(40):  # 1 ms / 2^40 is 1e-15 s
            middle = 0.5 * (before + taken)
            trial = self._freely(state, torque, middle, lock)
            if _overshoot(trial, low, high) > 0.0:
                taken, after = middle, trial
            else:
                before = middle
        return taken, clipped(after, low, high)


def _beyond(torque: float, friction: float) -> float:
    """Return the part of a torque beyond friction."""
    return copysign(max(abs(torque) - friction, 0.0), torque)


def _overshoot(state: State, low: Triple, high: Triple) -> float:
    """Return the largest distance beyond a stop [rad]; negative if all are inside."""
    return max(max(q - u, d - q) for q, d, u in zip(state, low, high))
