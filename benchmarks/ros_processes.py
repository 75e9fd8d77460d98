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

"""The nodes as processes, as users start them, and a client of them, on a domain of their own."""

from __future__ import annotations

from collections.abc import Callable
import os
from pathlib import Path
import re
import signal
import subprocess
from threading import Event, Thread
import time
from typing import Any

os.environ.setdefault('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
os.environ.setdefault('ROS_DOMAIN_ID', str(1 + os.getpid() % 101))

import numpy as np  # noqa: E402

try:
    from geometry_msgs.msg import Point, Pose
    import rclpy
    from rclpy.executors import SingleThreadedExecutor
    from rclpy.node import Node
    from rrr_traj_planner_interfaces.srv import PlanTrajectory
    MISSING = ''
except ImportError as error:
    MISSING = f'ROS is not there ({error}): rows that need it are left out'

DEADLINE = 60.0     # s, for what takes a second or two
POLLING = 2e-3      # s
GRACE = 5.0         # s that a process has to end
TICKS = os.sysconf('SC_CLK_TCK')
KIB = 1024.0
MB = 1e6


class Process:
    """A command that runs within a context."""

    def __init__(self, *command: object) -> None:
        self._popen = subprocess.Popen(
            [str(c) for c in command], stdout=subprocess.DEVNULL, stdin=subprocess.DEVNULL)
        self._files = Path('/proc', str(self._popen.pid))

    def __enter__(self) -> Process:
        return self

    def __exit__(self, *_: object) -> None:
        self._popen.send_signal(signal.SIGINT)
        try:
            self._popen.wait(GRACE)
        except subprocess.TimeoutExpired:
            self._popen.kill()
            self._popen.wait()

    def check(self) -> None:
        """Raise RuntimeError if it has ended."""
        if self._popen.poll() is not None:
            raise RuntimeError(f'{self._popen.args} ended with {self._popen.returncode}')

    def cpu(self) -> float:
        """Return the processor time that it has taken so far, all threads [s]."""
        fields = (self._files / 'stat').read_text().rpartition(')')[2].split()
        return (int(fields[11]) + int(fields[12])) / TICKS

    def memory(self, name: str = 'VmRSS') -> float:
        """Return its resident memory now, or its peak, VmHWM [MB]."""
        status = (self._files / 'status').read_text()
        return int(re.search(rf'{name}:\s+(\d+) kB', status)[1]) * KIB / MB

    def forget_peak(self) -> None:
        """Let VmHWM begin at what is resident now."""
        (self._files / 'clear_refs').write_text('5')


def node(name: str, *parameters: str) -> Process:
    """Return one of the package's nodes, by its script; only what goes wrong is logged."""
    given = [argument for parameter in parameters for argument in ('-p', parameter)]
    return Process(name, '--ros-args', '--log-level', 'error', *given)


class Client:
    """A node that spins in the background within a context."""

    def __init__(self) -> None:
        self._context = rclpy.context.Context()
        rclpy.init(context=self._context)
        self._executor = SingleThreadedExecutor(context=self._context)
        self.node = Node('bench', context=self._context)
        self._executor.add_node(self.node)
        self._closing = Event()
        self._thread = Thread(target=self._spin, daemon=True)
        self._thread.start()

    def __enter__(self) -> Client:
        return self

    def __exit__(self, *_: object) -> None:
        self._closing.set()
        self._executor.create_task(lambda: None)  # wakes it
        self._thread.join(GRACE)  # an executor that is shut down while it spins may raise
        self._executor.shutdown(timeout_sec=GRACE)
        self.node.destroy_node()
        self._context.try_shutdown()

    def _spin(self) -> None:
        while not self._closing.is_set():
            self._executor.spin_once()

    def service(self, process: Process, name: str = 'plan_trajectory') -> Callable[..., Any]:
        """Return a function that calls a PlanTrajectory service, as soon as that is there."""
        client = self.node.create_client(PlanTrajectory, name)
        until(client.service_is_ready, process, f'service {name}')

        def call(request: PlanTrajectory.Request, deadline: float = DEADLINE) -> Any:
            response = client.call(request, timeout_sec=deadline)
            if response is None:
                raise TimeoutError(f'{name} has not answered in {deadline} s')
            if response.error_code != response.SUCCESS:
                raise RuntimeError(f'{name}: {response.message}')
            return response

        return call


def until(condition: Callable[[], bool], process: Process, what: str) -> None:
    """Wait for something, but not for ever, and not longer than a process lives."""
    end = time.monotonic() + DEADLINE
    while not condition():
        process.check()
        if time.monotonic() > end:
            raise TimeoutError(f'no {what} in {DEADLINE} s')
        time.sleep(POLLING)


def plan_request(points: np.ndarray, **fields: Any) -> PlanTrajectory.Request:
    """Return the message that asks for a motion through tip positions [m]."""
    request = PlanTrajectory.Request(**fields)
    request.via_points.poses = [Pose(position=Point(x=x, y=y, z=z))
                                for x, y, z in np.asarray(points, dtype=float).tolist()]
    return request
