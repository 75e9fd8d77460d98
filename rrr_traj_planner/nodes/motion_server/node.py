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

"""The node `motion_server`: one call that plans from where the arm is, and runs the plan."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
import sys
from typing import Any

from rclpy.action.server import ServerGoalHandle
from rrr_traj_planner.nodes.motion.motion import EndCode, Motion, MotionEnd, Progress, Watch
from rrr_traj_planner.nodes.motion.motions import Motions
from rrr_traj_planner.nodes.motion.options import controller_of, Options
from rrr_traj_planner.nodes.parameters.declared import DeclaredParameters
from rrr_traj_planner.nodes.parameters.parameter_files import files_given
from rrr_traj_planner.nodes.parameters.table import MOTION
from rrr_traj_planner.nodes.process.goal_server import (
    ABORTED,
    GoalServer,
    RefusedGoal,
    SUCCEEDED,
)
from rrr_traj_planner.nodes.process.node_construction import destroyed_on_error
from rrr_traj_planner.nodes.process.node_start import NodeStart
from rrr_traj_planner.nodes.process.service_node import ServiceNode
from rrr_traj_planner_interfaces.action import MoveThrough
from rrr_traj_planner_interfaces.srv import PlanTrajectory

ENDED = MotionEnd(EndCode.PREEMPTED, 'motion_server has ended')


class MotionServer(ServiceNode):
    """
    Serves `move_through`.

    Parameters
    ----------
    **kwargs
        For `rclpy.node.Node`, such as context and parameter_overrides.

    Notes
    -----
    Serves `move_through` (rrr_traj_planner_interfaces/action/MoveThrough); calls
    `plan_trajectory`; sends goals to `CONTROLLER_NAME/follow_joint_trajectory`; subscribes
    `joint_states` and `CONTROLLER_NAME/controller_state`. Parameters: see `parameters.table`.

    """

    def __init__(self, **kwargs: Any) -> None:
        super().__init__('motion_server', **kwargs)
        with destroyed_on_error(self):
            self._set_up(kwargs.get('cli_args'))

    def _set_up(self, arguments: Sequence[str] | None) -> None:
        parameters = DeclaredParameters(
            self, MOTION, _options, self._configure, files_given([*sys.argv, *(arguments or ())]))
        self._motions = Motions(self, parameters.config)
        self._goals: dict[bytes, tuple[ServerGoalHandle, Motion]] = {}
        self._aborted: list[ServerGoalHandle] | None = None  # since the node finishes
        self._server = GoalServer(
            self, MoveThrough, 'move_through', self._check, self._begin, self._cancel)
        self._start = NodeStart(
            self, parameters, None, f'serves {self.resolve_service_name("move_through")} with '
            f'{self._motions.action}', arguments)

    def _configure(self, options: Options) -> None:
        self._motions.options = options

    def _check(self, goal: MoveThrough.Goal) -> PlanTrajectory.Request:
        """Return the request to the planner, which refuses what is wrong with the goal."""
        if self._aborted is not None:
            raise RefusedGoal(_result(ENDED, None))
        return _request(goal)

    def _begin(self, handle: ServerGoalHandle, request: PlanTrajectory.Request) -> None:
        """Plan and run an accepted goal."""
        watch = Watch(progress=partial(self._progress, handle), ended=partial(self._end, handle))
        motion = self._motions.move(request, watch)
        if motion.end is None:
            self._goals[bytes(handle.goal_id.uuid)] = handle, motion
        else:
            self._tell(handle, motion.end, None)

    def _cancel(self, handle: ServerGoalHandle) -> MoveThrough.Result:
        """Stop a goal; the arm comes to rest afterwards."""
        _, motion = self._goals.pop(bytes(handle.goal_id.uuid))
        self._motions.cancel(motion)
        self.get_logger().info('goal canceled')
        return _result(MotionEnd(EndCode.PREEMPTED, 'canceled'), motion)

    def _progress(self, handle: ServerGoalHandle, progress: Progress) -> None:
        """Publish where the motion is."""
        if bytes(handle.goal_id.uuid) in self._goals:
            handle.publish_feedback(MoveThrough.Feedback(
                next_via_point=progress.next_via_point,
                time_left=progress.duration - progress.time,
                via_times_left=progress.via_times_left,
                joint_names=progress.joint_names, tracking_error=progress.tracking_error))

    def _end(self, handle: ServerGoalHandle, end: MotionEnd) -> None:
        """Tell the client how its goal has ended, unless it was canceled or has just begun."""
        _, motion = self._goals.pop(bytes(handle.goal_id.uuid), (None, None))
        if motion is not None:
            self._tell(handle, end, motion)

    def _tell(self, handle: ServerGoalHandle, end: MotionEnd, motion: Motion | None) -> None:
        """End a goal, and log how."""
        log = self.get_logger()
        if end.code == EndCode.SUCCESS:
            log.info('goal reached' + (f'; {end.text}' if end.text else ''))
        elif end.code == EndCode.PREEMPTED:
            log.info(f'goal ended: {end.text}')
        else:
            log.warning(f'goal ended ({end.code}): {end.text}')
        self._server.end(handle, SUCCEEDED if end.code == EndCode.SUCCESS else ABORTED,
                         _result(end, motion))

    def finish(self) -> bool:
        """
        Stop the arm, abort goals, and refuse others, since the process ends.

        Returns
        -------
        bool
            Whether the clients of all goals have their results.

        """
        goals, self._goals = self._goals, {}
        self._aborted = [*(self._aborted or ()), *(handle for handle, _ in goals.values())]
        for handle, motion in goals.values():
            self._motions.cancel(motion)
            self._tell(handle, ENDED, motion)
        return all(map(self._server.has_told, self._aborted))

    def destroy_node(self) -> None:
        """Abort goals, and release the claim on the node's name."""
        if self.context.ok():
            self.finish()
        self._server.destroy()
        self._motions.close()
        self._start.end()
        super().destroy_node()


def _options(values: Mapping[str, Any]) -> Options:
    """Return how motions are run."""
    controller = controller_of(values['controller_name'], 'parameter controller_name')
    return Options(controller, values['replanning_lead'],
                   values['planning_timeout'], values['discovery_timeout'],
                   values['start_tolerance'])


def _request(goal: MoveThrough.Goal) -> PlanTrajectory.Request:
    """Return the request to the planner; its fields have the goal's names."""
    return PlanTrajectory.Request(
        **{name: getattr(goal, name) for name in goal.get_fields_and_field_types()})


def _result(end: MotionEnd, motion: Motion | None) -> MoveThrough.Result:
    """Return the result of a goal."""
    result = MoveThrough.Result(
        error_code=end.code, message=end.text, failed_via_point=end.via_point,
        controller_error_code=end.controller_code)
    planned = None if motion is None else motion.response
    if planned is not None:
        result.trajectory, result.via_times = planned.trajectory, planned.via_times
        result.planning_time = planned.planning_time
    return result
