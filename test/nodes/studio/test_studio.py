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

"""The studio with real nodes: the plan follows the drag, refusals are shown, the arm is run."""

from __future__ import annotations

import re

from helpers.arm_in_ros import Arm
from helpers.move_client import start_motion_server
from helpers.plan_requests import TABLE_6_1
from helpers.planner_in_ros import plan, start_planner
from helpers.studio_page import Page, studio_of
import numpy as np
import pytest
from rrr_traj_planner.nodes.studio.execution.commands import NO_PLAN
from rrr_traj_planner.nodes.studio.execution.execution import GOES_ON, TAKEN_OVER
from rrr_traj_planner.nodes.studio.ros_client import StudioClient
from rrr_traj_planner.planners.registry import planner_ids

FAR_AWAY = (9.0, 9.0, 9.0)
DRAGS = 30
PASSED = 0.01    # m, of the driven path, whose states are joined by straight lines
REACHED = 1e-3   # m, of the tip: what computed torque leaves of the reference


class Client(StudioClient):
    """Counts what the planner is asked for."""

    asked = 0

    def plan(self, wanted, answered):
        self.asked += 1
        super().plan(wanted, answered)


@pytest.fixture
def page():
    return Page()


@pytest.fixture
def client(ros):
    start_planner(ros)
    start_motion_server(ros)
    return ros.add(Client(context=ros.context))


@pytest.fixture
def studio(ros, client, page):
    """Give a test the studio with all nodes, and its first plan."""
    Arm(ros)
    return studio_of(ros, client, page)


def test_plan_follows_the_drag_and_none_piles_up(ros, client, page, studio):
    first, asked = studio.session.plan, client.asked
    places = [(0.46, 0.55, 1.44 - 0.01 * k) for k in range(DRAGS)]

    def drag():  # faster than the planner answers
        for place in places:
            studio.move_point(1, place)

    ros.run(drag)
    page.wait(lambda p: studio.session.is_current and studio.session.plan is not first)
    assert client.asked == asked + 2
    response = plan(ros, (TABLE_6_1[0], places[-1], TABLE_6_1[2]))
    assert studio.session.plan.duration == pytest.approx(response.via_times[-1], abs=1e-9)
    assert f'{response.via_times[-1]:.3f} s' in page.figures


def test_path_passes_through_the_via_points(page, studio):
    path = page.plan.path
    for place in TABLE_6_1:
        assert np.linalg.norm(path - place, axis=1).min() < 1e-9
    assert len(page.plan.speed) == len(path) - 1
    name, peaks, limits = page.plan.peaks[0]
    assert name.startswith('velocity') and limits.tolist() == [1.0, 1.0, 1.0]
    assert (peaks <= limits).all()


def test_loaded_points_are_planned_and_a_wrong_file_changes_nothing(ros, page, studio):
    ros.run(lambda: studio.tasks.load('own.csv', b'1.02,0.59,0.97\n0.46,0.55,1.44\n'))
    page.wait(lambda p: studio.session.is_current and len(p.points) == 2)
    response = plan(ros, TABLE_6_1[:2])
    assert page.plan.duration == pytest.approx(response.via_times[-1], abs=1e-9)
    before = studio.session.wanted
    ros.run(lambda: studio.tasks.load('own.csv', b'1.02,0.59\n'))
    assert 'own.csv' in studio.tasks.message and studio.session.wanted is before


def test_curves_are_shares_of_the_limits(page, studio):
    plan = page.plan
    peaks = {name.split(' [')[0]: peaks / limits for name, peaks, limits in plan.peaks}
    for name in ('velocity', 'acceleration', 'jerk', 'torque'):
        assert plan.curves[name].shape == (len(plan.times), 3)
        share = np.abs(plan.curves[name]).max(axis=0)
        # the peaks are exact; of jerk, the curve has means over a sample period
        np.testing.assert_allclose(share, peaks[name], atol=0.05 if name == 'jerk' else 0.01)
    np.testing.assert_allclose(plan.shares.max(axis=0), [
        max(peaks[name]) for name in ('velocity', 'acceleration', 'jerk', 'torque')], atol=0.05)
    # joint 1 has the range 0 to pi/2, and turns to where the points are
    x, y, _ = TABLE_6_1[0]
    ends = plan.curves['position in its range'][[0, -1], 0]
    assert ends[0] == pytest.approx((np.arctan2(y, x) - np.pi / 4) / (np.pi / 4), abs=1e-6)
    assert (np.abs(plan.curves['position in its range']) <= 1.0).all()


