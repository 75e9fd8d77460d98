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

"""`time_optimal` with prescribed durations, of all segments or of some."""

from dataclasses import replace

from helpers.planning_cases import ARM, LIMITS, NONE, STRONG
from helpers.time_optimal_cases import (
    A,
    B,
    C,
    durations_of,
    each_limits,
    GAP,
    KEPT,
    measured,
    table,
    through,
    TORQUE_LIMITED,
)
import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.errors import TimingError
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.request import PlanningRequest

SLACK = 1.0 + 1e-6  # of limits

each_strong_limits = pytest.mark.parametrize(
    'limits', [LIMITS, replace(STRONG, **TORQUE_LIMITED)], ids=['acceleration', 'torque'])
DURATIONS = [
    ([3.0, 3.0], [A, B, C]), ([2.5, 6.0], [A, B, C]), ([9.0, 2.4], [A, B, C]),
    ([np.nan, 4.0], [A, B, C]), ([3.0, np.nan], [A, B, C]),
    ([2.5, np.nan, 3.0, np.nan], [A, B, C, B, A]), ([np.nan, 2.0, np.nan], [A, B, B, C]),
    ([5.0], [A, B])]


@pytest.mark.parametrize(('durations', 'q'), DURATIONS)
@each_strong_limits
def test_prescribed_durations_are_kept(limits, durations, q):
    m, given = measured(limits, q, segment_durations=durations), ~np.isnan(durations)
    assert durations_of(m.plan)[given] == pytest.approx(np.array(durations)[given], abs=KEPT)
    assert m.violations() == []


def test_a_free_segment_beside_a_prescribed_one_takes_no_longer_than_from_stop_to_stop():
    def alone(q):
        return plan(ARM, LIMITS, through(q)).via_times[-1]

    for durations, k, q in (([np.nan, 4.0], 0, [A, B]), ([3.0, np.nan], 1, [B, C])):
        free = durations_of(plan(ARM, LIMITS, through([A, B, C], segment_durations=durations)))[k]
        assert free <= alone(q) * (1.0 + GAP)
        assert free >= 0.3 * alone(q)


def test_a_fastest_plan_s_own_durations_given_for_one_segment_leave_the_other_as_it_was():
    free = durations_of(plan(ARM, LIMITS, table('6.1')))
    for k in range(2):
        durations = np.where(np.arange(2) == k, 1.0001 * free, np.nan)
        found = durations_of(plan(ARM, LIMITS, table('6.1', segment_durations=durations)))
        assert found[1 - k] == pytest.approx(free[1 - k], rel=2.0 * GAP)


@pytest.mark.parametrize('slower', [1.2, 2.0, 5.0])
@each_strong_limits
def test_prescribed_motions_accelerate_no_more_than_the_fastest_one_slowed_down(limits, slower):
    fastest = plan(ARM, limits, table('6.1'))
    durations = slower * durations_of(fastest)
    gentle = plan(ARM, limits, table('6.1', segment_durations=durations))
    scale = np.where(np.isinf(limits.max_acceleration), 1.0, limits.max_acceleration)
    slowed = (fastest.peaks.acceleration / scale).max() / slower ** 2
    assert (gentle.peaks.acceleration / scale).max() <= slowed * (1.0 + 1e-6)


def test_a_prescribed_motion_from_rest_to_rest_has_nearly_the_least_peak_acceleration():
    # D = a (T / 2)^2 at constant acceleration, then deceleration: no motion has a lower peak. With
    # 20 ramps, two of which pass through zero: v = 9 a h half-way, D = 90 a h^2, h = T / 20.
    q, T = [A, [1.3, 1.4, 0.0]], 4.0
    gentle = plan(ARM, LIMITS, through(q, segment_durations=[T]))
    assert 4.0 / T ** 2 <= gentle.peaks.acceleration[0] <= 1.02 * (400.0 / 90.0) / T ** 2


@pytest.mark.parametrize('durations', [[0.5, 0.5], [1.0, 20.0], [np.nan, 0.4], [0.3, np.nan]])
@each_limits
def test_durations_too_short_are_refused_with_feasible_ones(limits, durations):
    free = durations_of(plan(ARM, limits, table('6.1')))
    if np.isinf(limits.max_acceleration).all():
        durations = 0.9 * np.array(durations) * free
    with pytest.raises(TimingError, match=(
            r'^segment_durations \[.*\] s are too short: the least feasible are')) as refusal:
        plan(ARM, limits, table('6.1', segment_durations=durations))
    offered = np.array(refusal.value.least_durations)
    given = ~np.isnan(durations)
    assert (offered[given] >= np.array(durations)[given]).all()
    answer = plan(ARM, limits, table('6.1', segment_durations=offered))
    assert durations_of(answer) == pytest.approx(offered, abs=KEPT)


