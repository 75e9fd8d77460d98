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

"""The node `trajectory_planner`: serves planning requests, short ones before long ones."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from contextlib import suppress
import sys
from time import perf_counter
import traceback
from typing import Any, NamedTuple

from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import TransformStamped
from nav_msgs.msg import Path
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.clock import Clock, ClockType
from rclpy.exceptions import InvalidHandle
from rclpy.qos import QoSProfile
from rrr_traj_planner.core.cancellation import step
from rrr_traj_planner.core.errors import ConvergenceError, counted, quoted, RrrPlannerError
from rrr_traj_planner.nodes.output.diagnostics import PERIOD
from rrr_traj_planner.nodes.output.latched import LATCHED
from rrr_traj_planner.nodes.output.marker_messages import no_plan_markers, plan_markers
from rrr_traj_planner.nodes.output.message_times import seconds
from rrr_traj_planner.nodes.parameters.configuration import PlannerConfig
from rrr_traj_planner.nodes.parameters.declared import DeclaredParameters
from rrr_traj_planner.nodes.parameters.parameter_files import files_given
from rrr_traj_planner.nodes.parameters.table import PLANNER
from rrr_traj_planner.nodes.planner_node.frame_transforms import FrameError, FrameTransforms
from rrr_traj_planner.nodes.planner_node.planning_answer import failure, refusal, success, tip_path
from rrr_traj_planner.nodes.planner_node.planning_request import planning_request
from rrr_traj_planner.nodes.planner_node.request_statistics import RequestStatistics
from rrr_traj_planner.nodes.planner_node.scheduler import Job
from rrr_traj_planner.nodes.planner_node.worker_pool import WorkerPool
from rrr_traj_planner.nodes.process.node_construction import destroyed_on_error
from rrr_traj_planner.nodes.process.node_start import NodeStart
from rrr_traj_planner.nodes.process.service_node import ServiceNode
from rrr_traj_planner.planners.deadline import Deadline
from rrr_traj_planner.planners.plan import Plan
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner_interfaces.srv import PlanTrajectory
from trajectory_msgs.msg import JointTrajectory
from visualization_msgs.msg import MarkerArray

# Queue of waiting requests: if it is full, DDS drops the oldest one, which then gets no answer.
REQUEST_QUEUE = QoSProfile(depth=1000)

TIME_PER_VIA_POINT = 4e-4  # s, lower bound on the planning time per via point if there are many


class _Answer(NamedTuple):
    """The response to a request, with its plan or the trace of a bug."""

    response: PlanTrajectory.Response
    plan: Plan | None = None  # of a success
    trace: str = ''           # of a bug, for the log


class _Unpublished(NamedTuple):
    """A plan that has been sent to its client and is still to be published on the topics."""

    trajectory: JointTrajectory
    plan: Plan
    config: PlannerConfig
    stamp: Time  # of the request


class TrajectoryPlanner(ServiceNode):
    """
    Serves `plan_trajectory`; plans in worker threads, so that its other services stay responsive.

    A plan is sent to its client first and published on the topics afterwards.

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
        with destroyed_on_error(self):
            self._set_up(kwargs.get('cli_args'))

    def _set_up(self, arguments: Sequence[str] | None) -> None:
        self._parameters_declared = DeclaredParameters(
            self, PLANNER, PlannerConfig.from_values, lambda config: None,
            files_given([*sys.argv, *(arguments or ())]))
        self._trajectory = self.create_publisher(JointTrajectory, 'planned_trajectory', LATCHED)
        self._path = self.create_publisher(Path, 'planned_path', LATCHED)
        self._markers = self.create_publisher(MarkerArray, 'markers', LATCHED)
        self._markers.publish(no_plan_markers(self._parameters_declared.config.base_frame))
        self._statistics = RequestStatistics()
        self._in_progress: list[float] = []  # start times of the requests being planned
        self._diagnostics = self.create_publisher(DiagnosticArray, 'diagnostics', 10)
        self._pool, self._frames = WorkerPool(self, 'planning'), FrameTransforms(self)
        self.create_service(PlanTrajectory, 'plan_trajectory', self._plan,
                            qos_profile=REQUEST_QUEUE, callback_group=ReentrantCallbackGroup())
        self._unpublished: deque[_Unpublished] = deque()
        self._answered = self.create_guard_condition(
            self._publish_all, callback_group=MutuallyExclusiveCallbackGroup())
        self.create_timer(PERIOD, self._diagnose,  # also while simulated time is paused
                          clock=Clock(clock_type=ClockType.STEADY_TIME))
        self._start = NodeStart(
            self, self._parameters_declared, self._parameters_declared.config.limits,
            f'serves {self.resolve_service_name("plan_trajectory")}', arguments)

    async def _plan(self, request: PlanTrajectory.Request,
                    _: PlanTrajectory.Response) -> PlanTrajectory.Response:
        """Answer a request; the executor continues with other work while a thread plans."""
        config, stamp = self._parameters_declared.config, self.get_clock().now().to_msg()
        start = perf_counter()
        self._in_progress.append(start)
        answer = await self._answer(request, config)
        self._in_progress.remove(start)
        name = quoted(request.planner_id or config.default_planner_id)[1:-1]
        self._statistics.add(answer.response, self.get_clock().now().to_msg())
        self._report(name, answer)
        if answer.plan is not None:
            self._unpublished.append(
                _Unpublished(answer.response.trajectory, answer.plan, config, stamp))
            self._answered.trigger()
        return answer.response

    async def _answer(self, request: PlanTrajectory.Request, config: PlannerConfig) -> _Answer:
        """Have a thread plan, once the transform of the via points is there."""
        to_base = None
        try:
            if len(request.via_points.poses):
                to_base = await self._frames.to_base(
                    request.via_points.header, config.base_frame, config.transform_timeout)
        except FrameError as error:
            return _Answer(refusal(error))
        except Exception as error:  # a bug, as in _answer
            return _Answer(failure(error), trace=traceback.format_exc())
        number = len(request.via_points.poses) + len(request.joint_via_points)
        return await self._pool.call(_answer, request, config, to_base, self._pool.is_ending,
                                     expected=TIME_PER_VIA_POINT * number)

    async def _publish_all(self) -> None:
        """Publish the plans that have been sent to their clients, oldest first."""
        with suppress(InvalidHandle):  # the node may be destroyed meanwhile
            while self._unpublished:
                await self._publish(self._unpublished.popleft())

    async def _publish(self, unpublished: _Unpublished) -> None:
        """Publish a plan's trajectory, then its path and markers, which a thread computes."""
        trajectory, *arguments = unpublished
        self._trajectory.publish(trajectory)
        try:
            path, markers = await self._pool.call(_visualization, *arguments)
        except Exception:  # a bug, but the client has its plan
            self.get_logger().error(f'a plan cannot be drawn:\n{traceback.format_exc()}')
            return
        self._path.publish(path)
        self._markers.publish(markers)

    def _diagnose(self) -> None:
        """Publish the statistics of all requests as diagnostics."""
        busy = perf_counter() - min(self._in_progress) if self._in_progress else 0.0
        self._diagnostics.publish(self._statistics.message(
            self.get_name(), self.get_clock().now().to_msg(), busy))

    def _report(self, name: str, answer: _Answer) -> None:
        """Log one line for each request, and the trace of a bug."""
        log, response = self.get_logger(), answer.response
        took = f'in {1e3 * response.planning_time:.0f} ms'
        if response.error_code == response.SUCCESS:
            points = response.trajectory.points
            log.info(f'{name} planned {counted(len(response.via_times), "via point")} {took}: '
                     f'{seconds(points[-1].time_from_start):.3f} s, '
                     f'{counted(len(points), "point")}'
                     + (f'; {response.message}' if response.message else ''))
        elif answer.trace:
            log.error(f'{name} failed {took}: {response.message}\n{answer.trace}')
        else:
            log.warning(f'{name} refused {took} ({response.error_code}): {response.message}')

    def destroy_node(self) -> None:
        """End the planning threads with the node."""
        self._start.end()
        self._pool.end()
        super().destroy_node()


