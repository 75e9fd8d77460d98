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

"""Pool of worker threads for long calls, so that the node's executor stays responsive."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from queue import SimpleQueue
from threading import Lock, Semaphore, Thread
from time import perf_counter
from typing import Any, NamedTuple

from rclpy.node import Node
from rclpy.task import Future
from rrr_traj_planner.nodes.planner_node.scheduler import Scheduler

JOIN_TIMEOUT = 1.0  # s for all threads to end; functions check `is_ending` far more often

MAX_THREADS = 32  # more simultaneous calls wait for a free thread


class _Call(NamedTuple):
    """A call, and the future of its result."""

    function: Callable[..., Any]
    arguments: tuple[Any, ...]
    expected: float
    done: Future


class WorkerPool:
    """
    Calls functions in threads, one at a time (`Scheduler`); callbacks await the results.

    Parameters
    ----------
    node : Node
        The node whose executor sets the futures.
    name : str
        Name of the threads.

    """

    def __init__(self, node: Node, name: str) -> None:
        self._name, self._scheduler = name, Scheduler()
        self._calls: SimpleQueue[_Call | None] = SimpleQueue()
        self._returned: deque[tuple[Future, Any, Exception | None]] = deque()
        self._wake = node.create_guard_condition(self._resolve)
        self._end_lock, self._ended, self._queue_lock = Lock(), False, Lock()
        self._idle, self._threads = Semaphore(0), list[Thread]()

    def call(self, function: Callable[..., Any], *arguments: Any, expected: float = 0.0) -> Future:
        """
        Call a function in a thread.

        Parameters
        ----------
        function : callable
            The function; its last argument is its `Job`, whose `checkpoint` it calls often.
        *arguments
            Its other arguments.
        expected : float
            Lower bound on its run time [s]; see `Job`.

        Returns
        -------
        Future
            Result or exception; never set if the pool ends first. Futures are set in the order in
            which their functions return.

        """
        done = Future()
        self._calls.put(_Call(function, arguments, expected, done))
        if not self._idle.acquire(blocking=False) and len(self._threads) < MAX_THREADS:
            self._threads.append(Thread(target=self._run, name=self._name, daemon=True))
            self._threads[-1].start()
        return done

    def is_ending(self) -> bool:
        """Return whether the pool is ending: functions should stop."""
        return self._ended

    def end(self) -> None:
        """
        End the threads; wait up to `JOIN_TIMEOUT` for running functions.

        Without the wait, interpreter shutdown during compiled code may abort the process.
        """
        with self._end_lock:
            self._ended = True
        self._scheduler.end()
        for _ in self._threads:
            self._calls.put(None)
        until = perf_counter() + JOIN_TIMEOUT
        for thread in self._threads:
            thread.join(max(0.0, until - perf_counter()))

    def _run(self) -> None:
        while True:
            with self._queue_lock:  # jobs are enqueued in the order of the calls
                call = self._calls.get()
                if call is None:
                    return
                queued = self._scheduler.enqueue(call.expected)
            with self._scheduler.run(queued) as job:
                if self._ended:
                    return
                try:
                    result, error = call.function(*call.arguments, job), None
                except Exception as raised:
                    result, error = None, raised
                with self._end_lock:
                    if self._ended:
                        return
                    self._returned.append((call.done, result, error))
                    self._wake.trigger()
            self._idle.release()

    def _resolve(self) -> None:
        """Set one future per wake-up: executors run the callbacks of several in reverse order."""
        done, result, error = self._returned.popleft()
        if error is None:
            done.set_result(result)
        else:
            done.set_exception(error)
        with self._end_lock:
            if self._returned and not self._ended:
                self._wake.trigger()
