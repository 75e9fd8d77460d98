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


"""A thread for what takes long, so that a node answers all else meanwhile."""

from __future__ import annotations

from collections.abc import Callable
from queue import SimpleQueue
from threading import Lock, Thread
from typing import Any

from rclpy.node import Node
from rclpy.task import Future

PATIENCE = 1.0  # s


class BackgroundThread:
    """
    Calls one function after another; callbacks of the node await what they return.

    Parameters
    ----------
    node : Node
        Its executor is woken when a function has returned.
    name : str
        The thread's.

    """

    def __init__(self, node: Node, name: str) -> None:
        self._calls: SimpleQueue[tuple[Callable[..., Any], tuple[Any, ...], Future] | None]
        self._calls = SimpleQueue()
        self._returned = node.create_guard_condition(lambda: None)  # wakes the executor
        self._ending, self._ended = Lock(), False
        self._thread = Thread(target=self._run, name=name, daemon=True)
        self._thread.start()

    def call(self, function: Callable[..., Any], *arguments: Any) -> Future:
        """
        Call a function when those before it have returned.

        Parameters
        ----------
        function : callable
            What takes long.
        *arguments
            Its arguments.

        Returns
        -------
        Future
            What it returns or raises, once it has and unless the thread is ended before.

        """
        done = Future()
        self._calls.put((function, arguments, done))
        return done

    def is_ending(self) -> bool:
        """Return whether the thread is told to end: what it is at may as well be given up."""
        return self._ended

    def end(self) -> None:
        """
        End the thread; what it is at is waited for, but not for long.

        Compiled code that Python's end cuts short may abort the process.
        """
        with self._ending:
            self._ended = True
        self._calls.put(None)
        self._thread.join(PATIENCE)

    def _run(self) -> None:
        for function, arguments, done in iter(self._calls.get, None):
            try:
                result, error = function(*arguments), None
            except Exception as raised:
                result, error = None, raised
            with self._ending:
                if self._ended:
                    return
                if error is None:
                    done.set_result(result)
                else:
                    done.set_exception(error)
                self._returned.trigger()
