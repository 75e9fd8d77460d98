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

"""The arm at work: a motion to follow, the controller that follows it, the physics that obeys."""

from __future__ import annotations

from numpy.typing import ArrayLike
from rrr_traj_planner.core.arrays import Array, finite_array
from rrr_traj_planner.core.control.computed_torque import computed_torque, saturated
from rrr_traj_planner.core.control.replacement import replacement, Takeover
from rrr_traj_planner.core.dynamics.rigid_body import kinetic_energy, potential_energy
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.nanoseconds import SECOND
from rrr_traj_planner.core.simulation.arm_settings import ArmSettings
from rrr_traj_planner.core.simulation.condition import ConditionMonitor
from rrr_traj_planner.core.simulation.encoder import Encoder
from rrr_traj_planner.core.simulation.energy import EnergyLedger, work
from rrr_traj_planner.core.simulation.physics import ArmPhysics
from rrr_traj_planner.core.states import Desired, State, Triple
from rrr_traj_planner.core.stopping.stop import Stop, stop
from rrr_traj_planner.core.stopping.task import measured, time_inside, what_moves
from rrr_traj_planner.core.trajectory.reference_trajectory import DesiredMotion, holding
from rrr_traj_planner.core.trajectory.trajectory_points import MotionPoints

NO_DISTURBANCE = (0.0, 0.0, 0.0)

OUTSIDE_NEW_RANGES = 'The motion leaves the new joint ranges: stopping'


