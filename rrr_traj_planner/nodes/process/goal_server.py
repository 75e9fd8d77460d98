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
An action server whose goals are ended from outside, such as by a timer.

rclpy's server (Jazzy) runs a coroutine for each goal, and its executor spins without a pause while
one waits. Here there is none: `begin` takes a goal, and whoever knows its end calls `end`. Other
differences: a refused goal has a result, for clients that ask for it; a response that is dropped
because the client has not been discovered wholly is sent again, where rclpy forgets the goal that
it has accepted; a client that is gone ends no spin; requests are let go of with the goal's end.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from traceback import format_exc
from typing import Any

from action_msgs.msg import GoalInfo, GoalStatus
from rclpy.action.server import ActionServer, GoalEvent, RCLError, ServerGoalHandle
from rclpy.node import Node
from rrr_traj_planner.nodes.process.responses import send_until_discovered

RESULT_TIMEOUT = 10  # s by the node's clock for which results are kept, rclcpp's default
REFUSALS = 100       # whose results are kept

SUCCEEDED, ABORTED, CANCELED = GoalEvent.SUCCEED, GoalEvent.ABORT, GoalEvent.CANCELED


class RefusedGoal(Exception):  # noqa: N818  an answer rather than an error
    """
    Raised to refuse a goal.

    Parameters
    ----------
    result : Result
        For clients that ask for the result of the refused goal: its status is UNKNOWN.

    """

    def __init__(self, result: Any) -> None:
        super().__init__(result)
        self.result = result


