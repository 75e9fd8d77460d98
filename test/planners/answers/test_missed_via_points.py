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

"""By how much via points are missed, and what the note says."""

from dataclasses import replace
import re

from helpers.planning_cases import ARM, LIMITS, through
import numpy as np
import pytest
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.planners.answers.missed_via_points import miss_note, ViaPointErrors
from rrr_traj_planner.planners.planning import plan

PLANNERS = ['cycloid_approach_b', 'poly_414']
Q = np.array([[0.3, 1.4, 0.0], [1.0, 1.8, 0.3], [0.2, 1.3, -0.5], [0.6, 1.6, 0.0]])
SAID = re.compile(r'(\d+) by ([\d.e-]+) m \(([\d.e-]+) rad\)')


def said(note):
    return {int(i): (float(tip), float(joint)) for i, tip, joint in SAID.findall(note)}


@pytest.mark.parametrize('planner_id', PLANNERS)
def test_note_says_by_how_much_tip_and_joint_miss_at_the_via_time(planner_id):
    answer = plan(ARM, LIMITS, through(Q, planner_id=planner_id))
    passed = answer.trajectory(answer.via_times)[0]
    tip = np.linalg.norm(forward_kinematics(ARM, passed) - forward_kinematics(ARM, Q), axis=1)
    joint = np.abs(passed - Q).max(axis=1)
    assert answer.note.startswith('via points missed by construction: 1 by ')
    found = said(answer.note)
    assert set(found) == {1, 2}
    for i in (1, 2):
        assert found[i] == pytest.approx((tip[i], joint[i]), rel=6e-3)
        assert tip[i] > 1e-3


@pytest.mark.parametrize('planner_id', PLANNERS)
def test_via_points_are_counted_as_the_caller_counts_them(planner_id):
    started = plan(ARM, LIMITS, through(Q[1:], start=Q[0], planner_id=planner_id))
    assert set(said(started.note)) == {0, 1}
    repeated = plan(ARM, LIMITS, through(Q[[0, 1, 1, 2, 3]], planner_id=planner_id))
    found = said(repeated.note)
    assert set(found) == {1, 2, 3}
    assert found[1] == found[2]


@pytest.mark.parametrize('planner_id', PLANNERS)
def test_two_points_alone_are_passed_exactly_without_a_note(planner_id):
    answer = plan(ARM, LIMITS, through(Q[:2], planner_id=planner_id))
    assert answer.note == ''
    assert answer.trajectory(answer.via_times)[0] == pytest.approx(Q[:2], abs=1e-9)


def test_slower_motions_of_approach_b_miss_by_less():
    # Transitions are as short as full acceleration allows: at half the velocity half as long.
    missed = []
    for factor in (1.0, 4.0):
        request = through(Q, planner_id='cycloid_approach_b',
                          segment_durations=factor * np.full(3, 2.5))
        missed.append(said(plan(ARM, replace(LIMITS, max_effort=np.full(3, np.inf)),
                                request).note)[1][1])
    assert missed[1] < missed[0] / 8.0


def test_one_miss_is_one_via_point():
    found = ViaPointErrors(np.array([0.0, 0.0123, 0.0]), np.array([1e-12, 0.0456, 0.0]))
    assert miss_note(found) == 'via point missed by construction: 1 by 0.0123 m (0.0456 rad)'
    assert miss_note(ViaPointErrors(np.zeros(2), np.zeros(2))) == ''
