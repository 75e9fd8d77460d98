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

"""The arm's action `~/follow_joint_trajectory`, by joint_trajectory_controller's rules."""

from __future__ import annotations

from control_msgs.action import FollowJointTrajectory
from rclpy.action.server import ServerGoalHandle
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.node import Node
from rrr_traj_planner.core.control.goal_end import (
    GoalEnd,
    PREEMPTED,
    refusal,
    ResultCode,
    SHUT_DOWN,
)
from rrr_traj_planner.core.control.goal_tolerances import tolerances_of_goal
from rrr_traj_planner.core.control.tolerances import Tolerances
from rrr_traj_planner.core.errors import InvalidInputError, RrrPlannerError
from rrr_traj_planner.core.simulation.controlled_arm import ControlledArm
from rrr_traj_planner.nodes.arm_node.arm_log import ArmLog
from rrr_traj_planner.nodes.arm_node.arm_messages import asked_tolerances
from rrr_traj_planner.nodes.arm_node.arm_time import FollowedClock, OwnClock
from rrr_traj_planner.nodes.arm_node.controller_messages import ControllerMessages
from rrr_traj_planner.nodes.arm_node.trajectory_input import AcceptedTrajectory, TrajectoryInput
from rrr_traj_planner.nodes.process.goal_server import (
    ABORTED,
    GoalServer,
    RefusedGoal,
    SUCCEEDED,
)

FEEDBACK_RATE = 20.0  # Hz of wall time, the controller's default action_monitor_rate

IGNORED = 'multi_dof_trajectory and component tolerances are ignored: all joints are revolute'


class ArmAction:
    """
    Serves the action: a goal at a time, which ends in a tick or when something interrupts it.

    A goal is refused, preempted, canceled and judged as by joint_trajectory_controller; a
    trajectory of the topic replaces the motion of the goal, which goes on. The reason of a refusal
    is in the log, and in the result, for clients that ask for that of a rejected goal, such as
    rclpy's `send_goal`.

    Parameters
    ----------
    node : Node
        The arm node.
    arm : ControlledArm
        The arm.
    time : FollowedClock or OwnClock
        The arm's time.
    trajectories : TrajectoryInput
        Checks and follows trajectories.
    messages : ControllerMessages
        Of the arm.
    log : ArmLog
        The arm's log.

    """

    def __init__(self, node: Node, arm: ControlledArm, time: FollowedClock | OwnClock,
                 trajectories: TrajectoryInput, messages: ControllerMessages,
                 log: ArmLog) -> None:
        self._node, self._arm, self._time = node, arm, time
        self._trajectories, self._messages, self._log = trajectories, messages, log
        self._goal: ServerGoalHandle | None = None  # the one that is pursued
        self._last: ServerGoalHandle | None = None  # the one that the arm's end aborts
        self._finishing = False
        self._server = GoalServer(node, FollowJointTrajectory, '~/follow_joint_trajectory',
                                  self._check, self._begin, self._cancel)
        self._feedback_timer = node.create_timer(
            1.0 / FEEDBACK_RATE, self._publish_feedback, autostart=False,
            clock=Clock(clock_type=ClockType.STEADY_TIME))

    def update(self) -> None:
        """Tell the client if its goal has ended."""
        end = self._arm.watch.goal_end
        if self._goal is not None and end is not None:
            self._end(end)

    def finish(self) -> bool:
        """
        Abort the goal, and refuse others from now on.

        Returns
        -------
        bool
            Whether there was no goal, and the client of the last one knows how it ended.

        """
        self._finishing = True
        if self._goal is not None:
            self._last = self._goal
            self._end(SHUT_DOWN)
            return False
        return self._last is None or self._server.has_told(self._last)

    def close(self) -> None:
        """Stop serving; abort the goal, if there is one and ROS still runs."""
        if self._node.context.ok():
            self.finish()
        self._server.destroy()

    def _check(self, goal: FollowJointTrajectory.Goal) -> tuple[AcceptedTrajectory, Tolerances]:
        """Return a goal's trajectory and tolerances, or refuse it."""
        if self._finishing:
            raise RefusedGoal(_result(SHUT_DOWN))
        try:
            accepted = self._trajectories.checked(goal.trajectory, is_goal=True)
        except RrrPlannerError as error:
            raise RefusedGoal(_result(refusal(error))) from None
        if (goal.multi_dof_trajectory.joint_names or goal.multi_dof_trajectory.points
                or goal.component_path_tolerance or goal.component_goal_tolerance):
            self._log.ignored(IGNORED)
        return accepted, self._tolerances(goal)

    def _tolerances(self, goal: FollowJointTrajectory.Goal) -> Tolerances:
        """Return a goal's tolerances; those of the parameters if the goal's are wrong."""
        settings = self._arm.settings
        try:
            return tolerances_of_goal(
                settings.tolerances, asked_tolerances(goal), settings.model.joint_names)
        except InvalidInputError as error:
            self._log.refused(str(error))
            return settings.tolerances

    def _begin(self, handle: ServerGoalHandle, checked: tuple[AcceptedTrajectory, Tolerances]
               ) -> None:
        """Pursue an accepted goal in place of the one before."""
        if self._goal is not None:
            self._end(PREEMPTED)
        self._goal = handle
        self._trajectories.follow(*checked)
        self._feedback_timer.reset()
        self.update()

    def _cancel(self, handle: ServerGoalHandle) -> FollowJointTrajectory.Result:
        """Stop the arm; return the result, whose code has no value for this."""
        self._time.advance_to_now()
        self._arm.hold()
        self._goal = None
        self._feedback_timer.cancel()
        self._log.goal_canceled()
        return FollowJointTrajectory.Result()

    def _end(self, end: GoalEnd) -> None:
        """Tell the client how its goal has ended."""
        handle, self._goal = self._goal, None
        self._feedback_timer.cancel()
        self._log.goal_ended(end)
        self._server.end(
            handle, SUCCEEDED if end.code is ResultCode.SUCCESSFUL else ABORTED, _result(end))

    def _publish_feedback(self) -> None:
        """Publish the state of the goal's trajectory."""
        if self._goal is not None:
            self._goal.publish_feedback(self._messages.feedback(self._time.reached()))


def _result(end: GoalEnd) -> FollowJointTrajectory.Result:
    return FollowJointTrajectory.Result(error_code=int(end.code), error_string=end.text)