def test_durations_that_are_offered_are_at_most_1_percent_longer_than_the_least():
    free = durations_of(plan(ARM, LIMITS, table('6.1')))
    with pytest.raises(TimingError) as refusal:
        plan(ARM, LIMITS, table('6.1', segment_durations=0.9 * free))
    assert np.sum(refusal.value.least_durations) <= 1.01 * free.sum()


def test_only_durations_that_are_too_short_are_refused():
    # rest to rest over 1 rad at 1 rad/s^2: no motion takes less than 2 s
    q = [A, [1.3, 1.4, 0.0]]
    with pytest.raises(TimingError):
        plan(ARM, LIMITS, through(q, segment_durations=[1.999]))
    fastest = plan(ARM, LIMITS, through(q)).via_times[-1]
    with pytest.raises(TimingError):
        plan(ARM, LIMITS, through(q, segment_durations=[fastest * (1.0 - 2.0 * GAP)]))
    assert plan(ARM, LIMITS, through(
        q, segment_durations=[fastest * (1.0 + 1e-6)])).via_times[-1] == pytest.approx(
            fastest, rel=1e-5)


def test_durations_that_are_all_nan_are_as_none():
    free, none = (plan(ARM, LIMITS, table('6.1', segment_durations=d))
                  for d in ([np.nan, np.nan], None))
    assert (free.via_times == none.via_times).all()


def test_long_durations_are_kept_where_gravity_exceeds_a_limit_by_a_millionth_on_the_path():
    q = [(0.1, 1.3, 0.7), (1.2, 1.4, 0.4), (1.3, 0.8, 0.8), (0.2, 1.6, 0.4), (0.4, 0.7, 0.8),
         (1.5, 0.8, 0.4), (1.0, 0.8, -0.1), (0.9, 1.4, 0.0), (0.8, 0.8, 0.6), (1.1, 0.7, 0.3)]
    m = measured(LIMITS, q, segment_durations=[20.8] * 9, velocity_scaling=0.3)
    assert durations_of(m.plan) == pytest.approx([20.8] * 9, abs=KEPT)
    assert m.violations() == []


@pytest.mark.parametrize('seed', [8, 17, 25, 37, 45])
def test_durations_of_the_fastest_motion_a_little_slower_are_kept_at_ends_of_ranges(seed):
    """Slowed, that motion keeps every limit: gravity alone is within those of torque."""
    rng = np.random.default_rng(1000 + seed)
    n, beside_ends = int(rng.integers(3, 13)), seed % 4 != 1
    low, high = np.array([-1.0, 0.3, -1.0]), np.array([1.0, 1.8, 1.0])
    q, where = rng.uniform(low, high, (n, 3)), rng.random((n, 3))
    inside = 10.0 ** -rng.uniform(1.0, 7.0, (n, 3)) if beside_ends else 0.0
    q = np.where(where < 0.3, low + inside, np.where(where > 0.7, high - inside, q))
    by_torque = rng.random() < 0.5
    limits = JointLimits(
        min_position=low, max_position=high, max_velocity=[1.5] * 3,
        max_jerk=[100.0 if by_torque else 20.0] * 3,
        max_acceleration=NONE if by_torque else [2.0] * 3,
        max_effort=[350.0, 350.0, 150.0] if by_torque else NONE)
    request = PlanningRequest(joint_via_points=q, planner_id='time_optimal')
    durations = 1.05 * durations_of(plan(ARM, limits, request))
    found = plan(ARM, limits, replace(request, segment_durations=durations))
    assert durations_of(found) == pytest.approx(durations, abs=KEPT)
    for name in ('velocity', 'acceleration', 'jerk'):
        assert (getattr(found.peaks, name) <= getattr(limits, f'max_{name}') * SLACK).all()
    assert (found.effort <= limits.max_effort * SLACK).all()


@pytest.mark.parametrize('q', [[A, B], [A, B, C], [C, A, B, C, B]])
@each_strong_limits
def test_durations_of_a_plan_are_its_own_again(limits, q):
    own = plan(ARM, limits, through(q))
    found = plan(ARM, limits, through(q, segment_durations=durations_of(own)))
    assert durations_of(found) == pytest.approx(durations_of(own), abs=KEPT)
