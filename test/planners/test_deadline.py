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

"""Limits on the time of planning: the best so far first, then a refusal that names the step."""

from __future__ import annotations

from dataclasses import replace
from itertools import count
import pickle
import re

import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.cancellation import never, step
from rrr_traj_planner.core.errors import InvalidInputError, TimeLimitError, TimingError
from rrr_traj_planner.core.trajectory import controller_spline
from rrr_traj_planner.planners import registration
from rrr_traj_planner.planners.answers import answer_points, answer_time
from rrr_traj_planner.planners.deadline import Deadline, GRACE, part_of
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.registry import planner, planner_ids
from rrr_traj_planner.planners.request import PlanningRequest
from rrr_traj_planner.planners.solver.convergence import CONVERGED

LIMITS = JointLimits(min_position=[-1.6, 0.0, -np.pi])


class Clock:
    """A clock that a test sets."""

    def __init__(self):
        self.now = 100.0

    def __call__(self):
        return self.now


class CountingClock:
    """A clock on which a millisecond passes whenever it is read."""

    now = 0.0

    def __call__(self):
        self.now += 1e-3
        return self.now


def circle(n):
    t = np.linspace(0.0, 2.0 * np.pi, n, endpoint=False)
    return np.stack((0.6 + 0.1 * np.cos(t), 0.1 * np.sin(t), 1.0 + 0.0 * t), axis=1)


def lissajous(n):
    t = np.linspace(0.0, 2.0 * np.pi, n, endpoint=False)
    return np.sin(np.stack((3.0 * t, 2.0 * t, 5.0 * t + 0.3), axis=1))


def test_deadline_requests_the_best_so_far_and_then_gives_up():
    clock = Clock()
    deadline = Deadline(1.0, clock)
    for now, answer in ((100.0, False), (100.79, False), (100.81, True), (100.99 + GRACE, True)):
        clock.now = now
        assert deadline() is answer
    clock.now = 101.01 + GRACE
    with pytest.raises(TimeLimitError) as caught:
        deadline()
    assert str(caught.value) == 'planning_time_limit 1 s: given up after 1.21 s'


def test_a_part_of_it_ends_sooner_and_gives_up_with_the_whole():
    clock = Clock()
    part = part_of(Deadline(2.0, clock), 0.25)
    clock.now = 100.39
    assert not part()
    clock.now = 100.41
    assert part()
    clock.now = 103.0
    with pytest.raises(TimeLimitError, match='^planning_time_limit 2 s: given up after 3.00 s$'):
        part()
    assert part_of(bool, 0.25) is bool  # of any other question all is waited for


def test_parts_of_a_part_are_shares_of_its_own_time():
    clock = Clock()
    last = part_of(Deadline(2.0, clock), 1.0, 0.5)  # the second half: 80 % of 2 s, from 0.8 s on
    half = part_of(last, 0.5)
    for now, answers in ((100.79, (False, False)), (101.19, (False, False)),
                         (101.21, (False, True)), (101.61, (True, True))):
        clock.now = now
        assert (last(), half()) == answers


@pytest.mark.parametrize(('kept', 'improving'), [(0.1, 1.6), (0.5, 1.5), (0.9, 1.1), (1.9, 0.6)])
def test_more_time_is_kept_for_an_answer_that_takes_longer_than_a_fifth_of_it(kept, improving):
    clock = Clock()
    deadline = Deadline(2.0, clock).keeping(kept)
    half = part_of(deadline, 0.5)
    for now, answers in ((0.49 * improving, (False, False)), (0.51 * improving, (False, True)),
                         (0.99 * improving, (False, True)), (1.01 * improving, (True, True))):
        clock.now = 100.0 + now
        assert (deadline(), half()) == answers


@pytest.mark.parametrize('microseconds', [1.0, 6.0])  # in which a point is checked
def test_planning_ends_so_early_that_the_points_of_a_long_motion_can_be_checked(
        microseconds, monkeypatch):
    clock, ended = CountingClock(), []
    cycloid, checked = planner('cycloid').plan, controller_spline.checked_intervals

    def slow(task):
        while not task.should_stop():
            pass
        ended.append(clock.now)
        return cycloid(task)

    def timed(model, limits, spline, should_stop=never):
        clock.now += 1e-6 * microseconds * len(spline.coefficients)
        return checked(model, limits, spline, should_stop)

    for module in (answer_time, answer_points):
        monkeypatch.setattr(module, 'checked_intervals', timed)
    monkeypatch.setitem(registration.REGISTERED, 'slow', registration.Registered(slow))
    found = plan(RobotModel(), LIMITS, PlanningRequest(
        circle(2), planner_id='slow', should_stop=Deadline(1.0, clock), dwell=[300.0, 200.0]))
    assert len(found.points.times) > 50_000
    checks = 1e-6 * microseconds * len(found.points.times)
    assert ended[0] == pytest.approx(min(0.8, 1.0 - answer_time.WHOLE * checks), abs=0.1)


