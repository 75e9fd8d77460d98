"""The node `trajectory_planner`: plans on request, one request at a time."""

from __future__ import annotations

from queue import SimpleQueue
from threading import Thread
from time import perf_counter
import traceback
from typing import Any

from nav_msgs.msg import Path
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.task import Future
from rrr_traj_planner.core.errors import RrrPlannerError
from rrr_traj_planner.nodes.configuration import PlannerConfig
from rrr_traj_planner.nodes.declared_parameters import DeclaredParameters
from rrr_traj_planner.nodes.parameters import PLANNER
from rrr_traj_planner.nodes.planning_messages import (
    fill_refusal,
    fill_response,
    planning_request,
    tip_path,
)
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.request import Plan
from rrr_traj_planner_interfaces.srv import PlanTrajectory
from trajectory_msgs.msg import JointTrajectory

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class TrajectoryPlanner(Node):
    """
    Serves `plan_trajectory`; a thread plans, so that the node answers all else meanwhile.

    Parameters
    ----------
    **kwargs
        For `rclpy.node.Node`, such as context and parameter_overrides.

    Notes
    -----
    Serves `plan_trajectory` (rrr_traj_planner_interfaces/srv/PlanTrajectory); publishes
    `planned_trajectory` and `planned_path`, the last success, transient local. Parameters: see
    `parameters.py`.

    """

    def __init__(self, **kwargs: Any) -> None:
        super().__init__('trajectory_planner', **kwargs)
        self._parameters_declared = DeclaredParameters(
            self, PLANNER, PlannerConfig.from_values, lambda config: None)
        self._trajectory = self.create_publisher(JointTrajectory, 'planned_trajectory', LATCHED)
        self._path = self.create_publisher(Path, 'planned_path', LATCHED)
        self._work: SimpleQueue[Any] = SimpleQueue()
        self._worker = Thread(target=self._run_worker, name='planning', daemon=True)
        self._worker.start()
        # A group of its own, held while a request is planned: the next one waits its turn.
        self.create_service(PlanTrajectory, 'plan_trajectory', self._plan,
                            callback_group=MutuallyExclusiveCallbackGroup())

    async def _plan(self, request: PlanTrajectory.Request,
                    response: PlanTrajectory.Response) -> PlanTrajectory.Response:
        """Answer a request; the executor goes on with other work until the plan is there."""
        config = self._parameters_declared.config
        done = Future()
        self._work.put((request, response, config, done))
        found = await done
        self._report(response)
        if found is not None:
            self._trajectory.publish(response.trajectory)
            self._path.publish(tip_path(found.points, config, self.get_clock().now().to_msg()))
        return response

    def _run_worker(self) -> None:
        """Plan what is asked, until the node is destroyed."""
        for request, response, config, done in iter(self._work.get, None):
            done.set_result(self._answer(request, response, config))
            executor = self.executor
            if executor is not None:
                executor.wake()

    def _answer(self, request: PlanTrajectory.Request, response: PlanTrajectory.Response,
                config: PlannerConfig) -> Plan | None:
        """Fill a response, in the planning thread; return the plan where there is one."""
        started, found = perf_counter(), None
        try:
            found = plan(config.model, config.limits, planning_request(request, config))
            response.planning_time = perf_counter() - started
            fill_response(response, found, config)
        except RrrPlannerError as error:
            response.planning_time = perf_counter() - started
            fill_refusal(response, error)
        except Exception as error:  # a bug: the caller is told, the log has the trace
            response.planning_time = perf_counter() - started
            response.error_code, response.failed_via_point = response.FAILURE, -1
            response.message = f'internal error, {type(error).__name__}: {error}'
            self.get_logger().error(traceback.format_exc())
        return found

    def _report(self, response: PlanTrajectory.Response) -> None:
        """Log one line for each request."""
        log = self.get_logger()
        ms = 1e3 * response.planning_time
        if response.error_code == response.SUCCESS:
            points = response.trajectory.points
            last = points[-1].time_from_start
            log.info(f'planned {len(response.via_times)} via points in {ms:.0f} ms: '
                     f'{last.sec + 1e-9 * last.nanosec:.3f} s, {len(points)} points'
                     + (f'; {response.message}' if response.message else ''))
        elif response.error_code == response.FAILURE:
            log.error(response.message)
        else:
            log.warning(f'refused in {ms:.0f} ms ({response.error_code}): {response.message}')

    def destroy_node(self) -> None:
        """End the planning thread with the node."""
        self._work.put(None)
        super().destroy_node()