def _answer(request: PlanTrajectory.Request, config: PlannerConfig,
            to_base: TransformStamped | None, is_ending: Callable[[], bool],
            job: Job) -> _Answer:
    """Plan a request; errors become responses too."""
    found, trace = None, ''
    deadline = Deadline(config.planning_time_limit, job.checkpoint, is_ending)
    try:
        wanted = planning_request(request, config, deadline, to_base)
        found = plan(config.model, config.limits_for(wanted.planner_id), wanted)
        planning_time = job.run_time()
        with step('conversion to the response message'):
            response = success(found, config, deadline)
    except Exception as error:
        found, planning_time = None, job.run_time()
        if isinstance(error, RrrPlannerError) and not isinstance(error, ConvergenceError):
            response = refusal(error)
        else:  # a bug: the response has its message, the log the trace
            response, trace = failure(error), traceback.format_exc()
    response.planning_time = planning_time
    return _Answer(response, found, trace)


def _visualization(found: Plan, config: PlannerConfig, stamp: Time,
                   job: Job) -> tuple[Path, MarkerArray]:
    """Return the tip's path and the markers of a plan."""
    return (tip_path(found.points, config, stamp, lambda: job.checkpoint() < 0.0),
            plan_markers(found.points, found.via_times, config.model, config.base_frame))
