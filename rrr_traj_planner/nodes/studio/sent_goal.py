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

"""A goal of the motion server's that is on its way, or in progress."""

from __future__ import annotations

from rclpy.action.client import ClientGoalHandle


class SentGoal:
    """A goal of the motion server's, which can be ended before its time."""

    def __init__(self) -> None:
        self._handle: ClientGoalHandle | None = None
        self._is_canceled = False

    def cancel(self) -> None:
        """Have the arm stopped, at the latest when the goal is accepted."""
        self._is_canceled = True
        if self._handle is not None:
            self._handle.cancel_goal_async()

    def accepted(self, handle: ClientGoalHandle) -> None:
        """
        Take the server's handle.

        Parameters
        ----------
        handle : ClientGoalHandle
            Of the accepted goal.

        """
        self._handle = handle
        if self._is_canceled:
            handle.cancel_goal_async()
