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

"""The demo's client: requests a plan, sends it to the arm, and records the arm's motion."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from rclpy.time import Time
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.nodes.output.message_times import seconds
from rrr_traj_planner.nodes.parameters.configuration import PlannerConfig
from rrr_traj_planner.nodes.point_files.task import Task
from rrr_traj_planner.nodes.process.entry import StartError
from rrr_traj_planner.nodes.process.node_claim import is_claimed
from rrr_traj_planner.nodes.process.node_start import KEEP_APART
from rrr_traj_planner.nodes.recording.bag import Bag
from rrr_traj_planner.nodes.runs.answer import planned_text, refused_text
from rrr_traj_planner.nodes.runs.messages import plan_request, trajectory_points, way_to
from rrr_traj_planner.nodes.runs.planner_config import planner_config
from rrr_traj_planner.nodes.runs.recorded import in_order, recorded_motion
from rrr_traj_planner.nodes.runs.recording import run_recorder
from rrr_traj_planner.nodes.runs.run import Run
from rrr_traj_planner.nodes.runs.spun_node import SpunNode
from rrr_traj_planner.planners.registry import planner
from rrr_traj_planner_interfaces.srv import PlanTrajectory
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory

NODES = ('trajectory_planner', 'simulated_arm')

START_DELAY = 0.5      # s between sending a trajectory and its start
SETTLING_TIME = 0.5    # s that is recorded after the end
PROGRESS_PERIOD = 0.5  # s between two progress lines
AT_START = 1e-6        # rad, largest distance of a joint at which the motion can start
IN_JOINT_SPACE = 'cycloid'  # planner of the way to the start of a path of the tip


class Client(SpunNode):
    """A client of both nodes."""

    def __init__(self) -> None:
        super().__init__('demo')
        self._states: list[JointState] = []
        self.create_subscription(JointState, 'joint_states', self._states.append, 100)
        self._send = self.create_publisher(JointTrajectory, 'joint_trajectory', 10)
        self._plan = self.create_client(PlanTrajectory, 'plan_trajectory')

    def run(self, task: Task, ended: Callable[[], tuple[str, int] | None],
            bag: Bag | None = None) -> Run:
        """
        Plan a task and run it on the arm.

        Parameters
        ----------
        task : Task
            The via points.
        ended : callable
            Returns name and exit code of a node's process that has ended, else None.
        bag : Bag, optional
            Bag to record all topics in.

        Returns
        -------
        Run
            Request, plan and recorded motion.

        Raises
        ------
        StartError
            If a node does not appear or ends, or the plan is refused.
        KeyboardInterrupt
            After SIGINT or SIGTERM.

        """
        self.ended = ended
        print('waiting for planner and arm ...', flush=True)
        self.wait(lambda: len(self._claimed()) == len(NODES), 'planner and arm to start')
        self.wait(self._plan.service_is_ready, 'the planner')
        self.wait(lambda: self._states and self._send.get_subscription_count(), 'the arm')
        self.check_alone()
        if bag is not None:
            self.wait(run_recorder(self, bag).is_connected, 'the topics to record')
        config = planner_config(self, task.planner_id)
        task.check_frame(config.base_frame)
        response = self._planned(plan_request(task, config.model.joint_names))
        print(planned_text(response, task.planner_id or config.default_planner_id), flush=True)
        planned = trajectory_points(response.trajectory)
        self._go_to(planned.positions[0], task, config)
        start = self._execute(response.trajectory, 'executing')
        recorded, torque = recorded_motion(
            list(self._states), config.model.joint_names, start)
        return Run(task, config, response, planned, recorded, torque)

    def check_free(self) -> None:
        """
        Refuse to run if nodes of the same names run on this machine.

        Raises
        ------
        StartError
            If such a node is running.

        """
        for name in self._claimed():
            raise StartError(f'a node {name} is already running: {KEEP_APART}')

    def check_alone(self) -> None:
        """
        Refuse to run if nodes of the same names run on another machine: all would respond.

        Raises
        ------
        StartError
            If two nodes of the same name are found, or two users of a topic that has only one.

        """
        names = self.get_node_names_and_namespaces()
        found = {
            'nodes named ' + node: names.count((node, self.get_namespace())) for node in NODES}
        found['subscriptions of joint_trajectory'] = self._send.get_subscription_count()
        found['publishers of joint_states'] = self.count_publishers('joint_states')
        more = ', '.join(f'{n} {what}' for what, n in found.items() if n > 1)
        if more:
            raise StartError(f'another planner or arm is running here ({more}): {KEEP_APART}')

    def _claimed(self) -> list[str]:
        """Return which of the two nodes run on this machine."""
        prefix, domain = self.get_namespace().rstrip('/'), self.context.get_domain_id()
        names = [f'{prefix}/{node}' for node in NODES]
        return [name for name in names if is_claimed(domain, name)]

    def _go_to(self, q: Array, task: Task, config: PlannerConfig) -> None:
        """Move the arm to where the motion begins [rad], if it is elsewhere."""
        state = self._states[-1]
        now = in_order([state], config.model.joint_names, 'position')[0]
        if np.abs(now - q).max() <= AT_START:
            return
        planner_id = task.planner_id or config.default_planner_id
        if planner(planner_id).plan_path is not None:
            planner_id = IN_JOINT_SPACE
        way = self._planned(way_to(q, state, planner_id)).trajectory
        self._execute(way, 'moving to the first via point')

    def _planned(self, request: PlanTrajectory.Request) -> Any:
        response = self.answer(self._plan, request)
        if response.error_code != response.SUCCESS:
            raise StartError(refused_text(response))
        return response

    def _execute(self, trajectory: JointTrajectory, what: str) -> float:
        """Send a trajectory, wait for its end, and return its start time [s]."""
        start = self.get_clock().now().nanoseconds + int(START_DELAY * 1e9)
        trajectory.header.stamp = Time(nanoseconds=start).to_msg()
        duration = seconds(trajectory.points[-1].time_from_start)
        self._states.clear()
        self._send.publish(trajectory)
        shown = -1.0
        begin = start * 1e-9

        def finished() -> bool:
            nonlocal shown
            now = seconds(self._states[-1].header.stamp) - begin if self._states else -START_DELAY
            if now - shown >= PROGRESS_PERIOD and now >= 0.0 and shown < duration:
                shown = now
                print(f'{what}: {min(now, duration):5.2f} of {duration:.2f} s', flush=True)
            return now >= duration + SETTLING_TIME

        # On a busy machine simulated time lags behind the clock: wait as long as it advances.
        self.wait(finished, 'the arm to continue',
                  lambda: self._states and seconds(self._states[-1].header.stamp))
        return begin
