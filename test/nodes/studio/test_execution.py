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

"""A motion on the arm: one goal at a time takes over, points that are passed are left alone."""

from __future__ import annotations

import numpy as np
import pytest
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.nodes.point_files.reading import read_task
from rrr_traj_planner.nodes.studio.edits import inserted, removed
from rrr_traj_planner.nodes.studio.execution.execution import (
    DETACHED,
    Execution,
    GOES_ON,
    SILENCE,
    STOPPED,
    STOPPING,
    TRIES,
)
from rrr_traj_planner.nodes.studio.execution.progress import Progress
from rrr_traj_planner.nodes.studio.execution.tracking import MOST_POINTS, PERIOD, Tracking
from rrr_traj_planner.nodes.studio.goals import rest_goal
from rrr_traj_planner.nodes.studio.wanted import wanted_of
from rrr_traj_planner_interfaces.action import MoveThrough

NAMES = ('joint_1', 'joint_2', 'joint_3')
WANTED = wanted_of(read_task('pick_and_place.yaml'), RobotModel(), 'base_link', 'cycloid')
COUNT = len(WANTED.points)
Result = MoveThrough.Result


class Sent:
    """A goal, and what is to be called about it."""

    def __init__(self, goal, progress, ended):
        self.goal, self._progress, self._ended, self.is_canceled = goal, progress, ended, False

    def cancel(self):
        self.is_canceled = True

    def feedback(self, following, *left, error=0.0):
        """Give feedback: the via point that comes next, and times to it and those after it."""
        self._progress(MoveThrough.Feedback(
            next_via_point=following, time_left=left[-1], via_times_left=list(left),
            joint_names=list(NAMES[::-1]), tracking_error=[0.0, 0.0, error]))

    def end(self, code=Result.SUCCESS, message=''):
        self._ended(Result(error_code=code, message=message))

    def places(self):
        return [(p.position.x, p.position.y, p.position.z) for p in self.goal.via_points.poses]


class Arm:
    """What the execution sends to and shows on; keeps it."""

    replanning_lead = 0.25

    def __init__(self):
        self.sent, self.text, self.share, self.curves = [], '', 0.0, None
        self.execution = Execution(self, NAMES, self)
        self.wanted = WANTED

    def move(self, *goal):
        self.sent.append(Sent(*goal))
        return self.sent[-1]

    def show_status(self, text, share):
        self.text, self.share = text, share

    def show_tracking(self, times, errors):
        self.curves = times, errors

    def want(self, wanted):
        before, self.wanted = self.wanted, wanted
        self.execution.changed(before, wanted)

    def drag(self, index, height):
        x, y, _ = self.wanted.points[index]
        self.want(self.wanted.moved(index, (x, y, height)))


@pytest.fixture
def arm():
    """Give a test an arm on the way to via point 2 of `COUNT`."""
    arm = Arm()
    arm.execution.start(rest_goal(WANTED, 1), WANTED, takes_over=False)
    arm.sent[0].feedback(1, *(1.0 + k for k in range(COUNT - 2)))
    return arm


def test_drag_sends_the_points_to_come_to_which_the_passed_ones_do_not_belong(arm):
    arm.drag(3, 1.2)
    goal = arm.sent[1].goal
    np.testing.assert_array_equal(arm.sent[1].places(), arm.wanted.points[2:])
    assert list(goal.stop_at) == list(WANTED.task.stop_at[2:])
    assert list(goal.dwell) == list(WANTED.task.dwell[2:])
    assert (goal.planner_id, len(goal.joint_via_points)) == ('', 0)


def test_point_that_is_passed_or_about_to_be_is_left_alone(arm):
    arm.drag(1, 1.2)  # passed
    arm.sent[0].feedback(1, 0.3, *(1.3 + k for k in range(COUNT - 3)))
    arm.drag(2, 1.2)  # in 0.3 s, when the new motion has hardly begun
    assert len(arm.sent) == 1
    arm.drag(3, 1.2)
    np.testing.assert_array_equal(arm.sent[1].places(), arm.wanted.points[3:])


