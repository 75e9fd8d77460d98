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

"""What the plans of every planner in joint space satisfy beyond the contract of all planners."""

from helpers.measured_motions import JOINT_SPACE, planned_motions
import numpy as np
import pytest

# Of some 40 motions. Of 600 random tasks, 11 to 15 of time_optimal's end before they converge:
# which ones is decided by rounding.
MOST_REMARKS = {'poly_434': 5, 'time_optimal': 3}
REMARKS = 'reach a jerk of', '% slower: a controller', 'planning ended before it converged'


@pytest.fixture(scope='module', params=JOINT_SPACE)
def planner_id(request):
    return request.param


@pytest.fixture(scope='module')
def motions(planner_id):
    return planned_motions(planner_id)


def test_notes_seldom_remark_on_more_than_missed_via_points(planner_id, motions):
    notes = [m.plan.note for m in motions.values() if m.plan.note]
    remarks = [note for note in notes if not note.startswith('via point')]
    assert all(any(remark in note for remark in REMARKS) for note in remarks)
    assert len(remarks) <= MOST_REMARKS.get(planner_id, 0)


def test_joints_are_in_step(motions):
    for m in motions.values():
        assert np.ptp([p.duration for p in m.trajectory.profiles]) <= 1e-9