def test_ghost_is_the_arm_where_the_plan_has_it(ros, page, studio):
    page.wait(lambda p: p.ghost == ())
    for share, place in ((0.0, TABLE_6_1[0]), (1.0, TABLE_6_1[2])):
        ros.run(lambda share=share: studio.go_to(share))
        page.wait(lambda p, place=place: p.ghost and np.linalg.norm(
            np.subtract(p.ghost[-1], place)) < 1e-9)
    ros.run(lambda: studio.play(True))
    page.wait(lambda p: p.ghost and np.linalg.norm(np.subtract(p.ghost[-1], TABLE_6_1[2])) > 0.1)


def test_planners_stand_side_by_side_and_one_is_taken(ros, client, page, studio):
    asked = client.asked
    ros.run(lambda: studio.comparison.start(studio.session.wanted))
    page.wait(lambda p: len(p.rows) == len(planner_ids()) and not p.waits_for)
    assert client.asked == asked + len(planner_ids())
    durations = [row.answer.duration for row in page.rows]
    assert durations == sorted(durations)
    own = next(row.answer for row in page.rows if row.planner_id == 'cycloid')
    assert own.duration == studio.session.plan.duration
    assert len(own.vibration()) == 3 and min(own.vibration()) > 0.0
    best = page.rows[0]
    ros.run(lambda: studio.take(best.planner_id))
    assert studio.session.plan is best.answer is page.plan and studio.session.is_current
    assert client.asked == asked + len(planner_ids())
    assert studio.session.wanted.task.planner_id == best.planner_id
    ros.run(studio.editor.undo)
    assert studio.session.wanted.task.planner_id == 'cycloid'


def test_refused_point_is_at_fault_and_the_last_plan_stays(ros, page, studio):
    last = studio.session.plan
    ros.run(lambda: studio.move_point(1, FAR_AWAY))
    page.wait(lambda p: p.refusal is not None)
    response = plan(ros, (TABLE_6_1[0], FAR_AWAY, TABLE_6_1[2]))
    page.wait(lambda p: not p.is_current)
    assert (page.refusal.text, page.refusal.via_point) == (response.message, 1)
    assert page.plan is last
    ros.run(studio.commands.run)
    assert NO_PLAN in page.statuses[-1][0]
    ros.run(lambda: studio.move_point(1, TABLE_6_1[1]))
    page.wait(lambda p: p.is_current and p.refusal is None)


def test_run_moves_the_arm_along_the_plan(ros, page, studio):
    ros.run(studio.commands.run)
    page.wait(lambda p: any('tracking error' in text for text, _ in p.statuses))
    page.wait(lambda p: 'reached the last via point' in p.statuses[-1][0])
    shares = [share for text, share in page.statuses if 'tracking error' in text]
    assert shares == sorted(shares) and 0.0 <= shares[0] and shares[-1] <= 1.0
    page.wait(lambda p: np.linalg.norm(np.subtract(p.places[-1], TABLE_6_1[2])) < REACHED)
    for place in TABLE_6_1:
        assert distance(page, place) < PASSED
    ros.run(studio.commands.reset)
    page.wait(lambda p: np.linalg.norm(np.subtract(p.places[-1], TABLE_6_1[0])) < REACHED)


def test_second_run_goes_to_the_first_point_and_one_in_motion_takes_over(ros, page, studio):
    def run_again():
        assert studio.session.is_current
        studio.commands.run()

    ros.run(studio.commands.run)
    page.wait(lambda p: any('tracking error' in text for text, _ in p.statuses))
    page.wait(lambda p: np.linalg.norm(np.subtract(p.places[-1], TABLE_6_1[0])) > 0.05)
    ros.run(run_again)
    assert any(TAKEN_OVER in text for text, _ in page.statuses)
    page.wait(lambda p: 'reached the last via point' in p.statuses[-1][0])
    page.wait(lambda p: np.linalg.norm(np.subtract(p.places[-1], TABLE_6_1[2])) < REACHED)
    ros.run(run_again)
    page.wait(lambda p: np.linalg.norm(np.subtract(p.places[-1], TABLE_6_1[0])) < 0.01)
    page.wait(lambda p: 'reached the last via point' in p.statuses[-1][0])


