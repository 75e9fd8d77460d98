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

"""Trajectories from outside: how the arm takes those of the topic and those of the action."""

from __future__ import annotations

from typing import NamedTuple

from rrr_traj_planner.core.control.tolerances import Tolerances
from rrr_traj_planner.core.control.trajectory_limits import excesses
from rrr_traj_planner.core.control.trajectory_validation import (
    check_trajectory,
    commanded_points,
    MovingEndError,
)
from rrr_traj_planner.core.errors import InvalidInputError, RrrPlannerError
from rrr_traj_planner.core.nanoseconds import SECOND
from rrr_traj_planner.core.simulation.controlled_arm import ControlledArm
from rrr_traj_planner.core.trajectory.trajectory_points import TrajectoryPoints
from rrr_traj_planner.nodes.arm_node.arm_log import ArmLog
from rrr_traj_planner.nodes.arm_node.arm_messages import incoming_trajectory
from rrr_traj_planner.nodes.arm_node.arm_time import FollowedClock, OwnClock
from rrr_traj_planner.nodes.parameters.declared import DeclaredParameters
from trajectory_msgs.msg import JointTrajectory

MOVING_END_HINT = (
    '; a stream of points with velocities needs '
    'allow_nonzero_velocity_at_trajectory_end: true')


class AcceptedTrajectory(NamedTuple):
    """A trajectory that keeps the rules."""

    points: TrajectoryPoints
    stamp: int  # ns; 0: starts when it is followed


class TrajectoryInput:
    """
    Checks trajectories by joint_trajectory_controller's rules, and has the arm follow them.

    Parameters
    ----------
    arm : ControlledArm
        The arm.
    time : FollowedClock or OwnClock
        The arm's time.
    parameters : DeclaredParameters
        Hold the rules.
    log : ArmLog
        The arm's log.

    """

    def __init__(self, arm: ControlledArm, time: FollowedClock | OwnClock,
                 parameters: DeclaredParameters, log: ArmLog) -> None:
        self._arm, self._time, self._parameters, self._log = arm, time, parameters, log

    def take(self, message: JointTrajectory) -> None:
        """
        Follow a trajectory of the topic, or log why it is refused and continue as before.

        Parameters
        ----------
        message : JointTrajectory
            As received.

        """
        try:
            accepted = self.checked(message)
        except RrrPlannerError:
            return
        self.follow(accepted)

    def checked(self, message: JointTrajectory, is_goal: bool = False) -> AcceptedTrajectory:
        """
        Check a trajectory now.

        Parameters
        ----------
        message : JointTrajectory
            As received.
        is_goal : bool
            Whether it is a goal's: the arm must be able to follow it from its first point on,
            unless it was under way already when it arrived.

        Returns
        -------
        AcceptedTrajectory
            For `follow`.

        Raises
        ------
        RrrPlannerError
            Says why it is refused, which is logged too.

        """
        self._time.advance_to_now()
        trajectory, names = incoming_trajectory(message), self._arm.settings.model.joint_names
        try:
            check_trajectory(trajectory, names, self._time.now(), self._parameters.config.rules)
            points = commanded_points(trajectory, names, self._arm.desired[:3])
            unmet = is_goal and self._arm.unmet_start(points, self._origin(trajectory.stamp))
            if unmet:
                raise InvalidInputError(unmet)
        except RrrPlannerError as error:
            if isinstance(error, MovingEndError):
                error = MovingEndError(f'{error}{MOVING_END_HINT}')
            self._log.refused(str(error))
            raise error from None
        return AcceptedTrajectory(points, trajectory.stamp)

    def follow(self, accepted: AcceptedTrajectory, goal: Tolerances | None = None) -> None:
        """
        Follow a trajectory from now on; warn of limits that it exceeds.

        Parameters
        ----------
        accepted : AcceptedTrajectory
            From `checked`.
        goal : Tolerances, optional
            Of the goal that it is; None: it is none, and a goal that is pursued goes on with it.

        """
        arm, points = self._arm, accepted.points
        origin_ns = self._origin(accepted.stamp)
        exceeded = excesses(
            points, arm.settings.limits, (arm.now - origin_ns) / SECOND, arm.desired)
        if goal is None:
            followed = arm.follow(points, origin_ns)
        else:
            followed = arm.pursue(points, origin_ns, goal)
        if followed:
            self._log.exceeded(exceeded, arm.missed)
            self._log.followed(len(points.times), arm.motion.end - arm.time)
        elif goal is not None:
            arm.stop_warnings = ()  # the goal's end has them

    def _origin(self, stamp: int) -> int:
        """Return the origin of a trajectory's times on the arm's own clock [ns]."""
        return stamp - self._time.epoch if stamp != 0 else self._arm.now
