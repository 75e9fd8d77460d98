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

"""SIGINT and SIGTERM where no ROS answers them: they end a script, and nothing else happens."""

from __future__ import annotations

import os
import signal

from helpers.arm_process import arm_process, ended
from helpers.scripts import Script, script
import pytest

BOTH = (signal.SIGINT, signal.SIGTERM)

# A node's script whose module, while it is imported, gets the signal in code that hides
# exceptions: in a destructor, as an extension module's import has them.
WHILE_IMPORTING = """
import os, sys
from rrr_traj_planner.nodes.process.node_runner import run_node
class Hides:
    def __del__(self):
        os.kill(os.getpid(), {number})
        for _ in range(10): pass
def load():
    Hides()
    print('went on', flush=True)
    raise SystemExit(3)
sys.exit(run_node('planner', '', load))
"""


@pytest.mark.parametrize('number', BOTH)
def test_signal_while_modules_are_imported_ends_the_script(number):
    assert ended(arm_process(code=WHILE_IMPORTING.format(number=int(number)))) == (0, '', '')


@pytest.mark.parametrize('number', BOTH)
@pytest.mark.parametrize('name', ['planner', 'bringup', 'demo'])
def test_signal_before_python_has_begun_ends_the_script(tmp_path, name, number):
    with Script(script(name), cwd=tmp_path, new_group=True) as started:
        os.killpg(started.process.pid, number)
        code, output, errors = started.ended()
    assert code in (0, -number)  # the signal's own: env had not yet begun
    assert (output, errors) == ('', '')


@pytest.mark.parametrize('number', BOTH)
def test_signal_to_bringup_alone_ends_nodes_that_have_just_been_started(number):
    with Script(script('bringup'), '--ros-args', '--log-level', 'fatal') as bringup:
        children = bringup.wait_for_children(3)
        bringup.process.send_signal(number)
        assert bringup.ended() == (0, '', '')
        assert all(child.has_ended() for child in children)
