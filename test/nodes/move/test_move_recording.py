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

"""`move --record`: a bag that two independent readers read alike."""

from __future__ import annotations

from helpers.arm_in_ros import Arm, GOAL
from helpers.bag_reading import messages_by_topic, plain
from helpers.move_script import moved
from helpers.planner_in_ros import start_planner
import numpy as np
import pytest

MISSING = 'needs rosbags, of requirements/test.in'
highlevel = pytest.importorskip('rosbags.highlevel', reason=MISSING)


def test_bag_of_a_move_is_read_alike_by_two_readers(ros, tmp_path):
    start_planner(ros)
    Arm(ros)
    (tmp_path / 'taught.csv').write_text(
        'joint_1,joint_2,joint_3\n0.6,1.0,0.2\n' + ','.join(f'{x:.6f}' for x in GOAL) + '\n')
    code, output, errors = moved('taught.csv', '--record', 'bags/move.mcap', cwd=tmp_path)
    assert (code, errors) == (0, '')
    file = tmp_path / 'bags/move.mcap'
    first = messages_by_topic(file)
    count = sum(map(len, first.values()))
    assert f'recording: bags/move.mcap, {count} messages\n' in output
    with highlevel.AnyReader([file]) as reader:
        second = {}
        for connection, _, data in reader.messages():
            second.setdefault(connection.topic, []).append(
                reader.deserialize(data, connection.msgtype))
    assert {topic: len(found) for topic, found in second.items()} == {
        topic: len(found) for topic, found in first.items()}
    assert {'/joint_states', '/planned_trajectory', '/planned_path', '/robot_description',
            '/simulated_arm/controller_state'} <= set(first)
    (_, one), = first['/planned_trajectory']
    other, = second['/planned_trajectory']
    assert list(one.joint_names) == list(other.joint_names)
    assert [p.positions for p in one.points] == [p.positions.tolist() for p in other.points]
    np.testing.assert_allclose(one.points[-1].positions, GOAL, rtol=0.0, atol=1e-6)
    np.testing.assert_allclose(second['/joint_states'][-1].position, GOAL, rtol=0.0, atol=1e-4)
    assert [plain(m.position) for _, m in first['/joint_states']] == [
        m.position.tolist() for m in second['/joint_states']]
