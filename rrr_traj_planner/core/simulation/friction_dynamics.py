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
Dynamics with friction, bumpers and hard stops: event-driven time steps of a hybrid system.

Between events no joint starts or stops sliding, reaches a hard stop, or meets or leaves its
bumper, so that the motion is smooth (event-driven schemes: Acary and Brogliato, Numerical Methods
for Nonsmooth Dynamical Systems, 2008). Events are located to 1e-12 rad or rad/s; friction and
stops together then determine which joints rest (`stiction`). A resting joint breaks loose only at
the start of a step: up to a step late, without an error of energy, since nothing moves.
"""

from __future__ import annotations

from math import inf
from typing import NamedTuple

from rrr_traj_planner.core.arm.friction import Friction
from rrr_traj_planner.core.dynamics.arm_dynamics import ArmDynamics, kinetic_energy, Terms
from rrr_traj_planner.core.dynamics.constrained import (
    held_and_stopped,
    permitted,
    Range,
    rates_with_reactions,
)
from rrr_traj_planner.core.simulation.energy import EnergyLedger
from rrr_traj_planner.core.simulation.joint_stops import (
    clipped,
    Contact,
    contact,
    FREE,
    SHORTEST_REBOUND,
    widened,
)
from rrr_traj_planner.core.simulation.root_finding import EVENT_TOLERANCE, locate_event
from rrr_traj_planner.core.simulation.soft_stops import SoftStops
from rrr_traj_planner.core.simulation.time_step import Dissipation, Load, TimeStep
from rrr_traj_planner.core.states import State, Triple


class Bounds(NamedTuple):
    """Ends of the joints' ranges [rad]."""

    low: Triple
    high: Triple


