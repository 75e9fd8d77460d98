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

"""A plan as arrays and as a file of comma-separated values, and the README's example of both."""

import io
from pathlib import Path
import re
import subprocess
import sys

from helpers.places import ROOT
import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.request import PlanningRequest

README = ROOT / 'README.md'
NAMES = ('base', 'shoulder', 'elbow')
POINTS = [(1.02, 0.59, 0.97), (0.46, 0.55, 1.44), (0.45, 0.38, 1.45)]
HEADS = ['time [s]', *(f'{name} {quantity}' for quantity in (
    'position [rad]', 'velocity [rad/s]', 'acceleration [rad/s^2]', 'effort [N m]')
    for name in NAMES)]


@pytest.fixture(scope='module')
def found():
    return plan(RobotModel(joint_names=NAMES), JointLimits(), PlanningRequest(POINTS))


def test_file_has_the_points_bit_for_bit(found, tmp_path):
    path = tmp_path / 'motion.csv'
    found.to_csv(path)
    with path.open() as file:
        assert file.readline().rstrip('\n').split(',') == HEADS
        rows = np.loadtxt(file, delimiter=',')
    p = found.points
    assert np.array_equal(rows[:, :10], np.column_stack(
        (p.times, p.positions, p.velocities, p.accelerations)))


def test_torques_are_those_that_hold_the_arm_at_both_ends(found):
    # m2 l2 g cos q2 + m3 g (a2 cos q2 + l3 sin(q2 + q3)) about axis 2, its last term about axis 3.
    for at in (0, -1):
        _, q2, q3 = found.points.positions[at]
        accelerations = found.points.accelerations[at]
        assert np.array_equal(accelerations, np.zeros(3))
        forearm = 12.0 * 9.81 * 0.5 * np.sin(q2 + q3)
        upper = (16.0 * 0.5 + 12.0 * 0.9) * 9.81 * np.cos(q2)
        held = [found.columns()[f'{name} effort [N m]'][at] for name in NAMES]
        assert held == pytest.approx([0.0, upper + forearm, forearm], abs=1e-9)


def test_torques_of_the_points_stay_within_the_peaks(found):
    columns = found.columns()
    for name, peak in zip(NAMES, found.effort):
        assert np.abs(columns[f'{name} effort [N m]']).max() <= peak * (1.0 + 1e-9)


def test_open_file_gets_what_a_path_gets_and_stays_open(found, tmp_path):
    text = io.StringIO()
    found.to_csv(text)
    path = str(tmp_path / 'motion.csv')
    found.to_csv(path)
    assert Path(path).read_text() == text.getvalue()
    assert not text.closed


@pytest.mark.parametrize('file', [None, 3, 1.0, True, []])
def test_what_is_no_file_is_refused(found, file):
    with pytest.raises(InvalidInputError, match='^file is .*, must be a path or an open te'):
        found.to_csv(file)


def test_readme_s_example_runs_and_writes_its_file(tmp_path):
    blocks = re.findall(r'^```python\n(.*?)^```', README.read_text(), re.DOTALL | re.MULTILINE)
    code, = (block for block in blocks if 'to_csv' in block)
    ran = subprocess.run([sys.executable, '-W', 'error', '-c', code], cwd=tmp_path, timeout=60,
                         capture_output=True, text=True, check=False)
    assert (ran.returncode, ran.stderr) == (0, '')
    last = (tmp_path / 'motion.csv').read_text().splitlines()[-1].split(',')
    assert float(last[0]) == pytest.approx(2.850, abs=5e-4)  # the README's table of planners
    assert [float(x) for x in last[4:10]] == [0.0] * 6
