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

"""A node that an executor spins in the background, while the main thread waits."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from functools import partial
from time import monotonic, sleep
from typing import Any, TypeVar

from rclpy.client import Client as ServiceClient
from rclpy.node import Node
from rrr_traj_planner.nodes.process.entry import StartError
from rrr_traj_planner.nodes.process.processes import exit_message
from rrr_traj_planner.nodes.process.signals import signal_arrived

POLL_PERIOD = 0.02  # s between two checks of a condition that is waited for
GRACE = 2.0         # s in which nodes that run are found, before missing ones are named
TIMEOUT = 20.0      # s for what should take no time, or between two signs of progress

Value = TypeVar('Value')


class SpunNode(Node):
    """
    A node whose methods are called from the main thread.

    They raise `KeyboardInterrupt` after SIGINT or SIGTERM.

    Attributes
    ----------
    ended : callable
        Returns name and exit code of a process that is needed and has ended, else None.

    """

    ended: Callable[[], tuple[str, int] | None] = staticmethod(lambda: None)

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self._posted: deque[Callable[[], Any]] = deque()

    def post(self, function: Callable[..., Any], *args: Any) -> None:
        """
        Call a function in the executor's thread, after those that were posted before.

        rclpy's executor begins the newest of its tasks first.

        Parameters
        ----------
        function : callable
            The function.
        *args
            Its arguments.

        """
        self._posted.append(partial(function, *args))
        self.executor.create_task(lambda: self._posted.popleft()())

    def check_processes(self) -> None:
        """
        Refuse to go on without a process.

        Raises
        ------
        StartError
            If one has ended.

        """
        ended = self.ended()
        if ended is not None:
            raise StartError(exit_message(*ended))

    def in_executor(self, function: Callable[[], Value]) -> Value:
        """
        Call a function in the executor's thread.

        Parameters
        ----------
        function : callable
            The function.

        Returns
        -------
        object
            What it returns.

        """
        task = self.executor.create_task(function)
        self.wait(task.done, 'the executor')
        result: Value = task.result()
        return result

    def answer(self, client: ServiceClient, request: Any) -> Any:
        """
        Return a service's answer.

        Parameters
        ----------
        client : Client
            Of the service.
        request : Request
            For the service.

        Returns
        -------
        Response
            The answer.

        Raises
        ------
        StartError
            If there is none.

        """
        self.wait(client.service_is_ready, f'the service {client.srv_name}')
        future = client.call_async(request)
        self.wait(future.done, f'an answer of {client.srv_name}')
        return future.result()

    def wait_for_all(self, missing: Callable[[], list[str]]) -> None:
        """
        Wait until nothing is missing, and print a line about what is.

        Parameters
        ----------
        missing : callable
            Returns what is missing, in words; called in the executor's thread.

        Raises
        ------
        StartError
            If a process that is needed has ended.

        """
        begin, said = monotonic(), None
        while found := self.in_executor(missing):
            if found != said and monotonic() > begin + GRACE:
                print(f'waiting for {", ".join(found)} ...', flush=True)
                said = found
            self.check_processes()
            pause()

    def wait(self, ready: Callable[[], Any], what: str,
             progress: Callable[[], Any] = lambda: None) -> None:
        """
        Wait for something that should come.

        Parameters
        ----------
        ready : callable
            Whether it is there.
        what : str
            For the message if it does not come.
        progress : callable
            What changes as long as it is worth waiting.

        Raises
        ------
        StartError
            If it does not come for `TIMEOUT` without progress, or a process has ended.

        """
        reached, deadline = progress(), monotonic() + TIMEOUT
        while not ready():
            if progress() != reached:
                reached, deadline = progress(), monotonic() + TIMEOUT
            self.check_processes()
            if monotonic() > deadline:
                raise StartError(f'timed out after {TIMEOUT:.0f} s waiting for {what}')
            pause()


def pause() -> None:
    """Let a little time pass; raise KeyboardInterrupt after a signal."""
    if signal_arrived():
        raise KeyboardInterrupt
    sleep(POLL_PERIOD)
