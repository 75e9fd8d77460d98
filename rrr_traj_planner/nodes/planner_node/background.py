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

"""Threads for what takes long, so that a node answers all else meanwhile."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from queue import SimpleQueue
from threading import Lock, Semaphore, Thread
from time import perf_counter
from typing import Any, NamedTuple

from rclpy.node import Node
from rclpy.task import Future
from rrr_traj_planner.nodes.planner_node.turns import Turns

# Threads are told to end, and waited for, so long; a function asks often enough.
PATIENCE = 1.0  # s

MOST_THREADS = 32  # more calls wait until one of so many has returned


class _Call(NamedTuple):
    """What is to be called, and who is told."""

    function: Callable[..., Any]
    arguments: tuple[Any, ...]
    expected: float
    done: Future


class Background:
    """
    Calls functions in threads that take turns; callbacks of the node await what they return.

    Parameters
    ----------
    node : Node
        Its executor is woken when a function has returned.
    name : str
        The threads'.

    """

    def __init__(self, node: Node, name: str) -> None:
        self._name, self._turns = name, Turns()
        self._calls: SimpleQueue[_Call | None] = SimpleQueue()
        self._returned: deque[tuple[Future, Any, Exception | None]] = deque()
        self._wake = node.create_guard_condition(self._tell)
        self._ending, self._ended, self._taking = Lock(), False, Lock()
        self._idle, self._threads = Semaphore(0), list[Thread]()

    def call(self, function: Callable[..., Any], *arguments: Any, expected: float = 0.0) -> Future:
        """
        Call a function in a thread.

        Parameters
        ----------
        function : callable
            What takes long; its last argument is its `Turn`, whose `seconds` it asks often.
        *arguments
            Those before.
        expected : float
            How long it is thought to take at the least [s]; see `Turn`.

        Returns
        -------
        Future
            What it returns or raises, once it has and unless the threads are ended before. Of
            several it is told in the order in which they returned.

        """
        done = Future()
        self._calls.put(_Call(function, arguments, expected, done))
        if not self._idle.acquire(blocking=False) and len(self._threads) < MOST_THREADS:
            self._threads.append(Thread(target=self._run, name=self._name, daemon=True))
            self._threads[-1].start()
        return done

    def is_ending(self) -> bool:
        """Return whether the threads are told to end: what they are at may be given up."""
        return self._ended

    def end(self) -> None:
        """
        End the threads; what they are at is waited for, but not for long.

        Compiled code that Python's end cuts short may abort the process.
        """
        with self._ending:
            self._ended = True
        self._turns.end()
        for _ in self._threads:
            self._calls.put(None)
        until = perf_counter() + PATIENCE
        for thread in self._threads:
            thread.join(max(0.0, until - perf_counter()))

    def _run(self) -> None:
        while True:
            with self._taking:  # so that calls queue in the order in which they came
                call = self._calls.get()
                if call is None:
                    return
                queued = self._turns.queued(call.expected)
            with self._turns.taken(queued) as turn:
                if self._ended:
                    return
                try:
                    result, error = call.function(*call.arguments, turn), None
                except Exception as raised:
                    result, error = None, raised
                with self._ending:
                    if self._ended:
                        return
                    self._returned.append((call.done, result, error))
                    self._wake.trigger()
            self._idle.release()

    def _tell(self) -> None:
        """Tell what one function has returned: an executor answers the last told first."""
        done, result, error = self._returned.popleft()
        if error is None:
            done.set_result(result)
        else:
            done.set_exception(error)
        with self._ending:
            if self._returned and not self._ended:
                self._wake.trigger()
