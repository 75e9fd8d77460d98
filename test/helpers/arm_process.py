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

"""The script `simulated_arm` as a process, run from the source."""

from __future__ import annotations

import subprocess

from helpers.scripts import python

DEADLINE = 20.0  # s

RUN = 'import sys; from rrr_traj_planner.nodes.scripts.simulated_arm import main; sys.exit(main())'


def arm_process(*arguments, code=RUN):
    """Start the script, or another piece of Python, with arguments."""
    return subprocess.Popen([*python(code), *arguments], text=True, stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE)


def ended(process):
    """Return exit code, standard output and standard error."""
    try:
        output, errors = process.communicate(timeout=DEADLINE)
        return process.returncode, output, errors
    finally:
        process.kill()
