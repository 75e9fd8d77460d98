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

"""Planning while the user drags: the latest wins, none piles up, the last plan stays."""

from __future__ import annotations

import numpy as np
import pytest
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.nodes.point_files.reading import read_task
from rrr_traj_planner.nodes.studio.session import Refusal, Session
from rrr_traj_planner.nodes.studio.wanted import wanted_of


def wanted(name='table_6_1.yaml', **frame):
    return wanted_of(read_task(name), RobotModel(), frame.get('frame', 'base_link'), 'cycloid')


@pytest.fixture
def asked():
    """Give a test the list of what is asked for."""
    return []


@pytest.fixture
def session(asked):
    return Session(wanted(), asked.append)


def drag(session, *heights):
    """Move via point 1, and return what is wanted after each move."""
    found = []
    for height in heights:
        session.change(session.wanted.moved(1, (0.46, 0.55, height)))
        found.append(session.wanted)
    return found


def test_first_change_is_asked_for_at_once(session, asked):
    first, = drag(session, 1.3)
    assert asked == [first]
    assert session.plan is None and not session.is_current


def test_of_changes_meanwhile_only_the_newest_is_asked_for(session, asked):
    moves = drag(session, 1.3, 1.31, 1.32, 1.33)
    assert asked == moves[:1]
    session.answered('first plan')
    assert asked == [moves[0], moves[3]]
    assert session.plan == 'first plan' and not session.is_current
    session.answered('last plan')
    assert asked == [moves[0], moves[3]]
    assert session.plan == 'last plan' and session.is_current


def test_a_known_plan_is_taken_without_being_asked_for(session, asked):
    drag(session, 1.3)
    session.answered('plan')
    other = session.wanted.with_planner('gauss')
    session.take(other, 'other plan')
    assert len(asked) == 1 and session.plan == 'other plan' and session.is_current
    assert session.wanted is other and not session.is_waiting


def test_a_known_plan_is_asked_for_where_an_older_answer_comes(session, asked):
    drag(session, 1.3)
    assert session.is_waiting
    other = session.wanted.with_planner('gauss')
    session.take(other, 'other plan')
    session.answered('plan')
    assert asked[-1] is other and not session.is_current


def test_a_change_after_the_answer_is_asked_for_at_once(session, asked):
    drag(session, 1.3)
    session.answered('plan')
    last, = drag(session, 1.4)
    assert asked[-1] is last and not session.is_current


def test_last_plan_stays_after_a_refusal_until_there_is_a_new_one(session):
    drag(session, 1.3)
    session.answered('plan')
    drag(session, 9.0)
    session.answered(Refusal('out of reach', 1))
    assert (session.plan, session.refusal.via_point) == ('plan', 1)
    assert not session.is_current
    drag(session, 1.3)
    assert session.refusal is not None  # until the answer
    session.answered('other plan')
    assert (session.plan, session.refusal) == ('other plan', None)
    assert session.is_current


def test_a_refusal_of_what_is_no_longer_wanted_asks_again(session, asked):
    _, second = drag(session, 9.0, 1.3)
    session.answered(Refusal('out of reach', 1))
    assert asked[-1] is second


def test_via_points_in_another_frame_are_refused(tmp_path):
    with pytest.raises(InvalidInputError, match="must be in 'base'"):
        file = tmp_path / 'points.yaml'
        point = '{header: {frame_id: table}, point: {x: 0.9, y: 0.3, z: 1.0}}'
        file.write_text(f'via_points: [{point}, {point}]\n')
        wanted_of(read_task(str(file)), RobotModel(), 'base', 'cycloid')


def test_unknown_planner_is_told_with_the_file_s_name(tmp_path):
    file = tmp_path / 'points.yaml'
    file.write_text('planner_id: cycloyd\nvia_points: [[0.9, 0.3, 1.0], [1.0, 0.3, 1.0]]\n')
    with pytest.raises(InvalidInputError, match="^points: planner_id 'cycloyd' is unknown"):
        wanted(str(file))


def test_joint_positions_have_positions_of_the_tip_and_stay(tmp_path):
    file = tmp_path / 'points.yaml'
    file.write_text('joint_via_points: [[0.0, 0.0, 0.0], [0.5, 0.0, 0.0]]\n')
    found = wanted(str(file))
    # d1 = 0.5 m high, a2 + d4 = 1.6 m from joint 1's axis, which joint 1 turns about
    assert found.task.joint_positions is None
    assert found.joints.tolist() == [[0.0, 0.0, 0.0], [0.5, 0.0, 0.0]]
    radius = np.linalg.norm(found.points[:, :2], axis=1)
    np.testing.assert_allclose(radius, radius[0])
    angle = np.arctan2(found.points[:, 1], found.points[:, 0])
    assert angle[1] - angle[0] == pytest.approx(0.5)