def test_parts_of_a_motion_share_the_time_by_their_segments(monkeypatch):
    """Of 3 s, 80 % for planning: 0.8 s for the first part, of one segment, then 1.6 s for two."""
    clock, ended = CountingClock(), []
    cycloid = planner('cycloid').plan

    def slow(task):
        while not task.should_stop():
            pass
        ended.append(clock.now)
        return cycloid(task)

    monkeypatch.setitem(registration.REGISTERED, 'slow', registration.Registered(slow))
    deadline = Deadline(3.0, clock)
    plan(RobotModel(), LIMITS, PlanningRequest(
        circle(4), planner_id='slow', should_stop=deadline, stop_at=[False, True, False, True]))
    assert ended == pytest.approx([0.8, 2.4], abs=0.03)


def test_the_inner_step_is_named():
    with pytest.raises(TimeLimitError) as caught, step('all'), step('the first part'):
        raise TimeLimitError(1.0, 1.5)
    assert str(caught.value) == (
        'planning_time_limit 1 s: given up after 1.50 s, during the first part')
    assert pickle.loads(pickle.dumps(caught.value)).step == 'the first part'


def calls_of_should_stop(planner_id, answer):
    """Return how often a planner asks a question that is answered by its number."""
    questions = count()
    request = PlanningRequest(
        circle(8), planner_id=planner_id, should_stop=lambda: answer(next(questions)))
    try:
        plan(RobotModel(), LIMITS, request)
    except TimeLimitError as error:
        assert ', during ' in str(error)
    return next(questions)


def given_up(last):
    """Return an answer that raises from a question on."""
    def answer(number):
        if number >= last:
            raise TimeLimitError(1.0, 1.4)
        return False

    return answer


@pytest.mark.parametrize('planner_id', sorted(planner_ids()))
def test_every_planner_ends_at_once_whenever_the_question_raises(planner_id):
    total = calls_of_should_stop(planner_id, lambda _: False)
    assert total > 2
    for last in {0, 1, total // 2, total - 1}:
        assert calls_of_should_stop(planner_id, given_up(last)) == last + 1


def test_a_path_through_many_points_is_given_up_in_time_and_says_in_which_step():
    deadline = Deadline(0.02)
    with pytest.raises(TimeLimitError, match=(
            r'^planning_time_limit 0.02 s: given up after 0\.\d\d s, during ')):
        plan(RobotModel(), LIMITS, PlanningRequest(
            circle(1000), planner_id='line_arc', should_stop=deadline))


@pytest.mark.parametrize('planner_id', ['time_optimal', 'line_arc', 'line_polynomial'])
def test_refusal_names_the_time_limit_where_a_motion_is_too_slow_for_its_points(planner_id):
    request = PlanningRequest([0.6, 0.0, 1.0] + [0.1, 0.15, 0.1] * lissajous(12),
                              planner_id=planner_id, sample_period=0.01)
    fast, slow = (len(plan(RobotModel(), LIMITS, replace(
        request, should_stop=lambda early=early: early)).points.times) for early in (False, True))
    assert fast < slow - 5
    few = replace(request, max_points=(fast + slow) // 2)
    plan(RobotModel(), LIMITS, few)
    with pytest.raises(TimingError, match=(
            r'^planning ended early, with a slow motion: a motion of [\d.]+ s with a point every '
            rf'0\.01 s has more than {few.max_points} points$')):
        plan(RobotModel(), LIMITS, replace(few, should_stop=lambda: True))
    with pytest.raises(InvalidInputError, match='^a motion of'):
        plan(RobotModel(), LIMITS, replace(few, max_points=fast // 2))


def saving(note):
    """Return the part of the time that a note says could be saved at most."""
    if 'faster motions may be possible' in note:
        return 1.0
    said = re.search(r'at most ([\d.]+) % of the time could be saved', note)
    return 0.01 * float(said.group(1)) if said else CONVERGED


@pytest.mark.parametrize(('planner_id', 'unit', 'limits'), [
    ('line_arc', lissajous(24), (0.05, 0.2, 0.8)),
    ('line_polynomial', np.random.default_rng(10).uniform(-1.0, 1.0, (10, 3)), (0.1, 0.2, 0.4))])
def test_more_time_never_makes_a_motion_slower_nor_faster_than_reported(planner_id, unit, limits):
    plans = [plan(RobotModel(), LIMITS, PlanningRequest(
        [0.6, 0.0, 1.0] + [0.1, 0.15, 0.1] * unit, planner_id=planner_id,
        should_stop=Deadline(limit, CountingClock()))) for limit in limits]
    durations = [p.via_times[-1] for p in plans]
    assert durations[1] <= 1.02 * durations[0]
    assert durations[2] <= 1.02 * min(durations)
    for p in plans:
        assert min(durations) >= (1.0 - saving(p.note)) * p.via_times[-1]
