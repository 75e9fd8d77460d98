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

"""The simulated arm with its trajectory controller: following, replacing, stopping, goals."""

from __future__ import annotations

from numpy.typing import ArrayLike
from rrr_traj_planner.core.arrays import finite_array
from rrr_traj_planner.core.control.goal_end import (
    GoalEnd,
    HELD,
    not_followed,
    OUT_OF_RANGE,
    RESET,
)
from rrr_traj_planner.core.control.replacement import Missed, replacement
from rrr_traj_planner.core.control.takeover import Takeover
from rrr_traj_planner.core.control.tolerances import Outcome, Tolerances
from rrr_traj_planner.core.control.trajectory_start import unmet_start
from rrr_traj_planner.core.control.trajectory_watch import TrajectoryWatch
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.simulation.arm_settings import ArmSettings
from rrr_traj_planner.core.simulation.control_loop import ControlLoop
from rrr_traj_planner.core.states import Desired
from rrr_traj_planner.core.stopping.stop import Stop, stop
from rrr_traj_planner.core.stopping.task import MeasuredState, motion_to_brake, time_inside
from rrr_traj_planner.core.trajectory.reference_trajectory import holding, ReferenceTrajectory
from rrr_traj_planner.core.trajectory.trajectory_points import TrajectoryPoints


