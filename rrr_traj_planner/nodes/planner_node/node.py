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

"""The node `trajectory_planner`: plans on request, short requests before long ones."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from contextlib import suppress
from time import perf_counter
import traceback
from typing import Any, NamedTuple

from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray
from nav_msgs.msg import Path
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.clock import Clock, ClockType
from rclpy.exceptions import InvalidHandle
from rclpy.qos import DurabilityPolicy, QoSProfile
from rrr_traj_planner.core.cancellation import step
from rrr_traj_planner.core.errors import ConvergenceError, quoted, RrrPlannerError
from rrr_traj_planner.nodes.output.diagnostics import PERIOD
from rrr_traj_planner.nodes.output.marker_messages import no_plan_markers, plan_markers
from rrr_traj_planner.nodes.parameters.configuration import PlannerConfig
from rrr_traj_planner.nodes.parameters.declared import DeclaredParameters
from rrr_traj_planner.nodes.parameters.table import PLANNER
from rrr_traj_planner.nodes.planner_node.background import Background
from rrr_traj_planner.nodes.planner_node.planning_answer import failure, refusal, success, tip_path
from rrr_traj_planner.nodes.planner_node.planning_request import planning_request
from rrr_traj_planner.nodes.planner_node.request_statistics import RequestStatistics
from rrr_traj_planner.nodes.planner_node.turns import Turn
from rrr_traj_planner.nodes.process.node_start import NodeStart
from rrr_traj_planner.nodes.process.service_node import ServiceNode
from rrr_traj_planner.planners.deadline import Deadline
from rrr_traj_planner.planners.plan import Plan
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner_interfaces.srv import PlanTrajectory
from trajectory_msgs.msg import JointTrajectory
from visualization_msgs.msg import MarkerArray

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)

# So many requests may wait; of more the oldest are lost, and their clients wait in vain.
WAITING = QoSProfile(depth=1000)

TIME_OF_POINT = 4e-4  # s, that planning takes at the least for each of many via points


class _Answer(NamedTuple):
    """What a request comes to."""

    response: PlanTrajectory.Response
    plan: Plan | None = None  # where there is one
    trace: str = ''           # of a bug, for the log


class _Unseen(NamedTuple):
    """A plan that has been answered, and is to be published."""

    trajectory: JointTrajectory
    plan: Plan
    config: PlannerConfig
    stamp: Time  # when it was asked


class TrajectoryPlanner(ServiceNode):
    """
    Serves `plan_trajectory`; threads plan in turns, so that the node answers all else meanwhile.

    A plan is answered first and published then.

    Parameters
    ----------
    **kwargs
        For `rclpy.node.Node`, such as context and parameter_overrides.

    Notes
    -----
    Serves `plan_trajectory` (rrr_traj_planner_interfaces/srv/PlanTrajectory); publishes
    `planned_trajectory`, `planned_path` and `markers` (via points, planned path) of the last
    success, transient local, and `diagnostics`
    (diagnostic_msgs/DiagnosticArray) once a second. Parameters: see `parameters.table`.

    """

    def __init__(self, **kwargs: Any) -> None:
        super().__init__('trajectory_planner', **kwargs)
        self._parameters_declared = DeclaredParameters(
            self, PLANNER, PlannerConfig.from_values, lambda config: None)
        self._trajectory = self.create_publisher(JointTrajectory, 'planned_trajectory', LATCHED)
        self._path = self.create_publisher(Path, 'planned_path', LATCHED)
        self._markers = self.create_publisher(MarkerArray, 'markers', LATCHED)
        self._markers.publish(no_plan_markers(self._parameters_declared.config.base_frame))
        self._statistics = RequestStatistics()
        self._begun: list[float] = []  # when what is planned was taken up
        self._diagnostics = self.create_publisher(DiagnosticArray, 'diagnostics', 10)
        self._threads = Background(self, 'planning')
        self.create_service(PlanTrajectory, 'plan_trajectory', self._plan, qos_profile=WAITING,
                            callback_group=ReentrantCallbackGroup())
        self._unseen: deque[_Unseen] = deque()
        self._answered = self.create_guard_condition(
            self._show, callback_group=MutuallyExclusiveCallbackGroup())
        self.create_timer(PERIOD, self._diagnose,  # whatever the clock does
                          clock=Clock(clock_type=ClockType.STEADY_TIME))
        self._start = NodeStart(
            self, self._parameters_declared, self._parameters_declared.config.limits,
            f'serves {self.resolve_service_name("plan_trajectory")}', kwargs.get('cli_args'))

    async def _plan(self, request: PlanTrajectory.Request,
                    _: PlanTrajectory.Response) -> PlanTrajectory.Response:
        """Answer a request; the executor goes on with other work until the plan is there."""
        config, stamp = self._parameters_declared.config, self.get_clock().now().to_msg()
        begun = perf_counter()
        self._begun.append(begun)
        answer = await self._threads.call(
            _answer, request, config, self._threads.is_ending,
            expected=TIME_OF_POINT * len(request.via_points.poses))
        self._begun.remove(begun)
        name = quoted(request.planner_id or config.default_planner_id)[1:-1]
        self._statistics.add(answer.response, self.get_clock().now().to_msg())
        self._report(name, answer)
        if answer.plan is not None:
            self._unseen.append(_Unseen(answer.response.trajectory, answer.plan, config, stamp))
            self._answered.trigger()
        return answer.response

    async def _show(self) -> None:
        """Publish the plans that have been answered, oldest first."""
        with suppress(InvalidHandle):  # the node may be destroyed meanwhile
            while self._unseen:
                await self._publish(self._unseen.popleft())

    async def _publish(self, unseen: _Unseen) -> None:
        """Publish a plan; a thread makes what is only looked at."""
        trajectory, *plan_and_setting = unseen
        self._trajectory.publish(trajectory)
        try:
            path, markers = await self._threads.call(_drawing, *plan_and_setting)
        except Exception:  # a bug, but the plan is good and has been answered
            self.get_logger().error(f'a plan cannot be drawn:\n{traceback.format_exc()}')
            return
        self._path.publish(path)
        self._markers.publish(markers)

    def _diagnose(self) -> None:
        """Publish what requests have come to."""
        busy = perf_counter() - min(self._begun) if self._begun else 0.0
        self._diagnostics.publish(self._statistics.message(
            self.get_name(), self.get_clock().now().to_msg(), busy))

    def _report(self, name: str, answer: _Answer) -> None:
        """Log one line for each request, and the trace of a bug."""
        log, response = self.get_logger(), answer.response
        took = f'in {1e3 * response.planning_time:.0f} ms'
        if response.error_code == response.SUCCESS:
            points = response.trajectory.points
            last = points[-1].time_from_start
            log.info(f'{name} planned {len(response.via_times)} via points {took}: '
                     f'{last.sec + 1e-9 * last.nanosec:.3f} s, {len(points)} points'
                     + (f'; {response.message}' if response.message else ''))
        elif answer.trace:
            log.error(f'{name} failed {took}: {response.message}\n{answer.trace}')
        else:
            log.warning(f'{name} refused {took} ({response.error_code}): {response.message}')

    def destroy_node(self) -> None:
        """End the planning threads with the node."""
        self._start.end()
        self._threads.end()
        super().destroy_node()


def _answer(request: PlanTrajectory.Request, config: PlannerConfig,
            is_ending: Callable[[], bool], turn: Turn) -> _Answer:
    """Plan; whatever goes wrong is an answer too."""
    found, trace = None, ''
    deadline = Deadline(config.planning_time_limit, turn.seconds, is_ending)
    try:
        found = plan(config.model, config.limits, planning_request(request, config, deadline))
        seconds = turn.used()
        with step('the making of the message'):
            response = success(found, config, deadline)
    except Exception as error:
        found, seconds = None, turn.used()
        if isinstance(error, RrrPlannerError) and not isinstance(error, ConvergenceError):
            response = refusal(error)
        else:  # a bug: the caller is told, the log has the trace
            response, trace = failure(error), traceback.format_exc()
    response.planning_time = seconds
    return _Answer(response, found, trace)


def _drawing(found: Plan, config: PlannerConfig, stamp: Time,
             turn: Turn) -> tuple[Path, MarkerArray]:
    """Return the tip's path and the markers of a plan."""
    return (tip_path(found.points, config, stamp, lambda: turn.seconds() < 0.0),
            plan_markers(found.points, found.via_times, config.model, config.base_frame))
