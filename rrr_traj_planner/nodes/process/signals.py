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
Handling of SIGINT and SIGTERM: the process ends at once, or in order if ROS runs.

The handler raises no exception, because that would interrupt any code, such as imports,
destructors and compiled modules. Until a script has started ROS or other processes it has nothing
to clean up and ends at once; from then on signals are deferred: the handler only records them,
and whoever waits asks `signal_arrived`. rclpy's own handlers are not installed: they shut its
context down at once, and nobody can be told any more that the node ends.
"""

from __future__ import annotations

import atexit
from collections.abc import Iterator
from contextlib import contextmanager
import os
import signal
import sys
from types import FrameType

SIGNALS = (signal.SIGINT, signal.SIGTERM)


class _Handler:
    """The handler of both signals."""

    deferred = False
    arrived = False

    def __call__(self, number: int, frame: FrameType | None) -> None:
        """Record the signal; end the process unless signals are deferred."""
        self.arrived = True
        if not self.deferred:
            os._exit(0)


_handler = _Handler()  # one for the process, as signals are


def end_at_signals() -> None:
    """Let both signals end the process with exit code 0, including one that is pending."""
    _handler.deferred = _handler.arrived = False
    for number in SIGNALS:
        signal.signal(number, _handler)
    # Interpreter shutdown restores the default handlers before the process ends.
    atexit.register(signal.pthread_sigmask, signal.SIG_BLOCK, SIGNALS)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, SIGNALS)  # see setup.py and processes.py


def defer_signals() -> None:
    """Only record both signals: ROS or child processes must be shut down first."""
    _handler.deferred = True


def end_if_signalled() -> None:
    """End the process if a signal has arrived, else let the next one end it."""
    _handler.deferred = False
    if _handler.arrived:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(0)


def signal_arrived() -> bool:
    """Return whether SIGINT or SIGTERM has arrived."""
    return _handler.arrived


@contextmanager
def signals_blocked() -> Iterator[None]:
    """
    Block both signals, in this process and in child processes started within the context.

    A child unblocks them when it calls `end_at_signals`.
    """
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, SIGNALS)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)