class ControlledArm(ControlLoop):
    """
    A simulated arm that follows, replaces and stops trajectories, and checks tolerances.

    Parameters
    ----------
    settings : ArmSettings
        The arm, its limits, its controller.
    q : array_like, shape (3,)
        Initial position, at rest [rad].

    Attributes
    ----------
    motion : ReferenceTrajectory
        The reference trajectory.
    violation : tuple of str
        The tolerances violated when one last was; empty if there was no violation.
    stop_warnings : tuple of str
        Limits that the last stop violates; empty if there are none.
    missed : Missed
        Which points of the trajectory that was last followed are not reached in time.
    watch : TrajectoryWatch
        Of the trajectory that is followed; says how a goal ended.

    """

    def __init__(self, settings: ArmSettings, q: ArrayLike) -> None:
        super().__init__(settings, q)
        self.watch = TrajectoryWatch()
        self.motion: ReferenceTrajectory = holding(q)
        self.stop_warnings: tuple[str, ...] = ()
        self.missed = Missed()
        self.reset(q)

    @property
    def desired(self) -> Desired:
        """Positions [rad], velocities [rad/s], accelerations [rad/s^2] commanded now."""
        return self.motion.command(self.now)

    def configure(self, settings: ArmSettings) -> None:
        """
        Change the settings from the next step on.

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
        self.apply_settings(settings)
        if (settings.limits.min_position > old.min_position).any() or (
                settings.limits.max_position < old.max_position).any():
            self._keep_ranges()
        if settings.encoder != encoder:
            self.renew_encoder()
        self.ledger.payload += self.energy - before

    def reset(self, q: ArrayLike) -> None:
        """
        Set the arm's position, at rest, hold it, and reset the energy ledger.

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
        self.set_position(q)
        self._stay(holding(q, self.now), RESET)
        self.violation: tuple[str, ...] = ()
        self.torque = self.control(self.desired)

    def follow(self, points: TrajectoryPoints, origin_ns: int) -> bool:
        """
        Follow a new trajectory, without a jump in the command.

        A goal that is pursued goes on with it.

        Parameters
        ----------
        points : TrajectoryPoints
            The trajectory.
        origin_ns : int
            Origin of its times, on the arm's own clock [ns].

        Returns
        -------
        bool
            Whether it is followed; if not, the arm stops, and `stop_warnings` give the reason.

        """
        self.motion, self.stop_warnings, holds, self.missed = replacement(
            self._takeover(), points, origin_ns, self.settings.step)
        self.violation = ()
        if holds:
            self.watch.leave(not_followed(self.stop_warnings))
        else:
            self.watch.follow()
        self._brake_at_end()
        return not holds

    def unmet_start(self, points: TrajectoryPoints, origin_ns: int) -> str:
        """
        Return why a trajectory could not be followed from its first point on, as a goal must be.

        Parameters
        ----------
        points, origin_ns
            As `follow`.

        Returns
        -------
        str
            As `trajectory_start.unmet_start`.

        """
        return unmet_start(self._takeover(), points, origin_ns, self.settings.step)

    def _takeover(self) -> Takeover:
        """Return the present, for a trajectory that takes over."""
        return Takeover(self.time, self.desired, self.settings.limits,
                        self.settings.controller_model, self._motion_to_brake())

    def pursue(self, points: TrajectoryPoints, origin_ns: int, tolerances: Tolerances) -> bool:
        """
        Follow a new trajectory as a goal: `watch.goal_end` says how it ends.

        Parameters
        ----------
        points, origin_ns
            As `follow`.
        tolerances : Tolerances
            Of this goal, in place of the settings'.

        Returns
        -------
        bool
            As `follow`.

        """
        self.watch.pursue(tolerances)
        return self.follow(points, origin_ns)

    def hold(self) -> None:
        """Stop inside the ranges, as fast as the limits allow, and stay there."""
        self._stop(self._motion_to_brake(), HELD)

    def advance(self, steps: int) -> None:
        """
        Simulate control and physics.

        Parameters
        ----------
        steps : int
            Number of steps.

        """
        while self.motion.ends_moving and steps > 0:
            left = -((self.now - self.motion.end_ns) // self._step_ns)  # rounded up
            self._advance(min(left, steps))
            steps -= left
            self._brake_at_end()
        if steps > 0:
            self._advance(steps)

    def _brake_at_end(self) -> None:
        """Brake a motion that ends with a velocity, at its end."""
        motion = self.motion
        if motion.ends_moving and self.now >= motion.end_ns:
            if self.watch.is_on and self.watch.goal is not None:
                self._check(motion.end_state)
                if self.motion is not motion:  # given up
                    return
            moving = self._motion_to_brake()
            self.motion, self.stop_warnings = self._stopped(
                moving, motion.end if moving is motion else self.time)

    def _advance(self, steps: int) -> None:
        """Simulate control and physics, while no motion ends with a velocity."""
        while steps > 0:
            unwatched = self._unwatched_steps(steps)
            if unwatched == 0:
                self._check(self.desired)
            if unwatched > 0 and self.is_ideal:
                done = min(unwatched, steps)
                self.advance_ideal(self.motion, done)
            else:
                done = 1
                self.advance_general(self.desired)
            steps -= done

    def _unwatched_steps(self, most: int) -> int:
        """Return in how many steps tolerances are to be checked next, or `most` if never."""
        time = self.watch.time_to_check(
            self.settings.tolerances, self.motion.end_ns - self.now)
        return most if time is None else -(-time // self._step_ns)  # rounded up

    def _check(self, desired: Desired) -> None:
        """End a goal that is reached; brake from the measured state if tolerances are exceeded."""
        verdict = self.watch.check(
            self.settings.tolerances, self.measured, desired, self.now - self.motion.end_ns)
        if verdict is None:
            return
        lines = self.watch.apply(verdict, self.settings.model.joint_names)
        if verdict.outcome is not Outcome.REACHED:
            self._stop(MeasuredState(self.measured, self.now, self.motion), HELD)
            self.violation = lines

    def _keep_ranges(self) -> None:
        """Stop a motion that leaves ranges made smaller."""
        if time_inside(self.motion, self.time, self.settings.limits) < self.motion.end:
            self._stop(self._motion_to_brake(), OUT_OF_RANGE)
            self.stop_warnings = (
                'The motion leaves the new joint ranges: stopping', *self.stop_warnings)

    def _motion_to_brake(self) -> ReferenceTrajectory:
        """Return the motion that would be braked now."""
        return motion_to_brake(self.motion, self.now, self.measured, self.settings.limits)

    def _stop(self, motion: ReferenceTrajectory, end: GoalEnd) -> None:
        """Stop a motion now, which ends a goal."""
        stopped, warnings = self._stopped(motion, self.time)
        self._stay(stopped, end)
        self.stop_warnings = warnings

    def _stopped(self, motion: ReferenceTrajectory, time: float) -> Stop:
        """Return a stop from a motion at a time."""
        return stop(motion, time, self.settings.limits, self.settings.controller_model)

    def _stay(self, motion: ReferenceTrajectory, end: GoalEnd) -> None:
        """Follow a motion other than a received trajectory: no tolerances, and no goal."""
        self.motion = motion
        self.watch.leave(end)
        self.stop_warnings = ()
