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

"""A running motion server for tests, a client of its action, and goals for it."""

from __future__ import annotations

from threading import Event

from helpers.arm_in_ros import NAMES
from helpers.goal_client import waited_for
from helpers.plan_requests import plan_request
from rclpy.parameter import Parameter
from rrr_traj_planner.nodes.motion_server.node import MotionServer
from rrr_traj_planner_interfaces.action import MoveThrough


def start_motion_server(ros, **overrides):
    return ros.add(MotionServer(context=ros.context, parameter_overrides=[
        Parameter(name, value=value) for name, value in overrides.items()]))


def move_goal(*points, **fields):
    """Return a goal through tip positions [m]."""
    return MoveThrough.Goal(via_points=plan_request(points).via_points, **fields)


class MoveClient:
    """Sends goals to a motion server; everything is waited for, with a deadline."""

    def __init__(self, ros, name='move_through'):
        self._run = ros.run
        self._client = ros.action_client(MoveThrough, name)

    def send(self, goal, feedback=None):
        """Return the handle of an accepted goal; feedback is appended to a list."""
        take = None if feedback is None else lambda m: feedback.append(m.feedback)
        handle = waited_for(self._run(self._client.send_goal_async, goal, take))
        assert handle.accepted
        return handle

    def result_to_come(self, handle):
        """Return the future of the response with a goal's result."""
        return self._run(handle.get_result_async)

    def result(self, handle):
        """Return status and result of a goal's end, which may be to come."""
        response = waited_for(self.result_to_come(handle))
        return response.status, response.result

    def result_while(self, handle, go_on):
        """Return the same, calling a function again and again until it is there."""
        over, future = Event(), self.result_to_come(handle)
        future.add_done_callback(lambda _: over.set())
        while not over.is_set():
            go_on()
        return future.result().status, future.result().result

    def run(self, goal):
        """Send a goal, and return how it ends."""
        return self.result(self.send(goal))

    def cancel(self, handle):
        """Ask for a goal's end; return how many goals are canceled."""
        return len(waited_for(self._run(handle.cancel_goal_async)).goals_canceling)


def joints_of(message):
    """Return a joint state's positions in the arm's order."""
    return [message.position[list(message.name).index(name)] for name in NAMES]
