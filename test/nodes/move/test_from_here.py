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

"""Tasks as they are put to the planner for an arm that may be anywhere."""

from __future__ import annotations

from dataclasses import replace

from helpers.plan_requests import NAMES, START, TABLE_6_1
import numpy as np
import pytest
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.nodes.motion.arm_states import ArmState
from rrr_traj_planner.nodes.move.from_here import (
    from_here,
    in_base_frame,
    MOVING,
    read_task_from_here,
    THERE,
    WAY_TIME,
)
from rrr_traj_planner.nodes.parameters.configuration import PlannerConfig
from rrr_traj_planner.nodes.parameters.table import PLANNER, rows_of
from rrr_traj_planner.nodes.point_files.reading import read_task

TOLERANCE = 0.01
CONFIG = PlannerConfig.from_values({
    name: row.default for name, row in rows_of(PLANNER, NAMES).items()})


@pytest.fixture(scope='module')
def task():
    return read_task('table_6_1.yaml')


def test_files_for_either_start_are_read(tmp_path):
    two, file = 'via_points: [[1.0, 0.6, 1.0], [1.0, 0.5, 1.0]]\n', tmp_path / 'points.yaml'
    for text in ('via_points: [[1.0, 0.6, 1.0]]\n', two + 'segment_durations: [2.0]\n',
                 two + 'segment_durations: [1.0, 2.0]\n', two + 'dwell: [0.5, 0.5]\n'):
        file.write_text(text)
        assert len(read_task_from_here(str(file)).via_points) in (1, 2)
    file.write_text(two + 'segment_durations: [1.0, 2.0, 3.0]\n')
    with pytest.raises(InvalidInputError, match='3 segment_durations given for 2 segments'):
        read_task_from_here(str(file))


def state(q=START, qd=(0.0, 0.0, 0.0)):
    """Return a state with joints in another order, and one that is no arm's."""
    joints = {'gripper': (0.7, 0.0, 0.0), **{
        name: (float(x), float(v), 0.0) for name, x, v in zip(NAMES, q, qd)}}
    return ArmState(dict(reversed(joints.items())), 0)


def asked(task, at):
    return from_here(task, CONFIG, at, TOLERANCE)


@pytest.mark.parametrize('off', [0.0, 0.009])
def test_via_point_at_which_the_arm_is_is_left_out(task, off):
    found = asked(task, state(START + (0.0, off, 0.0)))
    assert (found.skipped, found.notes) == (1, (THERE,))
    assert found.task.via_points.tolist() == [list(point) for point in TABLE_6_1[1:]]


def test_so_is_a_joint_position(task):
    taught = np.array([START, START + 0.1])
    joints = replace(task, via_points=np.zeros((0, 3)), joint_positions=lambda names: taught,
                     stop_at=np.array([True, True]), dwell=np.array([0.0, 0.5]))
    found = asked(joints, state())
    assert found.skipped == 1
    assert found.task.joint_via_points(NAMES).tolist() == [(START + 0.1).tolist()]
    assert (found.task.stop_at.tolist(), found.task.dwell.tolist()) == ([True], [0.5])


@pytest.mark.parametrize('at', [
    state(START + (0.0, 0.011, 0.0)),            # it is elsewhere
    ArmState({'joint_1': (0.5, 0.0, 0.0)}, 0),   # it is known in part
    None])
def test_an_arm_elsewhere_goes_to_the_first_via_point(task, at):
    found = asked(task, at)
    assert (found.skipped, found.task.via_points.tolist(), found.notes) == (
        0, task.via_points.tolist(), ())


def test_an_arm_that_moves_needs_the_planner_that_starts_in_motion(task):
    at = state(qd=(0.0, 0.1, 0.0))
    found = asked(replace(task, planner_id=''), at)
    assert (found.skipped, found.task.planner_id, found.notes) == (0, 'time_optimal', (MOVING,))
    found = asked(replace(task, planner_id='cycloid'), at)  # which refuses
    assert (found.task.planner_id, found.notes) == ('cycloid', ())


def test_via_points_that_cannot_be_compared_are_all_asked_for(task):
    assert asked(replace(task, frame='camera'), state()).skipped == 0
    assert asked(replace(task, via_points=np.array([[9.0, 0.0, 0.0]] * 2)), state()).skipped == 0


def test_the_only_via_point_stays(task):
    assert asked(replace(task, via_points=task.via_points[:1]), state()).skipped == 0


def test_a_rest_at_the_first_via_point_is_a_stop_there(task):
    found = asked(replace(task, dwell=np.array([0.5, 0.0, 0.2])), state())
    assert found.skipped == 0
    assert found.task.stop_at.tolist() == [True, False, True]
    stops = replace(task, dwell=np.array([0.5, 0.5, 0.2]), stop_at=np.array([False, True, True]))
    assert asked(stops, state()).task.stop_at.tolist() == [True, True, True]


def test_durations_are_those_of_the_segments_that_are_left(task):
    two = replace(task, segment_durations=np.array([2.0, 3.0]))
    three = replace(task, segment_durations=np.array([1.0, 2.0, 3.0]))
    for given in (two, three):
        assert asked(given, state()).task.segment_durations.tolist() == [2.0, 3.0]
    away = state(START + 0.1)
    np.testing.assert_array_equal(
        asked(two, away).task.segment_durations, [np.nan, 2.0, 3.0])
    assert asked(two, away).notes == (WAY_TIME,)
    assert asked(three, away).task.segment_durations.tolist() == [1.0, 2.0, 3.0]
    assert asked(three, away).notes == ()


def test_via_points_of_another_frame_are_known_by_the_plan(task):
    moved = replace(task, frame='camera', via_points=task.via_points + 1.0)
    found = in_base_frame(moved, CONFIG, np.array([START] * 3))
    assert found.frame == ''
    np.testing.assert_allclose(found.via_points, [TABLE_6_1[0]] * 3, rtol=0.0, atol=1e-12)
    assert in_base_frame(task, CONFIG, np.array([START] * 3)) is task
