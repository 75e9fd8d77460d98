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

"""
Plans motions from where the arm is, and has a trajectory controller run them, one after another.

Nothing waits: all goes on in callbacks of the node's executor.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from time import monotonic

from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from rclpy.task import Future
from rrr_traj_planner.core.nanoseconds import SECOND
from rrr_traj_planner.nodes.motion.arm_states import ArmStates
from rrr_traj_planner.nodes.motion.controller import Controller, REPLACED
from rrr_traj_planner.nodes.motion.departure import (
    Departure,
    departure,
    moved,
    TooLateError,
)
from rrr_traj_planner.nodes.motion.motion import CANCELED, EndCode, Motion, MotionEnd, Watch
from rrr_traj_planner.nodes.motion.options import Options
from rrr_traj_planner_interfaces.srv import PlanTrajectory

IN_MOTION = 'time_optimal'  # the planner that plans from any state
RETRY_PERIOD = 0.05  # s between two attempts to join a motion
RETRY_TIME = 5.0     # s since the motion was asked for, after which there is none
CHECK_PERIOD = 0.5   # s between two checks whether planner and controller are still there
TELL_PERIOD = 0.1    # s between two estimates of where the motion is, without feedback

# A trajectory has its start time: a controller by another clock would wait for years, or be late.
CLOCKS_DIFFER = 5.0  # s by which states may be late where simulated time lags behind
WRONG_TIME = ("the arm's time (its states are stamped by another clock than this one; "
              'use_sim_time must be the same for controller and this node)')
UNKNOWN_STATE = 'the state of the arm is not known any more'


class Motions:
    """
    Plans and runs motions.

    A motion that is asked for while another is in progress takes over from it without a stop; if
    it is refused, the one in progress goes on. One is planned at a time; the newest waits.

    Parameters
    ----------
    node : Node
        The node. Its executor's thread calls all methods, or they are called before it spins.
    options : Options
        Controller, lead and tolerance.

    """

    def __init__(self, node: Node, options: Options) -> None:
        self._node, self.options = node, options
        self._clock, self._steady = node.get_clock(), Clock(clock_type=ClockType.STEADY_TIME)
        self._planner = node.create_client(PlanTrajectory, 'plan_trajectory')
        self._service = node.resolve_service_name('plan_trajectory')
        self._controller = Controller(node, options.controller, self._continue)
        self.action = self._controller.action
        self.states = ArmStates(node, options.controller)
        self._current: Motion | None = None  # before it is sent
        self._waiting: Motion | None = None  # the newest that is to be planned afterwards
        self._asked_at: float | None = None  # the planner, whose answer is to come
        self._timers = [node.create_timer(period, call, clock=self._steady) for period, call in (
            (CHECK_PERIOD, self._check), (TELL_PERIOD, self._tell))]

    def missing(self, sends: bool = True) -> list[str]:
        """
        Return what is not there.

        Parameters
        ----------
        sends : bool
            Whether a controller is needed.

        Returns
        -------
        list of str
            Empty if motions can be planned and run.

        """
        found = []
        if not self._planner.service_is_ready():
            found.append(f'the planner (service {self._service})')
        if sends and not self._controller.is_there():
            found.append(f'the controller (action {self.action})')
        latest = self.states.latest()
        if latest is None:
            found.append(f"the arm's state (topic {' or '.join(self.states.sources)})")
        elif sends and abs(latest.stamp - self._now()) > CLOCKS_DIFFER * SECOND:
            found.append(WRONG_TIME)
        return found

    def move(self, request: PlanTrajectory.Request, watch: Watch, sends: bool = True) -> Motion:
        """
        Plan a motion, and run it; it replaces one whose planning has not begun yet.

        Parameters
        ----------
        request : PlanTrajectory.Request
            Without start state.
        watch : Watch
            Is told how the motion goes on; its `ended` may be called at once.
        sends : bool
            Whether the plan is run; False: it ends with `planned`.

        Returns
        -------
        Motion
            For `cancel`.

        """
        motion = Motion(request, watch, sends)
        replaced, self._waiting = self._waiting, motion
        if replaced is not None:
            replaced.finish(REPLACED)
        self._continue()
        return motion

    def cancel(self, motion: Motion) -> None:
        """
        End a motion before its time: the controller stops the arm if it is in progress.

        Parameters
        ----------
        motion : Motion
            Nothing happens if it has ended.

        """
        if motion in (self._current, self._waiting):
            self._finish(motion, CANCELED)
        else:
            self._controller.cancel(motion)

    def close(self) -> None:
        """Release the action's client, which would keep the node alive."""
        for timer in self._timers:
            timer.cancel()
        self._controller.close()

    def _begin(self, motion: Motion) -> None:
        """Plan a motion as soon as all is there."""
        if motion is not self._current:
            return
        missing = self.missing(motion.sends)
        if not missing:
            self._plan(motion, self.options.lead)
        elif monotonic() < motion.since + self.options.discovery_timeout:
            self._later(partial(self._begin, motion))
        else:
            self._finish(motion, MotionEnd(
                EndCode.COMMUNICATION_FAILURE, f'not there: {", ".join(missing)}'))

    def _plan(self, motion: Motion, lead: float) -> None:
        """Ask the planner for a motion from where the arm is."""
        if motion is not self._current:
            return
        latest = self.states.latest()
        if latest is None:
            self._finish(motion, MotionEnd(EndCode.COMMUNICATION_FAILURE, UNKNOWN_STATE))
            return
        running = self._controller.running
        begin = departure(latest, None if running is None or running.canceled else running,
                          self._now(), round(lead * SECOND))
        request = motion.request
        asked = request.planner_id
        request.start_state, request.start_acceleration = begin.state.message()
        if begin.state.is_moving and not asked:
            request.planner_id = IN_MOTION
        answer = self._planner.call_async(request)
        request.planner_id = asked
        self._asked_at = monotonic()
        answer.add_done_callback(partial(self._planned, motion, begin, lead))

    def _planned(self, motion: Motion, begin: Departure, lead: float, answer: Future) -> None:
        """Send a motion to the controller, or tell that the planner refuses."""
        if motion is not self._current:
            return
        self._asked_at = None
        motion.response = response = answer.result()
        if response.error_code != response.SUCCESS:
            end = MotionEnd(response.error_code, response.message, response.failed_via_point)
            if response.error_code == response.START_STATE_INVALID and begin.is_estimate:
                self._again(motion, lead, end)
            else:
                self._finish(motion, end)
        elif motion.sends:
            self._send(motion, begin, lead)
        else:
            motion.watch.planned(motion)
            self._finish(motion, MotionEnd(EndCode.SUCCESS, response.message))

    def _send(self, motion: Motion, begin: Departure, lead: float) -> None:
        """Send a plan to the controller, if the arm is still where it begins."""
        plan, latest = motion.response.trajectory, self.states.latest()
        if begin.running is None and not begin.is_estimate:
            gone = UNKNOWN_STATE if latest is None else moved(
                plan, latest, self.options.start_tolerance)
            if gone:
                self._finish(motion, MotionEnd(EndCode.START_STATE_INVALID, gone))
                return
        try:
            motion.trajectory, motion.begins = begin.joined(
                plan, self._controller.running, self._now())
        except TooLateError as error:
            self._again(motion, 2.0 * lead, MotionEnd(EndCode.START_STATE_INVALID, str(error)))
            return
        motion.watch.planned(motion)
        self._current = None
        self._controller.send(motion, partial(self._rejected, motion, begin, lead))

    def _again(self, motion: Motion, lead: float, end: MotionEnd) -> None:
        """Plan a motion again a little later; after `RETRY_TIME` it has ended."""
        if monotonic() > motion.since + RETRY_TIME or motion is not self._current:
            self._finish(motion, end)
        else:
            self._later(partial(self._plan, motion, lead))

    def _rejected(self, motion: Motion, begin: Departure, lead: float, end: MotionEnd) -> None:
        """End a motion that the controller rejects, or try again if it began at an estimate."""
        if begin.is_estimate and not motion.canceled:
            self._current = motion
            self._again(motion, lead, end)
        else:
            motion.finish(end)

    def _continue(self) -> None:
        """Plan the motion that waits, unless one is planned or sent now."""
        if self._waiting is not None and self._current is None and not self._controller.is_sending:
            self._current, self._waiting = self._waiting, None
            self._begin(self._current)

    def _finish(self, motion: Motion, end: MotionEnd) -> None:
        """End a motion that is not sent."""
        if motion is self._current:
            self._current = self._asked_at = None
        else:
            self._waiting = None
        motion.finish(end)
        self._continue()

    def _check(self) -> None:
        """End motions for which the planner or the controller has gone."""
        if self._current is not None and self._asked_at is not None:
            timeout = self.options.planning_timeout
            gone = not self._planner.service_is_ready()
            if gone or monotonic() > self._asked_at + timeout:
                self._finish(self._current, MotionEnd(
                    EndCode.COMMUNICATION_FAILURE, f'the planner (service {self._service}) has '
                    + ('gone' if gone else f'not answered for {timeout:g} s')))
        self._controller.check()

    def _tell(self) -> None:
        """Tell where the motion is if the controller does not, while the arm's state comes."""
        if self.states.latest() is not None:
            self._controller.estimate(self._now())

    def _later(self, call: Callable[[], None]) -> None:
        """Call a function a little later."""
        def once() -> None:
            self._node.destroy_timer(timer)
            call()

        timer = self._node.create_timer(RETRY_PERIOD, once, clock=self._steady)

    def _now(self) -> int:
        return int(self._clock.now().nanoseconds)
