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

"""A script's main function, called many times in one process: imports take most of a start."""

from __future__ import annotations

import json
import subprocess
import sys
from threading import Timer

DEADLINE = 120.0  # s, of a call

PROCESS = """
import contextlib, importlib, io, json, os, sys
sys.modules.update(dict.fromkeys({without!r}))
main = importlib.import_module('rrr_traj_planner.nodes.scripts.{name}').main
for line in sys.stdin:
    folder, arguments = json.loads(line)
    os.chdir(folder)
    output, errors = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(output), contextlib.redirect_stderr(errors):
        try:
            code = main(arguments)
        except SystemExit as end:  # argparse's
            code = end.code
    print(json.dumps([code, output.getvalue(), errors.getvalue()]), flush=True)
"""


def script_calls(name, *without):
    """Yield a function that calls a script where some modules cannot be imported."""
    process = subprocess.Popen(
        [sys.executable, '-c', PROCESS.format(name=name, without=without)], text=True,
        stdin=subprocess.PIPE, stdout=subprocess.PIPE)

    def call(*arguments, cwd):
        """Return exit code, standard output and standard error."""
        deadline = Timer(DEADLINE, process.kill)
        deadline.start()
        try:
            print(json.dumps([str(cwd), [str(x) for x in arguments]]), file=process.stdin,
                  flush=True)
            return tuple(json.loads(process.stdout.readline()))
        finally:
            deadline.cancel()

    try:
        yield call
        process.communicate(timeout=DEADLINE)
        assert process.returncode == 0
    finally:
        process.kill()
        process.wait()
