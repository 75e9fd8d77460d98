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

"""Another arm is chosen on the page: its nodes are started; where they are not, the first is."""

from __future__ import annotations

import signal

from helpers.places import CONFIG
from helpers.scripts import python, Script
import pytest

STOP_TIME = 2.0  # s, in which all has ended after a signal
NODES = 3

# Opens a task at each start of the nodes, as a user would.
SCRIPT = """
import sys
from rrr_traj_planner.nodes.scripts.studio import main
from rrr_traj_planner.nodes.studio.studio import Studio

start, files = Studio.start, sys.argv[2:]

def start_and_open(self, error=''):
    start(self, error)
    print('shows', self.tasks.arm.name, self.editor.wanted.points[0].tolist(), error, flush=True)
    if files:
        name = files.pop(0)
        if name == 'moved':
            self.move_point(0, (1.0, 0.5, 1.0))
            name = files.pop(0)
        self.tasks.load('own.yaml', open(name, 'rb').read())

Studio.start = start_and_open
sys.exit(main(['--port', sys.argv[1]]))
"""


def test_arm_s_nodes_are_started_and_the_first_comes_back_if_they_are_not(tmp_path):
    pytest.importorskip('viser', reason='viser is not installed: make studio installs it')
    arm = tmp_path / 'unstable.yaml'  # the planner has no objection
    arm.write_text('/**:\n  ros__parameters:\n    physics_step: 0.01\n'
                   '    controller: {natural_frequency: 1000.0}\n')
    task = tmp_path / 'own.yaml'
    task.write_text(f'arm: {arm}\nvia_points: [[0.9, 0.3, 1.2], [0.9, 0.3, 1.0]]\n')
    go1 = CONFIG / 'arms' / 'go1_leg.yaml'
    with Script(python(SCRIPT), 0, 'moved', task, go1, cwd=tmp_path) as studio:
        first = studio.read_until('studio: http')
        assert 'shows thesis_arm.yaml [1.02, 0.59, 0.97]' in first[0]
        before = studio.started(NODES)
        again, = studio.read_until('shows')
        assert again.startswith('shows thesis_arm.yaml [1.0, 0.5, 1.0] own cannot be started: ')
        assert 'simulated_arm ended with exit code 1' in again
        assert all(child.has_ended() for child in before)
        other, = studio.read_until('shows')
        assert other.startswith('shows go1_leg_arm.yaml')
        nodes = studio.started(NODES)
        studio.process.send_signal(signal.SIGINT)
        assert studio.is_over_in(STOP_TIME)
        assert all(child.has_ended() for child in nodes)
        code, output, errors = studio.ended()
    assert (code, output) == (0, '')
    assert 'Traceback' not in errors