class FrictionDynamics:
    """
    Time stepping of an arm with friction and bumpers.

    Parameters
    ----------
    arm : ArmDynamics
        The arm's terms at a state.
    advanced : TimeStep
        Its integration step.
    bounds : Bounds
        Ends of the joints' ranges: hard stops, or where bumpers begin [rad].
    friction : Friction
        Of the joints.
    bumper : SoftStops
        Of all joints.
    ledger : EnergyLedger
        Receives the losses.

    """

    def __init__(self, arm: ArmDynamics, advanced: TimeStep, bounds: Bounds, friction: Friction,
                 bumper: SoftStops, ledger: EnergyLedger) -> None:
        self._arm, self._advanced, self._ledger = arm, advanced, ledger
        self._low, self._high = bounds
        self._bumper = bumper
        c1, c2, c3 = friction.coulomb.tolist()
        self._coulomb = c1, c2, c3
        self._reused = Load((0.0,) * 3, tuple(friction.viscous.tolist()), self._low,
                            bumper.stiffness, bumper.damping, FREE, FREE)

    def step(self, t: Terms, state: State, torque: Triple, h: float) -> State:
        """
        Return the state after a time step.

        Parameters
        ----------
        t : Terms
            The arm's terms at the state.
        state : tuple of 6 floats
            Positions [rad] and velocities [rad/s].
        torque : tuple of 3 floats
            Of motors and disturbance [N m], held over the step.
        h : float
            Length of the step [s].

        Returns
        -------
        tuple of 6 floats
            Positions and velocities.

        """
        hard, left = Bounds(*widened(state, self._low, self._high, self._bumper.width)), h
        # Events of a step, chosen; then joints in contact or at rest stay so until its end.
        for _ in range(16):
            state, load, slip = self._after_impacts(t, state, torque, hard, SHORTEST_REBOUND * h)
            taken, state = self._until_event(state, load, slip, left, hard)
            left -= taken
            if left <= 0.0:
                break
            t = self._arm(state)
        if left > 0.0:
            state = self._step_with_joints_locked(state, torque, left, hard)
        qd, at = state[3:], contact(state, *hard)
        if at != FREE:
            qd = self._velocities_after_impact(self._arm(state), qd, at)
        return state[:3] + _at_rest(qd, self._coulomb)

    def _velocities_after_impact(self, t: Terms, qd: Triple, at: Contact) -> Triple:
        """Return the velocities after impacts on hard stops, and record the energy lost."""
        after = permitted(t, qd, at)
        self._ledger.stops += kinetic_energy(t, qd) - kinetic_energy(t, after)
        return after

    def _after_impacts(self, t: Terms, state: State, torque: Triple, hard: Bounds,
                       shortest: float) -> tuple[State, Load, Contact]:
        """Return the state after impacts, the load from there on, and the sliding directions."""
        at, qd = contact(state, *hard), _at_rest(state[3:], self._coulomb)
        if at == FREE and 0.0 not in qd:
            slip = _signs(qd, self._coulomb)
            return state[:3] + qd, self._load(state, torque, slip), slip
        if at != FREE:
            qd = _at_rest(self._velocities_after_impact(t, state[3:], at), self._coulomb)
        (qd1, qd2, qd3), (c1, c2, c3) = qd, self._coulomb
        q, lock = state[:3], FREE
        slip = _signs(qd, self._coulomb)
        load = self._load(state, torque, slip)
        if at != FREE or 0.0 in qd:
            x = self._advanced.accelerations(q + qd, load)
            ranges = (_range(c1, qd1, x[0], at[0], shortest),
                      _range(c2, qd2, x[1], at[1], shortest),
                      _range(c3, qd3, x[2], at[2], shortest))
            a = rates_with_reactions(t, x, ranges)
            lock = (_locked(a[0], ranges[0]), _locked(a[1], ranges[1]), _locked(a[2], ranges[2]))
            qd, lock = self._brought_to_rest(t, qd, lock, at)
            slip = _signs((qd[0] or a[0], qd[1] or a[1], qd[2] or a[2]), self._coulomb)
            load = self._load(state, torque, slip, lock)
        return q + qd, load, slip

    def _brought_to_rest(self, t: Terms, qd: Triple, lock: Contact,
                         at: Contact) -> tuple[Triple, Contact]:
        """Return velocities with the joints that rest at rest, and those joints."""
        after, lock = held_and_stopped(t, qd, lock, at)
        if after != qd:
            self._ledger.stops += kinetic_energy(t, qd) - kinetic_energy(t, after)
        return after, lock

    def _load(self, state: State, torque: Triple, slip: Contact, lock: Contact = FREE) -> Load:
        """Return torques, friction and bumpers for sliding directions; until the next call."""
        (c1, c2, c3), (s1, s2, s3), (n1, n2, n3) = self._coulomb, slip, torque
        load = self._reused
        load.torque = n1 - c1 * s1, n2 - c2 * s2, n3 - c3 * s3
        load.lock = lock
        if self._bumper.width:
            load.sides = sides = self._bumper.sides(state, self._low, self._high)
            load.edges = tuple(low if side > 0 else high for side, low, high in zip(
                sides, self._low, self._high))
        return load

    def _until_event(self, state: State, load: Load, slip: Contact, h: float,
                     hard: Bounds) -> tuple[float, State]:
        """Return the time of the next event, or h, and the state then."""
        def trial(x: float) -> tuple[State, Dissipation]:
            return self._advanced(state, load, x), self._advanced.dissipated

        taken, (after, lost) = h, trial(h)
        margin = self._margin(after, load, slip, hard)
        if margin < 0.0:
            first = max(self._margin(state, load, slip, hard), 0.0)
            taken, (after, lost) = locate_event(
                trial, lambda s: self._margin(s[0], load, slip, hard), first, h, margin)
        self._record_losses(lost, slip, state, after)
        return taken, clipped(after, *hard)

    def _margin(self, state: State, load: Load, slip: Contact, hard: Bounds) -> float:
        """Return the distance to the next event [rad], [rad/s]; negative past it."""
        margin = min(s * qd if s else inf for s, qd in zip(slip, state[3:]))
        for i, q in enumerate(state[:3]):
            if load.lock[i]:
                continue
            margin = min(margin, q - hard.low[i], hard.high[i] - q)
            if self._bumper.width:
                side = load.sides[i]
                if side:
                    margin = min(margin, side * (load.edges[i] - q))
                else:
                    margin = min(margin, q - self._low[i], self._high[i] - q)
        return margin

    def _step_with_joints_locked(self, state: State, torque: Triple, h: float,
                                 hard: Bounds) -> State:
        """Return the state after a time in which joints in contact or at rest are locked."""
        at = contact(state, *hard)
        c, qd = self._coulomb, state[3:]
        lock = (int(at[0] or c[0] and abs(qd[0]) <= EVENT_TOLERANCE),
                int(at[1] or c[1] and abs(qd[1]) <= EVENT_TOLERANCE),
                int(at[2] or c[2] and abs(qd[2]) <= EVENT_TOLERANCE))
        before = state[:3] + self._brought_to_rest(self._arm(state), qd, lock, FREE)[0]
        slip = _signs(before[3:], c)
        after = self._advanced(before, self._load(before, torque, slip, lock), h)
        self._record_losses(self._advanced.dissipated, slip, before, after)
        return clipped(after, *hard)

    def _record_losses(self, lost: Dissipation, slip: Contact, before: State,
                       after: State) -> None:
        """Record the energy lost over an interval of motion."""
        (c1, c2, c3), (s1, s2, s3), ledger = self._coulomb, slip, self._ledger
        ledger.viscous += lost.viscous
        ledger.stops += lost.bumpers
        ledger.coulomb += (c1 * s1 * (after[0] - before[0]) + c2 * s2 * (after[1] - before[1])
                           + c3 * s3 * (after[2] - before[2]))


def _at_rest(qd: Triple, coulomb: Triple) -> Triple:
    """Return velocities; of joints with friction, those below EVENT_TOLERANCE are set to 0."""
    (qd1, qd2, qd3), (c1, c2, c3) = qd, coulomb
    return (0.0 if c1 and -EVENT_TOLERANCE <= qd1 <= EVENT_TOLERANCE else qd1,
            0.0 if c2 and -EVENT_TOLERANCE <= qd2 <= EVENT_TOLERANCE else qd2,
            0.0 if c3 and -EVENT_TOLERANCE <= qd3 <= EVENT_TOLERANCE else qd3)


def _range(coulomb: float, qd: float, x: float, side: int, shortest: float) -> Range:
    """Return the least and the largest torque that friction and a hard stop can exert [N m]."""
    friction = coulomb if qd == 0.0 else 0.0
    if qd != 0.0 and side * qd > -side * x * 0.5 * shortest:  # it is leaving its stop
        side = 0
    return (-inf if side < 0 else -friction, inf if side > 0 else friction)


def _locked(a: float, limits: Range) -> int:
    return int(a == 0.0 and limits[0] < limits[1])


def _signs(qd: Triple, coulomb: Triple) -> Contact:
    """Return the directions in which joints with Coulomb friction slide."""
    return ((qd[0] > 0.0) - (qd[0] < 0.0) if coulomb[0] else 0,
            (qd[1] > 0.0) - (qd[1] < 0.0) if coulomb[1] else 0,
            (qd[2] > 0.0) - (qd[2] < 0.0) if coulomb[2] else 0)