def test_last_point_is_gone_to_as_long_as_the_arm_moves(arm):
    arm.sent[0].feedback(COUNT - 2, 0.1)
    arm.drag(COUNT - 2, 1.2)
    assert len(arm.sent) == 1
    arm.drag(COUNT - 1, 1.2)
    np.testing.assert_array_equal(arm.sent[1].places(), arm.wanted.points[-1:])


def test_one_goal_is_on_its_way_and_of_the_others_the_newest_waits(arm):
    for height in (1.2, 1.21, 1.22):
        arm.drag(3, height)
    assert len(arm.sent) == 2
    arm.sent[1].feedback(0, *(0.9 + k for k in range(COUNT - 2)))
    assert len(arm.sent) == 3
    np.testing.assert_array_equal(arm.sent[2].places(), arm.wanted.points[2:])
    arm.sent[2].feedback(0, *(0.8 + k for k in range(COUNT - 2)))
    assert len(arm.sent) == 3


def test_end_of_the_goal_before_is_no_end(arm):
    arm.drag(3, 1.2)
    arm.sent[0].end(Result.PREEMPTED, 'replaced by a newer goal')
    assert 'replaced' not in arm.text and arm.execution.is_moving
    arm.sent[1].feedback(0, 0.9)
    arm.sent[1].end()
    assert 'reached' in arm.text and arm.share == 1.0 and not arm.execution.is_moving


def test_refusal_has_the_page_s_number_and_the_motion_goes_on(arm):
    arm.drag(3, 9.0)
    arm.sent[1].end(Result.NO_IK_SOLUTION, 'via point 1: (9, 9, 9) m is out of reach')
    for _ in range(2):
        assert 'via point 3: (9, 9, 9) m' in arm.text and GOES_ON in arm.text
        arm.sent[0].feedback(1, *(0.9 + k for k in range(COUNT - 2)))
    arm.drag(3, 1.2)
    arm.sent[2].feedback(0, 0.8, 1.8)
    assert GOES_ON not in arm.text


@pytest.mark.parametrize(('message', 'shown'), [
    ('segment_durations[1] is 0.0 s, must be finite', 'time of via point 3 is 0.0 s, must be'),
    ('dwell[1] is 1 s, but the arm does not stop at via point 1: ...',
     'dwell of via point 3 is 1 s, but the arm does not stop at via point 3')])
def test_refused_number_has_the_panel_s_name_and_number(arm, message, shown):
    arm.drag(3, 1.2)
    arm.sent[1].end(Result.INVALID_GOAL_CONSTRAINTS, message)
    assert shown in arm.text


def test_what_was_dragged_during_a_refusal_is_tried(arm):
    arm.drag(3, 9.0)
    arm.drag(3, 1.2)
    arm.sent[1].end(Result.NO_IK_SOLUTION, 'via point 1: out of reach')
    np.testing.assert_array_equal(arm.sent[2].places(), arm.wanted.points[2:])


def test_goal_that_is_too_late_for_the_controller_is_sent_again(arm):
    arm.drag(3, 1.2)
    for _ in range(10):
        arm.sent[-1].end(Result.CONTROL_FAILED, 'the controller has rejected the trajectory')
    assert len(arm.sent) == 2 + TRIES
    for sent in arm.sent[1:]:
        np.testing.assert_array_equal(sent.places(), arm.wanted.points[2:])
    arm.sent[0].feedback(1, 0.9, 1.9)
    assert 'rejected' in arm.text and GOES_ON in arm.text
    arm.drag(3, 1.21)
    assert len(arm.sent) == 3 + TRIES


@pytest.mark.parametrize('change', [
    lambda wanted: removed(wanted, 3), lambda wanted: inserted(wanted, 3),
    lambda wanted: wanted.moved(2, (1.0, 0.5, 1.0)).moved(3, (1.0, 0.6, 1.0))])
def test_other_points_are_those_of_another_motion(arm, change):
    arm.want(change(WANTED))
    arm.drag(3, 1.2)
    arm.sent[0].feedback(1, *(0.9 + k for k in range(COUNT - 2)))
    assert len(arm.sent) == 1 and DETACHED in arm.text