class GoalServer(ActionServer):
    """
    Serves an action.

    Parameters
    ----------
    node : Node
        The node.
    action_type : type
        The action.
    name : str
        Its name.
    check : callable
        Gets a goal message; returns what `begin` needs, or raises `RefusedGoal`.
    begin : callable
        Gets the handle of an accepted goal, which executes already, and what `check` returned.
    cancel : callable
        Gets the handle of a goal that is to be canceled, stops what it does, and returns its
        result.

    Notes
    -----
    An exception that leaves a callback is logged: it refuses the goal, aborts it, or leaves the
    result of a canceled one empty. Else it would end the spin.

    """

    def __init__(self, node: Node, action_type: Any, name: str, check: Callable[[Any], Any],
                 begin: Callable[[ServerGoalHandle, Any], None],
                 cancel: Callable[[ServerGoalHandle], Any]) -> None:
        self._check, self._begin, self._cancel = check, begin, cancel
        self._name = node.resolve_service_name(name)
        self._results: dict[bytes, Any] = {}      # responses about goals that have ended
        self._waiting: dict[bytes, list[Any]] = {}  # headers of requests for results to come
        self._told: set[bytes] = set()            # goals whose results have been sent
        super().__init__(node, action_type, name, lambda _: None, result_timeout=RESULT_TIMEOUT)

    def end(self, handle: ServerGoalHandle, event: GoalEvent, result: Any) -> None:
        """
        End a goal.

        Parameters
        ----------
        handle : ServerGoalHandle
            The goal, which has not ended yet.
        event : GoalEvent
            `SUCCEEDED`, `ABORTED` or, from `cancel` only, `CANCELED`.
        result : Result
            Its result.

        """
        key = bytes(handle.goal_id.uuid)
        handle._update_state(event)
        handle._goal_request = None  # may be long
        self._results[key] = self._action_type.Impl.GetResultService.Response(
            status=handle.status, result=result)
        for header in self._waiting.pop(key, ()):
            self._send_result(header, key)

    def has_told(self, handle: ServerGoalHandle) -> bool:
        """
        Return whether a goal's result has been sent to a client.

        Parameters
        ----------
        handle : ServerGoalHandle
            The goal.

        Returns
        -------
        bool
            False as long as no client has asked for it.

        """
        return bytes(handle.goal_id.uuid) in self._told

    async def _execute_goal_request(self, request_header_and_message: Any) -> None:
        """Accept or refuse a goal."""
        header, request = request_header_and_message
        info = GoalInfo(goal_id=request.goal_id, stamp=self._node.get_clock().now().to_msg())
        handle, key = None, bytes(request.goal_id.uuid)
        if not self._handle.goal_exists(info):
            try:
                checked = self._check(request.goal)
                handle = self._goal_handles[key] = ServerGoalHandle(self, info, request.goal)
                self._results.pop(key, None)  # of a refused goal of this id
            except RefusedGoal as refusal:
                self._keep_refusal(key, refusal.result)
            except Exception:
                self._node.get_logger().error(f'goal refused after an error: {format_exc()}')
        self._send('goal', header, self._action_type.Impl.SendGoalService.Response(
            accepted=handle is not None, stamp=info.stamp))
        if handle is not None:
            self._handle.publish_status()
            handle._update_state(GoalEvent.EXECUTE)
            self._guarded(self._begin, handle, checked)

    def _guarded(self, function: Callable[..., Any], handle: ServerGoalHandle, *more: Any) -> Any:
        """Return what a callback returns; an empty result if it fails, which aborts the goal."""
        try:
            return function(handle, *more)
        except Exception:
            self._node.get_logger().error(f'goal aborted after an error: {format_exc()}')
            nothing = self._action_type.Result()
            if handle.status == GoalStatus.STATUS_EXECUTING:
                self.end(handle, ABORTED, nothing)
            return nothing

    def _keep_refusal(self, key: bytes, result: Any) -> None:
        """Keep the result of a refused goal, among the last `REFUSALS`."""
        refusals = [k for k in self._results if k not in self._goal_handles]
        for old in refusals[:max(len(refusals) + 1 - REFUSALS, 0)]:
            del self._results[old]
        self._results[key] = self._action_type.Impl.GetResultService.Response(
            status=GoalStatus.STATUS_UNKNOWN, result=result)

    async def _execute_cancel_request(self, request_header_and_message: Any) -> None:
        """Cancel the goals that a request means."""
        header, request = request_header_and_message
        response = self._handle.process_cancel_request(
            request, self._action_type.Impl.CancelGoalService.Response)
        canceled = []
        for info in response.goals_canceling:
            handle = self._goal_handles[bytes(info.goal_id.uuid)]
            handle._update_state(GoalEvent.CANCEL_GOAL)
            canceled.append((handle, self._guarded(self._cancel, handle)))
        self._send('cancel', header, response)
        for handle, result in canceled:
            self.end(handle, CANCELED, result)

    async def _execute_get_result_request(self, request_header_and_message: Any) -> None:
        """Send a goal's result, now or as soon as there is one."""
        header, request = request_header_and_message
        key = bytes(request.goal_id.uuid)
        if key in self._goal_handles and key not in self._results:
            self._waiting.setdefault(key, []).append(header)
            return
        self._send_result(header, key)

    def _send_result(self, header: Any, key: bytes) -> None:
        """Send a goal's result; that of an unknown goal is empty."""
        known = key in self._results
        self._send('result', header, self._results[key] if known else
                   self._action_type.Impl.GetResultService.Response(
                       status=GoalStatus.STATUS_UNKNOWN),
                   partial(self._told.add, key) if key in self._goal_handles else None)

    async def _execute_expire_goals(self, expired_goals: Any) -> None:
        """Forget goals that ended long ago."""
        for info in expired_goals:
            key = bytes(info.goal_id.uuid)
            self._goal_handles.pop(key).destroy()
            self._results.pop(key, None)
            self._told.discard(key)

    def _send(self, kind: str, header: Any, response: Any,
              sent: Callable[[], None] | None = None) -> None:
        """Send a response, again if it is dropped; then call `sent`."""
        send = getattr(self._handle, f'send_{kind}_response')

        def goes_out() -> bool:
            out = _goes_out(send, header, response)
            if out and sent is not None:
                sent()
            return out

        send_until_discovered(self._node, f'{self._name} ({kind})', goes_out)


def _goes_out(send: Callable[[Any, Any], None], header: Any, response: Any) -> bool:
    """Send a response, and return whether it was not dropped."""
    try:
        send(header, response)
    except RCLError:
        return False
    return True
