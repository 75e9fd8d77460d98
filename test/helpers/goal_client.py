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

"""A client of the arm's action, and goals for it."""

from __future__ import annotations

from threading import Event

from control_msgs.action import FollowJointTrajectory
from control_msgs.msg import JointTolerance
from helpers.arm_in_ros import duration, NAMES, trajectory_message

DEADLINE = 20.0  # s


def goal(*points, names=NAMES, stamp=0, path=(), end=(), goal_time=0.0):
    """Return a goal of points, as of `Arm.send`; tolerances: joint, position, velocity."""
    return FollowJointTrajectory.Goal(
        trajectory=trajectory_message(*points, names=names, stamp=stamp),
        path_tolerance=[tolerance(*t) for t in path],
        goal_tolerance=[tolerance(*t) for t in end],
        goal_time_tolerance=duration(goal_time))


def tolerance(joint, position=0.0, velocity=0.0):
    return JointTolerance(name=joint, position=position, velocity=velocity)


class GoalClient:
    """Sends goals to an arm; everything is waited for, with a deadline."""

    def __init__(self, ros, name='simulated_arm/follow_joint_trajectory'):
        self._run = ros.run
        self._client = ros.action_client(FollowJointTrajectory, name)

    def send(self, message, feedback=None, goal_id=None):
        """Return the handle of a goal; feedback messages are appended to a list."""
        take = None if feedback is None else lambda m: feedback.append(m.feedback)
        return waited_for(self._run(self._client.send_goal_async, message, take, goal_id))

    def result_to_come(self, handle):
        """Return the future of the response with a goal's result."""
        return self._run(handle.get_result_async)

    def result(self, handle):
        """Return status, code and text of a goal's end, which may be to come."""
        response = waited_for(self.result_to_come(handle))
        return response.status, response.result.error_code, response.result.error_string

    def run(self, message):
        """Send a goal, and return how it ends."""
        return self.result(self.send(message))

    def cancel(self, handle):
        """Ask for a goal's end; return how many goals are canceled."""
        return len(waited_for(self._run(handle.cancel_goal_async)).goals_canceling)


def waited_for(future):
    """Return a future's result; fail at the deadline."""
    done = Event()
    future.add_done_callback(lambda _: done.set())
    assert done.wait(DEADLINE), 'no answer'
    return future.result()
