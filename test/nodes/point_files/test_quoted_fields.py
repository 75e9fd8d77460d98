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

"""Quoted fields of tables: read by the csv module's rules, or refused with the line."""

from __future__ import annotations

import csv
import io

import numpy as np
import pytest
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.nodes.point_files.reading import read_task

POINTS = np.array([[1.02, 0.59, 0.97], [0.46, 0.55, 1.44]])


@pytest.fixture
def read(tmp_path):
    """Return a function that reads the text of a table."""
    def read_text(text, **options):
        (tmp_path / 'points.csv').write_text(text)
        return read_task(str(tmp_path / 'points.csv'), **options)

    return read_text


@pytest.mark.parametrize('text', [
    '"x, m","y, m","z, m"\n1.02,0.59,0.97\n0.46,0.55,1.44\n',
    '"x, mm","y [cm]",z\n1020,59,0.97\n460,55,1.44\n',
    'x,y,z,note\n1.02,0.59,0.97,"first, taught"\n0.46,0.55,1.44,"then; 100 % # sure\t"\n',
    'note,x,y,z\n"say ""go"", then",1.02,0.59,0.97\n , 0.46, 0.55, 1.44\n',
    'x;y;z;note\n"1,02";"0,59";"0,97";"a;b"\n0,46;0,55;1,44\n',
    'x , "y" , z # "a comment"\n"1.02" , "0.59" , 0.97\n0.46,0.55,1.44 # 5" long\n'])
def test_quoted_fields_are_read(read, text):
    assert read(text).via_points == pytest.approx(POINTS)


def test_what_the_csv_module_writes_is_read(read):
    rows = [['my "x", not yours', 'x, m', 'y # m', 'z', 'y [m]'], ['a, b', 1.02, '', 0.97, 0.59],
            ['"', 0.46, ';', 1.44, 0.55]]
    text = io.StringIO()
    csv.writer(text, quoting=csv.QUOTE_ALL).writerows(rows)
    assert read(text.getvalue()).via_points == pytest.approx(POINTS)
    joints = io.StringIO()
    csv.writer(joints).writerow(['arm, joint 1', 'b', 'c'])
    csv.writer(joints).writerow([0.1, 0.2, 0.3])
    with pytest.raises(InvalidInputError, match='the header is arm, joint 1, b, c, and must name'):
        read(joints.getvalue(), started=True).joint_via_points(['joint 1', 'b', 'c'])


@pytest.mark.parametrize(('text', 'message'), [
    ('x,y,z\n"1,02",0.59,0.97\n', "line 2: x is '1,02', must be a number with a decimal point; "
     'decimal commas need columns that are split at semicolons'),
    ('"1,02","0,59","0,97"\n', "line 1: x is '1,02', must be a number with a decimal point"),
    ('x,y,z\n1.02,"1,000.5",0.97\n', "line 2: y is '1,000.5', must be a number"),
    ('x,y,z\n1.02,0.59,1_000\n', "line 2: z is '1_000', must be a number"),
    ('x,y,z\n"1.02,0.59,0.97\n', 'line 2 is \'"1.02,0.59,0.97\': a quotation mark is not closed'),
    ('x,y,"z\n[m]"\n', "line 1 is 'x,y,\"z': a quotation mark is not closed"),
    ('"x, then","y","z"\n1,2,3\n', "x is in 'then': must be in m, cm, mm")])
def test_what_is_not_is_refused_with_its_line(read, text, message):
    with pytest.raises(InvalidInputError) as caught:
        read(text)
    assert message in str(caught.value)
