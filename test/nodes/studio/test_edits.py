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

"""Changes of single via points: stops, rests and times stay with what they belong to."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.nodes.point_files.reading import read_task
from rrr_traj_planner.nodes.studio.edits import (
    exchanged,
    inserted,
    removed,
    with_duration,
    with_dwell,
    with_stop,
)
from rrr_traj_planner.nodes.studio.wanted import wanted_of

MODEL = RobotModel()


def wanted(name='table_6_1.yaml'):
    return wanted_of(read_task(name), MODEL, 'base_link', 'cycloid')


def timed(*durations):
    """Return table 6.1 with times of its two segments."""
    first = wanted()
    return replace(first, task=replace(first.task, segment_durations=np.array(durations)))


PICK = wanted('pick_and_place.yaml')  # stops at 1, 4 and 5, rests at 1 and 4 for 0.5 s
JOINTS = np.array([[0.5, 0.9, 0.2], [0.7, 1.1, 0.3], [0.4, 1.0, 0.1]])


def test_what_is_typed_for_a_point_that_is_gone_changes_nothing():
    last = len(PICK.points)
    assert with_dwell(PICK, last, 1.0) is PICK
    assert with_duration(PICK, last, 1.0) is PICK


def test_point_is_inserted_halfway_to_the_next():
    first = wanted()
    a, b, c = first.points
    np.testing.assert_allclose(inserted(first, 0).points, [a, 0.5 * (a + b), b, c])
    np.testing.assert_allclose(inserted(first, 2).points, [a, b, c, 0.5 * (c + a)])
    np.testing.assert_array_equal(first.points, [a, b, c])


def test_removed_point_leaves_the_others_and_two_at_least():
    first = wanted()
    a, b, c = first.points.tolist()
    assert [removed(first, i).points.tolist() for i in range(3)] == [[b, c], [a, c], [a, b]]
    two = removed(first, 1)
    assert removed(two, 0) is two


def test_stops_and_rests_go_with_their_points():
    assert PICK.stops.tolist() == [False, True, False, False, True, True]
    more = inserted(PICK, 1)
    assert more.stops.tolist() == [False, True, False, False, False, True, True]
    assert more.rests.tolist() == [0.0, 0.5, 0.0, 0.0, 0.0, 0.5, 0.0]
    fewer = removed(PICK, 1)
    assert fewer.stops.tolist() == [False, False, False, True, True]
    assert fewer.rests.tolist() == [0.0, 0.0, 0.0, 0.5, 0.0]
    other = exchanged(PICK, 1, 2)
    assert other.stops.tolist() == [False, False, True, False, True, True]
    assert other.rests.tolist() == [0.0, 0.0, 0.5, 0.0, 0.5, 0.0]


def test_arm_stops_at_a_former_end_only_if_it_rests_there():
    at_end = with_dwell(PICK, 5, 0.7)
    for last, stop in ((PICK, False), (at_end, True)):
        assert inserted(last, 5).stops.tolist()[4:] == [True, stop, True]
        assert exchanged(last, 5, 3).stops.tolist()[3:] == [stop, True, True]
    assert removed(PICK, 5).stops.tolist() == [False, True, False, False, True]


def test_points_are_exchanged_only_where_both_are_there():
    first = wanted()
    a, b, c = first.points.tolist()
    assert exchanged(first, 0, 1).points.tolist() == [b, a, c]
    assert exchanged(first, 2, 1).points.tolist() == [a, c, b]
    assert exchanged(first, 0, -1) is first and exchanged(first, 2, 3) is first


def test_rest_asks_for_a_stop_and_no_stop_for_no_rest():
    rests = with_dwell(wanted(), 1, 0.4)
    assert (rests.task.stop_at.tolist(), rests.task.dwell.tolist()) == (
        [False, True, True], [0.0, 0.4, 0.0])
    none = with_stop(rests, 1, False)
    assert (none.task.stop_at.tolist(), none.task.dwell.tolist()) == ([], [])
    assert with_stop(wanted(), 1, True).stops.tolist() == [False, True, True]
    assert with_stop(wanted(), 2, False).stops.tolist() == [False, False, True]


@pytest.mark.parametrize(('change', 'times'), [
    (lambda w: inserted(w, 0), [2.0, 2.0, 3.0]),
    (lambda w: inserted(w, 2), [4.0, 3.0, 3.0]),
    (lambda w: removed(w, 0), [3.0]),
    (lambda w: removed(w, 1), [7.0]),
    (lambda w: removed(w, 2), [4.0]),
    (lambda w: exchanged(w, 0, 2), [4.0, 3.0]),
    (lambda w: with_duration(w, 2, 5.0), [4.0, 5.0]),
    (lambda w: with_duration(w, 0, 5.0), [4.0, 3.0]),
])
def test_times_of_segments_follow(change, times):
    assert change(timed(4.0, 3.0)).durations.tolist() == times


def test_time_is_the_planner_s_choice_where_it_is_not_prescribed():
    one = with_duration(wanted(), 1, 4.0)
    np.testing.assert_array_equal(one.task.segment_durations, [4.0, np.nan])
    assert len(with_duration(one, 1, 0.0).task.segment_durations) == 0


def test_joint_positions_go_with_their_points_and_are_found_for_new_ones():
    points = forward_kinematics(MODEL, JOINTS)
    first = replace(wanted(), joints=JOINTS, task=replace(wanted().task, via_points=points))
    np.testing.assert_array_equal(exchanged(first, 0, 1).joints, JOINTS[[1, 0, 2]])
    np.testing.assert_array_equal(removed(first, 1).joints, JOINTS[[0, 2]])
    more = inserted(first, 0)
    assert not more.joints_known
    found = more.completed(MODEL)
    assert found.joints_known
    np.testing.assert_allclose(forward_kinematics(MODEL, found.joints), more.points, atol=1e-9)


def test_moved_point_keeps_its_branch_and_one_out_of_reach_has_no_joint_positions():
    points = forward_kinematics(MODEL, JOINTS)
    first = replace(wanted(), joints=JOINTS, task=replace(wanted().task, via_points=points))
    x, y, z = points[1].tolist()
    near = first.moved(1, (x, y, z + 0.01)).completed(MODEL, first)
    assert np.abs(near.joints[1] - JOINTS[1]).max() < 0.05
    assert not first.moved(1, (9.0, 9.0, 9.0)).completed(MODEL, first).joints_known
