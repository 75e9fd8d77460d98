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

"""Prescribed segment durations: every planner in joint space keeps them or offers others."""

from dataclasses import replace

from helpers.measured_motions import JOINT_SPACE, Measured
from helpers.planning_cases import ARM, LIMITS, table
from helpers.random_tasks import random_task, Task
import numpy as np
import pytest
from rrr_traj_planner.core.errors import ConvergenceError, InvalidInputError, TimingError
from rrr_traj_planner.core.kinematics.inverse import inverse_kinematics
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.registry import planner
from rrr_traj_planner.planners.short_durations import least_feasible

KEPT = 1e-9  # s
IMPOSSIBLE = {'cycloid_approach_a': ([10.0, 3.5], [3.0, 30.0])}  # it has no motion for these
WITH_DURATION = [s for s in range(32) if s % 8 not in (2, 6)]  # repeated points have none
MOST_REFUSED_AGAIN = 0.05

each_planner = pytest.mark.parametrize('planner_id', JOINT_SPACE)


@each_planner
@pytest.mark.parametrize('durations', [[4.0, 4.0], [10.0, 3.5], [3.0, 30.0]])
def test_long_enough_durations_are_kept_within_every_limit(planner_id, durations):
    if durations in IMPOSSIBLE.get(planner_id, ()):
        return
    request = table('6.1', planner_id=planner_id, segment_durations=durations)
    q = np.array([inverse_kinematics(ARM, tip) for tip in request.via_points])
    m = Measured(Task(0, '', ARM, LIMITS, q, request), plan(ARM, LIMITS, request))
    assert m.plan.via_times == pytest.approx([0.0, durations[0], sum(durations)], abs=KEPT)
    misses = ['via points'] * planner(planner_id).misses_via_points
    assert m.violations() == misses
    assert ('missed by construction: 1 by' in m.plan.note) == bool(misses)


@each_planner
@pytest.mark.parametrize('durations', [[0.5, 0.5], [1.0, 1.2], [1.6, 0.3], [0.3, 2.0]])
def test_too_short_durations_are_refused_with_feasible_ones_that_are_then_accepted(
        planner_id, durations):
    request = table('6.1', planner_id=planner_id, segment_durations=durations)
    with pytest.raises(TimingError, match=(
            r'^segment_durations \[.*\] s are too short.*feasible .*\[.*\] s$')) as refusal:
        plan(ARM, LIMITS, request)
    offered = refusal.value.least_durations
    assert str(list(offered)) in str(refusal.value)
    assert (np.array(offered) >= durations).all()
    answer = plan(ARM, LIMITS, replace(request, segment_durations=offered))
    assert np.diff(answer.via_times) == pytest.approx(offered, abs=KEPT)


@pytest.mark.parametrize('planner_id', ['cycloid', 'cycloid_approach_b'])
def test_offered_durations_are_the_least_in_their_proportion(planner_id):
    request = table('6.1', planner_id=planner_id, segment_durations=[1.0, 1.0])
    with pytest.raises(TimingError) as refusal:
        plan(ARM, LIMITS, request)
    offered = np.array(refusal.value.least_durations)
    assert offered.sum() < 10.0
    with pytest.raises(TimingError):
        plan(ARM, LIMITS, replace(request, segment_durations=0.99 * offered))


def test_margins_grow_until_durations_are_feasible_and_none_are_offered_if_they_never_are():
    tried, candidates = [], [np.array([1.0, 2.0]), np.array([4.0, 5.0])]

    def is_feasible(T):
        tried.append(T.tolist())
        return T[0] > 4.01

    found = least_feasible(np.ones(2), candidates, is_feasible)
    parts = 1e-6, 1e-5, 1e-4, 1e-3, 1e-2
    assert tried[:2] == [[1.0, 2.0], [1.000001, 2.000002]]
    assert tried[7] == [4.0, 5.0]
    assert [T[0] for T in tried[8:]] == pytest.approx(
        [4.0 * (1.0 + part) for part in parts], abs=2e-6)
    assert found.tolist() == tried[-1]
    with pytest.raises(ConvergenceError, match=(
            r'^no feasible durations found for segment_durations \[1\.0, 1\.0\] s$')):
        least_feasible(np.ones(2), candidates[:1], is_feasible)


def test_cycloid_refuses_durations_of_some_segments_only():
    with pytest.raises(InvalidInputError, match=(
            r'segment_durations\[1\] is nan: planner cycloid takes every duration or none')):
        plan(ARM, LIMITS, table('6.1', planner_id='cycloid', segment_durations=[3.0, np.nan]))


def test_refusal_names_the_segments_that_are_too_short():
    with pytest.raises(TimingError, match=r'too short for segment 1: the least feasible are \[9'):
        plan(ARM, LIMITS, table('6.1', segment_durations=[9.0, 0.3]))
    with pytest.raises(TimingError, match='too short for segments 0, 1: '):
        plan(ARM, LIMITS, table('6.1', segment_durations=[0.3, 0.3]))


def durations_of(task, answer):
    """Return the durations of a plan's segments, the one from the start included."""
    first = [] if task.request.start is None else [0.0]
    return np.diff(np.concatenate((first, answer.via_times)))


def test_a_plan_s_own_durations_are_nearly_always_accepted_and_kept():
    refused, accepted = [], 0
    for seed in WITH_DURATION:
        task = random_task(seed)
        durations = durations_of(task, plan(task.model, task.limits, task.request))
        try:
            answer = plan(task.model, task.limits, task.request_to(
                'cycloid', segment_durations=durations))
        except TimingError:
            refused.append(seed)
            continue
        accepted += 1
        assert durations_of(task, answer) == pytest.approx(durations, abs=KEPT)
    assert len(refused) <= MOST_REFUSED_AGAIN * accepted
