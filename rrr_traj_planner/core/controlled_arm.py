"""The arm at work: a motion to follow, the controller that follows it, the physics that obeys."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from rrr_traj_planner.core.arrays import Array, finite_array
from rrr_traj_planner.core.control import (
    computed_torque,
    ControllerGains,
    Desired,
    saturated,
    State,
    Triple,
)
from rrr_traj_planner.core.desired_motion import holding
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.limits import JointLimits
from rrr_traj_planner.core.model import RobotModel
from rrr_traj_planner.core.motion_points import MotionPoints
from rrr_traj_planner.core.replacement import replacement, Takeover
from rrr_traj_planner.core.simulation import ArmPhysics
from rrr_traj_planner.core.stopping import stopping


@dataclass(frozen=True, eq=False)
class ArmSettings:
    """
    What the arm and its controller are made of.

    Parameters
    ----------
    model : RobotModel
        The arm.
    limits : JointLimits
        Stops at the position limits, torques saturated at the effort limits; the others are
        kept where the arm moves of its own (stopping, joining a trajectory).
    gains : ControllerGains
        Of the computed-torque law.
    step : float
        Of the physics and of the controller [s], positive.

    Raises
    ------
    InvalidInputError
        If the step is not positive.

    """

    model: RobotModel
    limits: JointLimits
    gains: ControllerGains
    step: float = 0.001

    def __post_init__(self) -> None:
        """Check the step."""
        if not 0.0 < self.step < np.inf:
            raise InvalidInputError(f'physics_step is {self.step} s, must be positive')


class ControlledArm:
    """
    A simulated arm under control, with a time of its own that starts at 0.

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
        Steps done so far.
    state : tuple of 6 floats
        Positions [rad] and velocities [rad/s].
    torque : tuple of 3 floats
        The motors' torques over the last step [N m].
    motion : DesiredMotion
        What is followed.

    """

    def __init__(self, settings: ArmSettings, q: ArrayLike) -> None:
        self.steps = 0
        self.settings = settings
        self.configure(settings)
        self.reset(q)

    @property
    def time(self) -> float:
        """How long the arm has been simulated [s]."""
        return self.steps * self.settings.step

    @property
    def desired(self) -> Desired:
        """Positions [rad], velocities [rad/s], accelerations [rad/s^2] commanded now."""
        return self.motion(self.time)

    def configure(self, settings: ArmSettings) -> None:
        """
        Change limits and gains from the next step on.

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
            raise InvalidInputError('physics_step cannot change while the arm runs')
        self.settings = settings
        limits = settings.limits
        self._physics = ArmPhysics(
            settings.model, _triple(limits.min_position), _triple(limits.max_position))
        self._max_effort = _triple(limits.max_effort)

    def reset(self, q: ArrayLike) -> None:
        """
        Put the arm somewhere, at rest, to hold its position there.

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
        self.state: State = (*_triple(q), 0.0, 0.0, 0.0)
        self.motion = holding(q, self.time)
        self.torque = self._control(self.state)

    def follow(self, points: MotionPoints, origin: float) -> None:
        """
        Take over a new trajectory, without a jump in what is commanded.

        Parameters
        ----------
        points : MotionPoints
            The trajectory.
        origin : float
            What its times are counted from, on the arm's own time [s].

        """
        takeover = Takeover(self.time, self.desired, self.settings.limits, self.settings.model)
        self.motion = replacement(takeover, points, origin, self.settings.step)

    def hold(self) -> None:
        """Stop as fast as the limits allow, and stay there."""
        self.motion = stopping(self.desired, self.time, self.settings.limits, self.settings.model)

    def advance(self, steps: int) -> None:
        """
        Simulate control and physics.

        Parameters
        ----------
        steps : int
            How many steps.

        """
        # The inner loop of everything that runs an arm: local names, floats, no numpy.
        physics, motion, limit = self._physics, self.motion, self._max_effort
        h, gains = self.settings.step, self.settings.gains
        stiffness, damping = gains.stiffness, gains.damping
        state, torque = self.state, self.torque
        for n in range(self.steps, self.steps + steps):
            t = physics.terms(state)
            torque = saturated(
                computed_torque(t, stiffness, damping, state, motion(n * h)), limit)
            state = physics.step(t, state, torque, h)
        self.state, self.torque = state, torque
        self.steps += steps

    def _control(self, state: State) -> Triple:
        """Return the torques that the controller gives now [N m]."""
        gains = self.settings.gains
        return saturated(computed_torque(self._physics.terms(state), gains.stiffness,
                                         gains.damping, state, self.desired), self._max_effort)


def _triple(values: Array) -> Triple:
    a, b, c = values.tolist()
    return a, b, c