def test_hold_stops_the_arm_and_the_page_says_so(ros, client, page, studio):
    names = ('joint_1', 'joint_2', 'joint_3')
    ros.run(studio.commands.run)
    page.wait(lambda p: np.linalg.norm(np.subtract(p.places[-1], TABLE_6_1[0])) > 0.05)
    ros.run(studio.commands.hold)
    page.wait(lambda p: p.statuses[-1][0] != '' and 'left' not in p.statuses[-1][0])
    page.wait(lambda p: np.abs(client.joints(names, 'velocity')).max() < 1e-3)
    assert np.linalg.norm(np.subtract(page.places[-1], TABLE_6_1[2])) > 0.1


def distance(page, place):
    """Return how close the tip has come to a place [m]."""
    driven = np.array(page.driven)
    begins, lines = driven[:-1], np.diff(driven, axis=0)
    along = np.clip(((place - begins) * lines).sum(axis=1) / (lines ** 2).sum(axis=1), 0.0, 1.0)
    return np.linalg.norm(begins + along[:, np.newaxis] * lines - place, axis=1).min()


def slow_down(ros, page, studio):
    """Have a motion that lasts longer than a busy machine is late."""
    ros.run(lambda: studio.editor.change(studio.editor.wanted.with_scalings(0.5, 0.5)))
    page.wait(lambda *_: studio.session.is_current)


def test_point_that_is_dragged_in_motion_is_gone_to(ros, client, page, studio):
    slow_down(ros, page, studio)
    goals = keep_goals(client)
    elsewhere = (0.55, 0.3, 1.3)
    ros.run(studio.commands.run)
    page.wait(lambda p: np.linalg.norm(np.subtract(p.places[-1], TABLE_6_1[0])) > 0.05)
    ros.run(lambda: studio.move_point(0, (1.0, 0.5, 1.0)))  # passed
    for x in np.linspace(TABLE_6_1[2][0], elsewhere[0], 5).tolist():
        ros.run(lambda x=x: studio.move_point(2, (x, *elsewhere[1:])))
    page.wait(lambda p: 'reached the last via point' in p.statuses[-1][0])
    page.wait(lambda p: np.linalg.norm(np.subtract(p.places[-1], elsewhere)) < REACHED)
    assert 2 <= len(goals) <= 1 + 5
    left = [len(goal.via_points.poses) for goal in goals[1:]]  # 1: via point 1 is too near by then
    assert set(left) <= {1, 2} and left == sorted(left, reverse=True)
    assert distance(page, TABLE_6_1[1]) < PASSED
    driven = np.array(page.driven)
    turned = np.linalg.norm(driven - TABLE_6_1[1], axis=1).argmin()
    away = np.linalg.norm(driven[:turned] - TABLE_6_1[0], axis=1)
    assert (np.maximum.accumulate(away) - away).max() < 0.2  # it did not go back
    assert page.errors.shape == (len(page.times), 3) and np.abs(page.errors).max() < 1e-3


def test_refused_drag_in_motion_is_told_and_the_motion_goes_on(ros, page, studio):
    slow_down(ros, page, studio)
    ros.run(studio.commands.run)
    page.wait(lambda p: any('tracking error' in text for text, _ in p.statuses))
    ros.run(lambda: studio.move_point(2, FAR_AWAY))
    page.wait(lambda p: GOES_ON in p.statuses[-1][0])
    assert 'via point 2: (9, 9, 9) m' in page.statuses[-1][0]
    page.wait(lambda p: 'at the last via point of the motion before' in p.statuses[-1][0])
    page.wait(lambda p: np.linalg.norm(np.subtract(p.places[-1], TABLE_6_1[2])) < REACHED)
    assert page.refusal.via_point == 2


def keep_goals(client):
    """Return a list that gets every goal that a client sends."""
    goals, move = [], client.move

    def keeping(goal, *functions):
        goals.append(goal)
        return move(goal, *functions)

    client.move = keeping
    return goals


def test_report_is_a_page_of_what_is_planned_or_why_not(ros, page, studio):
    pytest.importorskip('matplotlib')
    ros.run(lambda: studio.editor.change(studio.editor.wanted.with_scalings(0.5, 0.5)))
    page.wait(lambda p: studio.session.is_current)
    name, content = studio.report()
    text = content.decode()
    assert name == 'report_table_6_1_cycloid.html'
    assert f'{studio.session.plan.duration:.3f}' in text
    assert text.startswith('<!DOCTYPE html>') and '<svg' in text
    assert not re.search(r'(src|href)="[^#"d]', text)  # one file
    ros.run(lambda: studio.move_point(1, FAR_AWAY))
    assert '(9, 9, 9) m' in studio.report()[1].decode()
