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

"""The script `move` as a process, and what it prints."""

from __future__ import annotations

import re
from time import monotonic

from helpers.scripts import Script, script


def move(*arguments, cwd):
    """Start the script; a context manager."""
    return Script(script('move'), *arguments, cwd=cwd)


def moved(*arguments, cwd):
    """Run the script, and return exit code, standard output and standard error."""
    with move(*arguments, cwd=cwd) as process:
        return process.ended()


def via_rows(output):
    """Return the table's rows about via points: index, time [s], tip error [mm]."""
    rows = [re.split(r'\) (?:m|rad)', line) for line in output.splitlines()
            if re.match(r'\d+ +\(', line)]
    return [(int(head.split()[0]), float(tail.split()[0]), float(tail.split()[-1]))
            for head, tail in rows]


def seconds_to_end(process, number):
    """Send a signal, and return the time until the process has ended [s]."""
    begin = monotonic()
    process.process.send_signal(number)
    process.process.wait(20.0)
    return monotonic() - begin
