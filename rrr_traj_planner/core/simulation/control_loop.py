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

"""The control loop: controller, encoders and physics of the arm in fixed steps."""

from __future__ import annotations

from numpy.typing import ArrayLike
from rrr_traj_planner.core.arrays import Array, finite_array
from rrr_traj_planner.core.control.computed_torque import (
    computed_torque,
    saturated,
    with_friction,
)
from rrr_traj_planner.core.dynamics.arm_dynamics import ArmDynamics
from rrr_traj_planner.core.dynamics.rigid_body import kinetic_energy, potential_energy
from rrr_traj_planner.core.nanoseconds import SECOND
from rrr_traj_planner.core.simulation.arm_settings import ArmSettings
from rrr_traj_planner.core.simulation.encoder import Encoder
from rrr_traj_planner.core.simulation.energy import EnergyLedger, work
from rrr_traj_planner.core.simulation.physics import ArmPhysics
from rrr_traj_planner.core.simulation.saturation_and_contact import SaturationAndContactMonitor
from rrr_traj_planner.core.states import Desired, State, Triple
from rrr_traj_planner.core.trajectory.reference_trajectory import ReferenceTrajectory

NO_DISTURBANCE = (0.0, 0.0, 0.0)  # N m


class ControlLoop:
    """
    The simulated arm, its encoders and its controller; time starts at 0.

    Parameters
    ----------
    settings : ArmSettings
        The arm, its limits, its controller.
    q : array_like, shape (3,)
        Initial position, at rest [rad].

    Attributes
    ----------
    settings : ArmSettings
        As given, or as set last.
    steps : int
        Done so far.
    state : tuple of 6 floats
        Positions [rad] and velocities [rad/s].
    torque : tuple of 3 floats
        The motors' torques over the last step [N m].
    disturbance : tuple of 3 floats
        Torques on the joints besides the motors' [N m]; may be set at any time.
    ledger : EnergyLedger
        Work and losses since the position was last set.
    monitor : SaturationAndContactMonitor
        Record of saturation and of contacts with stops.

    """

    def __init__(self, settings: ArmSettings, q: ArrayLike) -> None:
        self.steps, self._step_ns = 0, settings.step_ns
        self.ledger, self.monitor = EnergyLedger(), SaturationAndContactMonitor()
        self.disturbance: Triple = NO_DISTURBANCE
        self.torque: Triple = NO_DISTURBANCE
        self.state: State = (*_triple(finite_array('q', q, (3,))), 0.0, 0.0, 0.0)
        self.apply_settings(settings)
        self._encoder = self._new_encoder()

    @property
    def now(self) -> int:
        """How long the arm has been simulated [ns]."""
        return self.steps * self._step_ns

    @property
    def time(self) -> float:
        """How long the arm has been simulated [s]."""
        return self.now / SECOND

    @property
    def measured(self) -> State:
        """Positions [rad] and velocities [rad/s] as measured by the encoders."""
        return self.state if self._encoder is None else self._encoder.measured

    @property
    def energy(self) -> float:
        """Energy in the arm: motion, height, bumpers' springs [J]."""
        model, state = self.settings.loaded_model, self.state
        return (float(kinetic_energy(model, state[:3], state[3:]) + potential_energy(
            model, state[:3])) + self._physics.bumper_energy(state))

    @property
    def is_ideal(self) -> bool:
        """Whether the controller has an exact model and exact measurements, undisturbed."""
        return self._ideal and self.disturbance == NO_DISTURBANCE

    def set_position(self, q: Array) -> None:
        """
        Set the arm's position, at rest, and reset the energy ledger.

        Parameters
        ----------
        q : ndarray, shape (3,)
            Positions [rad].

        """
        self.state = (*_triple(q), 0.0, 0.0, 0.0)
        if self._encoder is not None:
            self._encoder.restart(self.state)
        self.ledger.clear()

    def apply_settings(self, settings: ArmSettings) -> None:
        """
        Apply settings to the physics and the controller's model.

        Parameters
        ----------
        settings : ArmSettings
            The settings; the encoders do not change (`renew_encoder`).

        """
        self.settings = settings
        low, high = (_triple(x) for x in (
            settings.limits.min_position, settings.limits.max_position))
        self._physics = ArmPhysics(settings.loaded_model, low, high, settings.soft_stops,
                                   self.ledger, self.monitor)
        self._controller_dynamics = ArmDynamics(settings.controller_model)
        friction = settings.model.friction
        self._known_friction = None if not friction.known_to_controller or friction.is_none else (
            _triple(friction.viscous), _triple(friction.coulomb))
        self._max_effort = self.monitor.max_effort = _triple(settings.limits.max_effort)
        self._ideal = settings.encoder.is_ideal and (
            settings.payload.known_to_controller or settings.payload.mass == 0.0)

    def advance_ideal(self, motion: ReferenceTrajectory, steps: int) -> None:
        """
        Simulate several steps of an arm for which `is_ideal` holds.

        Parameters
        ----------
        motion : ReferenceTrajectory
            The reference trajectory.
        steps : int
            Number of steps.

        """
        # The inner loop of nearly every simulation: local names and floats for speed, no NumPy.
        physics, desired, limit = self._physics, motion.elapsed, self._max_effort
        h, gains = self.settings.step, self.settings.gains
        stiffness, damping, record = gains.stiffness, gains.damping, self.monitor.record_saturation
        state, torque, motors, (m1, m2, m3) = self.state, self.torque, 0.0, limit
        step_ns, friction = self._step_ns, self._known_friction
        first = self.steps * step_ns - motion.origin_ns
        for n in range(first, first + steps * step_ns, step_ns):
            t, wanted = physics.terms(state), desired(n, n / 1e9)
            torque = computed_torque(t, stiffness, damping, state, wanted)
            if friction is not None:
                torque = with_friction(torque, friction, wanted)
            n1, n2, n3 = torque
            if not (-m1 <= n1 <= m1 and -m2 <= n2 <= m2 and -m3 <= n3 <= m3):
                record(torque)
                torque = saturated(torque, limit)
            after = physics.step(t, state, torque, h)
            motors += work(torque, state, after)
            state = after
        self.state, self.torque = state, torque
        self.steps += steps
        self.ledger.motors += motors

    def advance_general(self, desired: Desired) -> None:
        """
        Simulate a step of any arm.

        Parameters
        ----------
        desired : tuple of 9 floats
            Positions [rad], velocities [rad/s], accelerations [rad/s^2].

        """
        physics, state = self._physics, self.state
        self.torque = (n1, n2, n3) = self.control(desired)
        d1, d2, d3 = self.disturbance
        after = physics.step(physics.terms(state), state, (n1 + d1, n2 + d2, n3 + d3),
                             self.settings.step)
        self.ledger.motors += work(self.torque, state, after)
        self.ledger.disturbance += work(self.disturbance, state, after)
        self.state = after
        self.steps += 1
        if self._encoder is not None:
            self._encoder.read(after)

    def control(self, desired: Desired) -> Triple:
        """
        Return the torques that the controller commands now, saturated.

        Parameters
        ----------
        desired : tuple of 9 floats
            As `advance_general`.

        Returns
        -------
        tuple of 3 floats
            Within the motors' limits [N m].

        """
        gains, measured = self.settings.gains, self.measured
        t = self._controller_dynamics(measured)
        wanted = computed_torque(t, gains.stiffness, gains.damping, measured, desired)
        if self._known_friction is not None:
            wanted = with_friction(wanted, self._known_friction, desired)
        torque = saturated(wanted, self._max_effort)
        if torque is not wanted:
            self.monitor.record_saturation(wanted)
        return torque

    def renew_encoder(self) -> None:
        """Replace the encoders by those of the settings."""
        self._encoder = self._new_encoder()

    def _new_encoder(self) -> Encoder | None:
        """Return encoders that begin now, or None for ideal ones."""
        settings = self.settings
        return None if settings.encoder.is_ideal else Encoder(
            settings.encoder, settings.step, self.state)


def _triple(values: Array) -> Triple:
    a, b, c = values.tolist()
    return a, b, c
