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

"""The installed scripts as processes, and their child processes."""

from __future__ import annotations

import os
from pathlib import Path
import select
import signal
import subprocess
import sys
from threading import Timer
from time import monotonic

from ament_index_python.packages import get_package_prefix

# Timeout of every wait [s].
DEADLINE = 60.0

# Time that a script has to end when it is asked to [s].
GRACE = 5.0


def script(name):
    """Return the command that `ros2 run` executes."""
    return [str(Path(get_package_prefix('rrr_traj_planner'), 'lib', 'rrr_traj_planner', name))]


def python(code):
    """Return a command that runs Python code with installed modules only."""
    return [sys.executable, '-c', f'import sys; del sys.path[0]  # the folder\n{code}']


class Script:
    """A running script; a context manager that ends it and its child processes."""

    def __init__(self, command, *arguments, cwd=None, new_group=False):
        self.process = subprocess.Popen(
            [*command, *map(str, arguments)], cwd=cwd, text=True, stdout=subprocess.PIPE,
            stderr=subprocess.PIPE, start_new_session=new_group)
        self.children = []

    def __enter__(self):
        return self

    def __exit__(self, *_):
        """
        End it as a user does; kill what does not end.

        A killed process may hold a lock of another one's shared memory: Fast DDS 2.14 then ends
        the other one with a segmentation fault.
        """
        self.children = self.children or children_of(self.process.pid)
        self.process.terminate()
        try:
            self.process.communicate(timeout=GRACE)
        except subprocess.TimeoutExpired:
            pass
        self._kill()
        self.process.communicate()

    def _kill(self):
        """End it and its child processes, which hold its pipes open."""
        self.children = self.children or children_of(self.process.pid)
        self.process.kill()
        for child in self.children:
            child.kill()

    def read_until(self, text):
        """Return lines of its output, up to one that contains a text."""
        return self._read_until(text, self.process.stdout)

    def read_errors_until(self, text):
        """Return lines of its standard error (with the log), up to one that contains a text."""
        return self._read_until(text, self.process.stderr)

    def _read_until(self, text, stream):
        deadline = Timer(DEADLINE, self._kill)  # ends the stream
        deadline.start()
        try:
            lines = []
            for line in stream:
                lines.append(line)
                if text in line:
                    return lines
            raise AssertionError(f'no {text!r}, but {lines}, and at the end {self.ended()}')
        finally:
            deadline.cancel()

    def started(self, count):
        """Return its child processes, if there are as many as expected."""
        self.children = children_of(self.process.pid)
        assert len(self.children) == count
        return self.children

    def wait_for_children(self, count):
        """Return its child processes, as soon as there are as many as expected."""
        deadline = monotonic() + DEADLINE
        while len(self.children) < count and monotonic() < deadline:
            self.children = children_of(self.process.pid)
        return self.started(count)

    def is_over_in(self, seconds):
        """Return whether it ends within a time."""
        try:
            self.process.wait(seconds)
        except subprocess.TimeoutExpired:
            return False
        return True

    def ended(self):
        """Return exit code, standard output and standard error."""
        output, errors = self.process.communicate(timeout=DEADLINE)
        return self.process.returncode, output, errors


class Child:
    """A child process."""

    def __init__(self, pid):
        self.pid = pid
        self._handle = os.pidfd_open(pid)  # identifies the process even if its number is reused
        self.command = Path(f'/proc/{pid}/cmdline').read_text().split('\0')

    def __del__(self):
        os.close(self._handle)

    def send_signal(self, number):
        signal.pidfd_send_signal(self._handle, number)

    def kill(self):
        """End it, if it is running."""
        try:
            self.send_signal(signal.SIGKILL)
        except ProcessLookupError:
            pass

    def has_ended(self):
        """Return whether it ends before the deadline."""
        poll = select.poll()
        poll.register(self._handle, select.POLLIN)
        return bool(poll.poll(1e3 * DEADLINE))


def children_of(pid):
    """Return the running child processes of a process."""
    try:
        pids = Path(f'/proc/{pid}/task/{pid}/children').read_text().split()
    except FileNotFoundError:
        return []
    return [Child(int(p)) for p in pids]