def test_other_planner_and_scalings_hold_from_the_next_drag_on(arm):
    arm.want(WANTED.with_scalings(0.5, 0.25))
    assert len(arm.sent) == 1
    arm.drag(3, 1.2)
    assert arm.sent[1].goal.max_velocity_scaling_factor == 0.5


def test_stop_ends_the_motion_and_what_is_to_take_over(arm):
    arm.drag(3, 1.2)
    assert arm.execution.stop(is_told=True)
    assert STOPPING in arm.text
    arm.sent[0].feedback(1, *(0.9 + k for k in range(COUNT - 2)))
    assert STOPPING in arm.text
    assert [sent.is_canceled for sent in arm.sent] == [True, True]
    for sent in arm.sent:
        sent.end(Result.PREEMPTED, 'canceled')
    assert STOPPED in arm.text and not arm.execution.is_moving
    arm.drag(3, 1.21)
    assert len(arm.sent) == 2 and not arm.execution.stop(is_told=True)


def test_stop_that_perhaps_nobody_has_heard_is_not_told_as_done(arm, monkeypatch):
    arm.sent[0].feedback(1, *(0.9 + k for k in range(COUNT - 2)))
    monkeypatch.setattr(Progress, 'silence', SILENCE + 1.0)
    assert arm.execution.stop(is_told=True)
    arm.sent[0].end(Result.PREEMPTED, 'canceled')
    assert STOPPED not in arm.text and 'no news of the motion for 3 s' in arm.text


def test_end_of_which_somebody_else_tells_is_not_told(arm):
    assert arm.execution.stop(is_told=False)
    before = arm.text
    arm.sent[0].feedback(1, *(0.9 + k for k in range(COUNT - 2)))
    arm.sent[0].end(Result.CONTROL_FAILED, 'held')
    assert arm.text == before and not arm.execution.is_moving
    arm.execution.start(rest_goal(WANTED, 1), WANTED, takes_over=False)
    arm.sent[1].end(Result.CONTROL_FAILED, 'no controller')
    assert 'no controller' in arm.text


def test_second_click_sends_nothing():
    arm = Arm()
    for _ in range(2):
        arm.execution.start(rest_goal(WANTED, 1), WANTED, takes_over=arm.execution.is_moving)
    assert len(arm.sent) == 1


def test_share_goes_on_where_a_goal_takes_over(arm):
    arm.sent[0].feedback(1, *(0.5 + k for k in range(COUNT - 2)))  # 0.5 s later
    share = arm.share
    assert share == pytest.approx(0.5 / (COUNT - 2))
    arm.drag(3, 1.2)
    arm.sent[1].feedback(0, *(0.4 + k for k in range(COUNT - 2)))
    assert share < arm.share < 0.2
    arm.sent[1].feedback(COUNT - 3, 0.0)
    assert arm.share == pytest.approx(1.0)


def test_errors_are_the_joints_and_the_largest_is_told(arm):
    arm.sent[0].feedback(1, 0.9, 1.9, error=-0.004)
    arm.sent[0].feedback(1, 0.8, 1.8, error=0.001)
    assert '1.0e-03' in arm.text and '4.0e-03' in arm.text
    arm.sent[0].end()
    assert '4.0e-03' in arm.text
    times, errors = arm.curves
    assert (np.diff(times) > 0.0).all()
    np.testing.assert_array_equal(errors, [[0.0] * 3, [-0.004, 0.0, 0.0], [0.001, 0.0, 0.0]])


def test_chart_of_a_long_motion_has_no_more_points():
    tracking, drawn = Tracking(), 0
    for k in range(20 * MOST_POINTS):
        drawn += tracking.add(100.0 + 0.05 * k, (1e-3 * (k == 777), 0.0, 0.0))
    times, errors = tracking.curves()
    assert MOST_POINTS // 2 <= len(times) <= MOST_POINTS and errors.shape == (len(times), 3)
    assert times[0] == 0.0 and times[-1] > 0.99 * 0.05 * 20 * MOST_POINTS
    assert tracking.largest == 1e-3
    assert drawn == pytest.approx(0.05 * 20 * MOST_POINTS / PERIOD, rel=0.3)
