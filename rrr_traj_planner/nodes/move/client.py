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

"""The client of `move`: plans from where an arm is, and has its controller run the plan."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
import sys
from time import monotonic, sleep

import numpy as np
from rclpy.action import get_action_names_and_types
from rrr_traj_planner.core.nanoseconds import SECOND
from rrr_traj_planner.nodes.motion.departure import duration_of
from rrr_traj_planner.nodes.motion.motion import EndCode, Motion, Watch
from rrr_traj_planner.nodes.motion.motions import Motions
from rrr_traj_planner.nodes.motion.options import controller_of, Options
from rrr_traj_planner.nodes.move.from_here import from_here, FromHere, in_base_frame
from rrr_traj_planner.nodes.move.progress import ProgressLines
from rrr_traj_planner.nodes.move.state_record import StateRecord
from rrr_traj_planner.nodes.parameters.configuration import PlannerConfig
from rrr_traj_planner.nodes.point_files.task import Task
from rrr_traj_planner.nodes.process.entry import StartError
from rrr_traj_planner.nodes.recording.bag import Bag
from rrr_traj_planner.nodes.runs.answer import planned_text, refused_text
from rrr_traj_planner.nodes.runs.messages import plan_request, trajectory_points
from rrr_traj_planner.nodes.runs.planner_config import planner_config
from rrr_traj_planner.nodes.runs.recorded import recorded_motion
from rrr_traj_planner.nodes.runs.recording import run_recorder
from rrr_traj_planner.nodes.runs.run import Run
from rrr_traj_planner.nodes.runs.spun_node import pause, POLL_PERIOD, SpunNode
from rrr_traj_planner_interfaces.srv import PlanTrajectory

CANCEL_TIME = 1.0    # s for the controller to say that it has canceled the goal
SETTLING_TIME = 0.5  # s that is recorded after the end
STATES_TIME = 5.0    # s by which states may be late
DISCOVERY_TIME = 6.0  # s in which who publishes states is found; DDS announces itself every 3 s
TYPE = 'control_msgs/action/FollowJointTrajectory'

NO_STATE = 'nobody publishes where the arm is: planned from rest at the first via point'


class MoveClient(SpunNode):
    """
    A client of the planner and of a trajectory controller.

    Parameters
    ----------
    controller : str
        The controller's name, or its action's.

    """

    def __init__(self, controller: str) -> None:
        name = controller_of(controller, '--controller')
        super().__init__('move')
        self._motions = Motions(self, Options(controller=name))
        self._record = StateRecord(self, name)
        self._plan = self.create_client(PlanTrajectory, 'plan_trajectory')

    def destroy_node(self) -> None:
        """Release the action's client too."""
        self._motions.close()
        super().destroy_node()

    def dry_run(self, task: Task) -> tuple[PlanTrajectory.Response, PlannerConfig]:
        """
        Plan a task from where the arm is, or from its first via point if nobody publishes that.

        Parameters
        ----------
        task : Task
            The via points.

        Returns
        -------
        response : PlanTrajectory.Response
            The planner's answer.
        config : PlannerConfig
            The planner's configuration.

        Raises
        ------
        StartError
            If there is no answer.
        KeyboardInterrupt
            After SIGINT or SIGTERM.

        """
        self.wait_for_all(partial(self._missing_to_plan, monotonic() + DISCOVERY_TIME))
        config = planner_config(self, task.planner_id)
        asked = self._from_here(task, config)
        if self.in_executor(self._motions.states.latest) is None:
            print(NO_STATE, flush=True)
            return self.answer(self._plan, _request(asked, config)), config
        motion = self._moved(asked, config, Watch(), sends=False)
        if motion.response is None:
            raise StartError(_reason(motion, asked))
        return motion.response, config

    def run(self, task: Task, bag: Bag | None = None) -> Run | None:
        """
        Plan a task from where the arm is, and have the controller run the plan.

        Parameters
        ----------
        task : Task
            The via points.
        bag : Bag, optional
            Bag to record all topics in.

        Returns
        -------
        Run or None
            Task, plan and recorded motion; None: nobody has published what the arm did.

        Raises
        ------
        StartError
            If the plan is refused, or the motion does not reach its end.
        KeyboardInterrupt
            After SIGINT or SIGTERM; a motion in progress has been canceled.

        """
        self.wait_for_all(self._missing)
        if bag is not None:
            self.wait(run_recorder(self, bag).is_connected, 'the topics to record')
        config = planner_config(self, task.planner_id)
        asked = self._from_here(task, config)

        def planned(motion: Motion) -> None:
            self._record.begin()
            print(planned_text(
                motion.response, asked.task.planner_id or config.default_planner_id), flush=True)

        motion = self._moved(
            asked, config, Watch(planned, ProgressLines(asked.skipped).show), sends=True)
        if motion.end is None or motion.end.code != EndCode.SUCCESS:
            raise StartError(_reason(motion, asked))
        return self._recorded_run(task, asked, config, motion)

    def _missing(self) -> list[str]:
        """Return what a motion needs; with other controllers where the one asked for is not."""
        found, action = self._motions.missing(), self._motions.action
        others = [name for name, types in get_action_names_and_types(self)
                  if TYPE in types and name != action
                  and self.count_publishers(f'{name}/_action/feedback')]
        return [f'{text[:-1]}; there is {", ".join(sorted(others))})' if others and action in text
                else text for text in found]

    def _missing_to_plan(self, grace: float) -> list[str]:
        """Return what a plan needs; the arm's state only if somebody publishes it."""
        found = self._motions.missing(sends=False)
        published = any(map(self.count_publishers, self._motions.states.sources))
        if self._plan.service_is_ready() and not published and monotonic() > grace:
            return []
        return found

    def _from_here(self, task: Task, config: PlannerConfig) -> FromHere:
        """Return what to ask the planner for, and print notes about that."""
        asked = from_here(task, config, self.in_executor(self._motions.states.latest),
                          self._motions.options.start_tolerance)
        for note in asked.notes:
            print(note, flush=True)
        return asked

    def _moved(self, asked: FromHere, config: PlannerConfig, watch: Watch, sends: bool) -> Motion:
        """Return a motion that has ended; after a signal, cancel it."""
        motion = self.in_executor(
            lambda: self._motions.move(_request(asked, config), watch, sends))
        try:
            while self.in_executor(lambda: motion.end) is None:
                pause()
        except KeyboardInterrupt:
            self._cancel(motion)
            raise
        return motion

    def _cancel(self, motion: Motion) -> None:
        """Have the controller stop the arm, and wait until it says so, but not for long."""
        print('canceling', flush=True)
        self.executor.create_task(self._motions.cancel, motion)
        deadline = monotonic() + CANCEL_TIME
        while motion.end is None and monotonic() < deadline:
            sleep(POLL_PERIOD)
        if motion.end is None:
            print(f'move: the controller has not confirmed that in {CANCEL_TIME:g} s: the arm may '
                  'go on moving', file=sys.stderr, flush=True)
        else:
            print('the controller stops the arm' if motion.goal is not None else 'not sent',
                  flush=True)

    def _recorded_run(self, task: Task, asked: FromHere, config: PlannerConfig,
                      motion: Motion) -> Run | None:
        """Return the run of a motion that has reached its end, once the arm has settled."""
        response, planned = motion.response, trajectory_points(motion.response.trajectory)
        end = motion.begins + duration_of(response.trajectory) + round(SETTLING_TIME * SECOND)
        self._wait_for_states(lambda: self._record.has_since(end))
        names = config.model.joint_names
        states = self._record.states(names)
        if len(states) < 2:
            return None
        recorded, torque = recorded_motion(states, names, motion.begins / SECOND)
        if asked.skipped:
            response.via_times = [0.0, *response.via_times]
        at = [int(np.abs(planned.times - t).argmin()) for t in response.via_times]
        in_base = in_base_frame(task if asked.skipped else asked.task, config,
                                planned.positions[at])
        return Run(in_base, config, response, planned, recorded, torque, not asked.skipped)

    def _wait_for_states(self, ready: Callable[[], bool]) -> None:
        """Wait for states, which may come late or have stopped."""
        deadline = monotonic() + STATES_TIME
        while not ready() and monotonic() < deadline:
            pause()


def _request(asked: FromHere, config: PlannerConfig) -> PlanTrajectory.Request:
    return plan_request(asked.task, config.model.joint_names)


def _reason(motion: Motion, asked: FromHere) -> str:
    """Return why a motion has not reached its end."""
    response, end = motion.response, motion.end
    if end is None:
        return 'no answer'
    if response is not None and response.error_code != response.SUCCESS:
        return refused_text(response) + (
            ' (here via points are counted from 0 after the one that is left out)'
            if asked.skipped and response.failed_via_point >= 0 else '')
    return str(end.text)
