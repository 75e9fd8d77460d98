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

"""Nodes as child processes: started, watched and ended together."""

from __future__ import annotations

from collections.abc import Sequence
import os
from pathlib import Path
import signal
import subprocess
import sys
from time import monotonic, sleep
from types import TracebackType

from rrr_traj_planner.nodes.process.signals import signal_arrived, signals_blocked

SCRIPTS = 'rrr_traj_planner.nodes.scripts'

# Like `python -m`, but with this copy of the package: -m prefers one in the current folder. If the
# parent process ends without ending this one, as by SIGKILL, Linux sends this one SIGINT.
PACKAGE_PATH = str(Path(__file__).parents[3])
SET_DEATH_SIGNAL = 1  # PR_SET_PDEATHSIG
RUN_MODULE = f"""\
import ctypes, os, runpy, signal, sys
if sys.platform == 'linux':
    ctypes.CDLL(None).prctl({SET_DEATH_SIGNAL}, signal.SIGINT)
if os.getppid() != int(sys.argv.pop(1)):
    sys.exit('the parent process has ended')
sys.path[:1] = [] if {PACKAGE_PATH!r} in sys.path else [{PACKAGE_PATH!r}]
del sys.argv[0]
runpy.run_module(sys.argv[0], run_name='__main__', alter_sys=True)"""

POLL_PERIOD = 0.1   # s, between two checks whether a process has ended
STOP_TIMEOUT = 1.5  # s after SIGINT, then SIGKILL


class NodeProcesses:
    """
    Processes of scripts that run nodes; a context manager that ends them.

    Signals must be deferred within the context (`signals.py`).

    Parameters
    ----------
    scripts : sequence of str
        Their names, such as 'planner'.
    ros_arguments : sequence of str
        ROS arguments of all, beginning with `--ros-args`.

    """

    def __init__(self, scripts: Sequence[str], ros_arguments: Sequence[str]) -> None:
        self._scripts = scripts
        self._ros_arguments = list(ros_arguments)
        self._processes: dict[str, subprocess.Popen[bytes]] = {}

    def __enter__(self) -> NodeProcesses:
        """Start all, or none."""
        try:
            with signals_blocked():
                for name in self._scripts:
                    self._processes[name] = subprocess.Popen([
                        sys.executable, '-c', RUN_MODULE, str(os.getpid()), f'{SCRIPTS}.{name}',
                        *self._ros_arguments])
        except BaseException:
            self.stop()
            raise
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None,
                 trace: TracebackType | None) -> None:
        """End all."""
        self.stop()

    def ended(self) -> tuple[str, int] | None:
        """
        Return the process that has ended, if any.

        Returns
        -------
        tuple of str and int, or None
            Name and exit code.

        """
        for name, process in self._processes.items():
            if process.poll() is not None:
                return name, process.returncode
        return None

    def wait(self) -> tuple[str, int] | None:
        """
        Wait until one of them ends, or SIGINT or SIGTERM arrives.

        Returns
        -------
        tuple of str and int, or None
            Name and exit code of the process; None after a signal.

        """
        while not signal_arrived():
            ended = self.ended()
            if ended is not None:
                return ended
            sleep(POLL_PERIOD)
        return None

    def stop(self) -> None:
        """End all by SIGINT, and by SIGKILL after `STOP_TIMEOUT`."""
        deadline = monotonic() + STOP_TIMEOUT
        for process in self._processes.values():
            if process.poll() is None:
                process.send_signal(signal.SIGINT)
        for process in self._processes.values():
            try:
                process.wait(max(deadline - monotonic(), 0.0))
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()


def exit_message(name: str, code: int) -> str:
    """
    Return how a process has ended, as text.

    Parameters
    ----------
    name : str
        The node's name.
    code : int
        Exit code, or the negative number of the signal that has killed the process.

    Returns
    -------
    str
        One line.

    """
    if code < 0:
        return f'{name} was killed by {signal.Signals(-code).name}'
    return f'{name} ended with exit code {code}'
