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

"""How many via points, stops, rests and durations a file must have, with and without a start."""

from __future__ import annotations

import numpy as np
import pytest
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.nodes.point_files.reading import read_task
from rrr_traj_planner.planners.request import PlanningRequest
import yaml

ONE, TWO = '[[1.0, 0.6, 1.0]]', '[[1.0, 0.6, 1.0], [0.5, 0.6, 1.4]]'
SINGLE = {
    'points.yaml': f'via_points: {ONE}\n', 'joints.yaml': f'joint_via_points: {ONE}\n',
    'named.yaml': 'joint_via_points: [{joint_1: 1.0, joint_2: 0.6, joint_3: 1.0}]\n',
    'pose.yaml': 'position: {x: 1.0, y: 0.6, z: 1.0}\n---\n',
    'points.csv': 'x,y,z\n1.0,0.6,1.0\n', 'bare.csv': '1.0,0.6,1.0\n',
    'joints.csv': 'joint_1,joint_2,joint_3\n1.0,0.6,1.0\n'}


@pytest.fixture
def read(tmp_path):
    """Return a function that reads a file of a given content."""
    def of(content, name='points.yaml', **options):
        (tmp_path / name).write_text(content)
        return read_task(str(tmp_path / name), **options)

    return of


@pytest.mark.parametrize('name', SINGLE)
def test_single_via_point_needs_a_start(read, name):
    with pytest.raises(InvalidInputError) as caught:
        read(SINGLE[name], name)
    assert str(caught.value).endswith(f'{name}: 1 via point given, at least 2 needed')
    task = read(SINGLE[name], name, started=True)
    joints = task.joint_via_points(['joint_1', 'joint_2', 'joint_3'])
    assert (task.via_points if joints is None else joints).tolist() == [[1.0, 0.6, 1.0]]


@pytest.mark.parametrize(('more', 'started', 'text'), [
    ('segment_durations: [1]\n', False, ''), ('segment_durations: [1, 2]\n', True, ''),
    ('segment_durations: [1, 2]\n', False, '2 segment_durations given for 1 segment'),
    ('segment_durations: [1]\n', True, '1 segment_durations given for 2 segments'),
    ('segment_durations: [0]\n', False, 'segment_durations[0] is 0.0 s, must be finite and at'),
    ('stop_at: [false, true]\n', True, ''),
    ('stop_at: [true]\n', True, 'stop_at has 1 value for 2 via points, must have one for each'),
    ('stop_at: [true, false]\n', False, 'stop_at[1] is false, must be true: the motion ends at '),
    ('dwell: [0.5, 0]\n', False, ''),  # at the first, where the motion starts
    ('dwell: [0.5, 0]\n', True, 'dwell[0] is 0.5 s, but the arm does not stop at via point 0'),
    ('dwell: [0.5, 0]\nstop_at: [true, true]\n', True, ''),
    ('dwell: [1]\n', False, 'dwell has 1 value for 2 via points, must have one for each')])
def test_counts_are_those_of_the_service_and_so_are_the_words(read, more, started, text):
    content = f'via_points: {TWO}\n{more}'
    if text == '':
        assert len(read(content, started=started).via_points) == 2
        return
    with pytest.raises(InvalidInputError) as caught:
        read(content, started=started)
    said = str(caught.value).partition('points.yaml: ')[2]
    assert said.startswith(text)
    fields = dict(line.split(': ') for line in more.lower().splitlines())
    values = {name: np.array(yaml.safe_load(value)) for name, value in fields.items()}
    with pytest.raises(InvalidInputError) as by_service:
        PlanningRequest(np.zeros((2, 3)), np.zeros(3) if started else None, **values)
    assert str(by_service.value) == said


def test_long_durations_are_no_matter_of_the_file(read):
    content = f'via_points: {TWO}\nsegment_durations: [1.0e6]\n'  # max_points are the node's
    assert read(content).segment_durations.tolist() == [1e6]
