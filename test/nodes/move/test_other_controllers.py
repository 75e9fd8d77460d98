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

"""`move` with controllers that know less, and say it by other topics."""

from __future__ import annotations

import signal

from helpers.arm_in_ros import GOAL, START
from helpers.move_script import move, moved, seconds_to_end, via_rows
from helpers.other_controller import OtherController
from helpers.planner_in_ros import start_planner
import numpy as np
import pytest


@pytest.mark.parametrize('form', ['without time', 'in parts', 'nan', 'of the controller'])
def test_arm_of_which_positions_alone_are_known_is_moved(ros, tmp_path, form):
    start_planner(ros)
    controller = OtherController(
        ros, '/arm_controller', form != 'of the controller', form=form)
    try:
        # slow: a position without time counts when it arrives, on a busy machine later
        (tmp_path / 'taught.yaml').write_text(
            f'joint_via_points: [[0.6, 1.0, 0.2], {[round(float(x), 6) for x in GOAL]}]\n'
            'segment_durations: [2.5, 2.5]\n')
        code, output, errors = moved(
            'taught.yaml', '--controller', '/arm_controller', cwd=tmp_path)
    finally:
        ros.run(controller.destroy)
    assert (code, errors) == (0, '')
    assert [row[0] for row in via_rows(output)] == [0, 1]
    assert max(row[2] for row in via_rows(output)) < 1.0
    assert 'velocity [rad/s]' in output
    assert 'executed torque' not in output
    np.testing.assert_allclose(controller.q, GOAL, rtol=0.0, atol=1e-6)


def test_controller_with_another_clock_gets_nothing(ros, tmp_path):
    start_planner(ros)
    controller = OtherController(ros, 'simulated_arm', late=100.0)
    try:
        (tmp_path / 'one.csv').write_text('joint_1,joint_2,joint_3\n0.6,1.0,0.2\n')
        with move('one.csv', cwd=tmp_path) as process:
            process.read_until("waiting for the arm's time (its states are stamped by another")
            assert seconds_to_end(process, signal.SIGINT) < 2.0
    finally:
        ros.run(controller.destroy)
    assert controller.q.tolist() == START.tolist()