class ControlledArm:
    """
    A simulated arm under control, whose own time starts at 0.

    Parameters
    ----------
    settings : ArmSettings
        The arm, its limits, its controller.
    q : array_like, shape (3,)
        Where it rests at first [rad].

    Attributes
    ----------
    settings : ArmSettings
        As given, or as last configured.
    steps : int
        Done so far.
    state : tuple of 6 floats
        Positions [rad] and velocities [rad/s].
    torque : tuple of 3 floats
        The motors' torques over the last step [N m].
    motion : DesiredMotion
        What is followed.
    disturbance : tuple of 3 floats
        Torques on the joints besides the motors' [N m]; may be set at any time.
    ledger : EnergyLedger
        Work and losses since the last reset.
    monitor : ConditionMonitor
        What has strained the arm.
    violation : tuple of str
        What was wrong when a tolerance was last exceeded; empty where none was.
    stop_warnings : tuple of str
        What the last stop could not keep; empty where it kept ranges and limits.

    """

    def __init__(self, settings: ArmSettings, q: ArrayLike) -> None:
        self.steps, self._step_ns = 0, settings.step_ns
        self.settings, self.ledger = settings, EnergyLedger()
        self.monitor = ConditionMonitor()
        self.disturbance: Triple = NO_DISTURBANCE
        self.motion: DesiredMotion = holding(q)
        self.stop_warnings: tuple[str, ...] = ()
        self.state: State = (*_triple(finite_array('q', q, (3,))), 0.0, 0.0, 0.0)
        self._enforce(settings)
        self._encoder = self._new_encoder()
        self.reset(q)

    @property
    def now(self) -> int:
        """How long the arm has been simulated [ns]."""
        return self.steps * self._step_ns

    @property
    def time(self) -> float:
        """How long the arm has been simulated [s]."""
        return self.now / SECOND

    @property
    def desired(self) -> Desired:
        """Positions [rad], velocities [rad/s], accelerations [rad/s^2] commanded now."""
        return self.motion.command(self.now)

    @property
    def seen(self) -> State:
        """Positions [rad] and velocities [rad/s] as the encoders tell them."""
        return self.state if self._encoder is None else self._encoder.seen

    @property
    def energy(self) -> float:
        """Energy in the arm: motion, height, bumpers' springs [J]."""
        model, state = self.settings.loaded_model, self.state
        return (float(kinetic_energy(model, state[:3], state[3:]) + potential_energy(
            model, state[:3])) + self._physics.bumper_energy(state))

    def configure(self, settings: ArmSettings) -> None:
        """
        Change what the arm is made of from the next step on.

        Parameters
        ----------
        settings : ArmSettings
            The new settings; the step must be the old one.

        Raises
        ------
        InvalidInputError
            If the step is another.

        """
        if settings.step != self.settings.step:
            raise InvalidInputError('step cannot change while the arm runs')
        before, encoder, old = self.energy, self.settings.encoder, self.settings.limits
        self.settings = settings
        if (settings.limits.min_position > old.min_position).any() or (
                settings.limits.max_position < old.max_position).any():
            self._keep_ranges()
        self._enforce(settings)
        if settings.encoder != encoder:
            self._encoder = self._new_encoder()
        self.ledger.payload += self.energy - before

    def reset(self, q: ArrayLike) -> None:
        """
        Put the arm somewhere, at rest, to hold its position there; open a new account.

        Parameters
        ----------
        q : array_like, shape (3,)
            Positions [rad].

        Raises
        ------
        InvalidInputError
            If they are not three finite numbers.

        """
        q = finite_array('q', q, (3,))
        self.state = (*_triple(q), 0.0, 0.0, 0.0)
        if self._encoder is not None:
            self._encoder.restart(self.state)
        self.ledger.clear()
        self._stay(holding(q, self.now))
        self.violation: tuple[str, ...] = ()
        self.torque = self._control()

    def follow(self, points: MotionPoints, origin_ns: int) -> None:
        """
        Take over a new trajectory, without a jump in what is commanded.

        Parameters
        ----------
        points : MotionPoints
            The trajectory.
        origin_ns : int
            What its times are counted from, on the arm's own time [ns].

        """
        takeover = Takeover(self.time, self.desired, self.settings.limits,
                            self.settings.controller_model, self.motion)
        self.motion, self.stop_warnings = replacement(
            takeover, points, origin_ns, self.settings.step)
        self.violation = ()
        self._watched = self._first_check = True
        self._brake_at_end()

    def hold(self) -> None:
        """Stop inside the ranges, as fast as the limits allow, and stay there."""
        self._stop(what_moves(self.motion, self.now, self.seen, self.settings.limits))

    def advance(self, steps: int) -> None:
        """
        Simulate control and physics.

        Parameters
        ----------
        steps : int
            How many steps.

        """
        while self.motion.ends_moving and steps > 0:
            left = -((self.now - self.motion.end_ns) // self._step_ns)  # rounded up
            self._advance(min(left, steps))
            steps -= left
            self._brake_at_end()
        if steps > 0:
            self._advance(steps)

    def _brake_at_end(self) -> None:
        """Brake a motion that has come to its end while moving."""
        motion = self.motion
        if motion.ends_moving and self.now >= motion.end_ns:
            self.motion, self.stop_warnings = self._stopped(motion, motion.end)

    def _advance(self, steps: int) -> None:
        """Simulate control and physics, with a motion that does not end moving meanwhile."""
        if self._plain and self.disturbance == NO_DISTURBANCE and (
                not self._watched or self.settings.tolerances.are_none):
            self._advance_plainly(steps)
        else:
            for _ in range(steps):
                self._advance_fully()

    def _advance_plainly(self, steps: int) -> None:
        """Simulate an arm that its controller knows and sees exactly, undisturbed, unwatched."""
        # The inner loop of nearly everything that runs an arm: local names, floats, no numpy.
        physics, desired, limit = self._physics, self.motion.elapsed, self._max_effort
        h, gains = self.settings.step, self.settings.gains
        stiffness, damping, cut = gains.stiffness, gains.damping, self.monitor.cut
        state, torque, motors, (m1, m2, m3) = self.state, self.torque, 0.0, limit
        step_ns = self._step_ns
        first = self.steps * step_ns - self.motion.origin_ns
        for n in range(first, first + steps * step_ns, step_ns):
            t = physics.terms(state)
            torque = n1, n2, n3 = computed_torque(
                t, stiffness, damping, state, desired(n, n / 1e9))
            if not (-m1 <= n1 <= m1 and -m2 <= n2 <= m2 and -m3 <= n3 <= m3):
                cut(torque)
                torque = saturated(torque, limit)
            after = physics.step(t, state, torque, h)
            motors += work(torque, state, after)
            state = after
        self.state, self.torque = state, torque
        self.steps += steps
        self.ledger.motors += motors

    def _advance_fully(self) -> None:
        """Simulate a step of whatever arm it is."""
        self._watch()
        physics, state = self._physics, self.state
        self.torque = (n1, n2, n3) = self._control()
        d1, d2, d3 = self.disturbance
        after = physics.step(physics.terms(state), state, (n1 + d1, n2 + d2, n3 + d3),
                             self.settings.step)
        self.ledger.motors += work(self.torque, state, after)
        self.ledger.disturbance += work(self.disturbance, state, after)
        self.state = after
        self.steps += 1
        if self._encoder is not None:
            self._encoder.read(after)

    def _watch(self) -> None:
        """Give up a trajectory whose tolerances are exceeded, and hold where the arm is."""
        if self._watched:
            lines = self.settings.tolerances.violation(
                self.seen, self.desired, self.time - self.motion.end, self._first_check)
            self._first_check = False
            if lines:
                self._stop(measured(self.seen, self.now))
                self.violation = lines

    def _keep_ranges(self) -> None:
        """Stop a motion that leaves the ranges, which have become smaller."""
        if time_inside(self.motion, self.time, self.settings.limits) < self.motion.end:
            self._stop(what_moves(self.motion, self.now, self.seen, self.settings.limits))
            self.stop_warnings = (OUTSIDE_NEW_RANGES, *self.stop_warnings)

    def _stop(self, motion: DesiredMotion) -> None:
        """Stop what is a motion now."""
        stopped, warnings = self._stopped(motion, self.time)
        self._stay(stopped)
        self.stop_warnings = warnings

    def _stopped(self, motion: DesiredMotion, time: float) -> Stop:
        """Return a stop from a motion at a time."""
        return stop(motion, time, self.settings.limits, self.settings.controller_model)

    def _stay(self, motion: DesiredMotion) -> None:
        """Follow a motion that is no trajectory: nothing is watched."""
        self.motion, self._watched, self._first_check = motion, False, False
        self.stop_warnings = ()

    def _control(self) -> Triple:
        """Return the torques that the controller gives now [N m]."""
        gains, seen = self.settings.gains, self.seen
        wanted = computed_torque(self._known.terms(seen), gains.stiffness, gains.damping, seen,
                                 self.desired)
        torque = saturated(wanted, self._max_effort)
        if torque is not wanted:
            self.monitor.cut(wanted)
        return torque

    def _enforce(self, settings: ArmSettings) -> None:
        """Make the physics and the controller's model of the settings."""
        low, high = (_triple(x) for x in (
            settings.limits.min_position, settings.limits.max_position))
        self._physics = ArmPhysics(settings.loaded_model, low, high, settings.friction,
                                   settings.soft_stops, self.ledger, self.monitor)
        self._known = ArmPhysics(settings.controller_model, low, high)
        self._max_effort = self.monitor.max_effort = _triple(settings.limits.max_effort)
        self._plain = settings.encoder.is_true and (
            settings.payload.known_to_controller or settings.payload.mass == 0.0)

    def _new_encoder(self) -> Encoder | None:
        """Return encoders that begin now, or none where they would tell the truth."""
        settings = self.settings
        return None if settings.encoder.is_true else Encoder(
            settings.encoder, settings.step, self.state)


def _triple(values: Array) -> Triple:
    a, b, c = values.tolist()
    return a, b, c
