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

"""`time_optimal`: its motion times on the thesis's tables, by laws, and on special tasks."""

from dataclasses import replace

from helpers.hard_cases import HARD_CASES
from helpers.measured_motions import HIT
from helpers.planning_cases import ARM, LIMITS, NONE, STRONG
from helpers.public_arms import Arm, arms, violations
from helpers.public_arms import task as public_task
from helpers.time_optimal_cases import (
    A,
    B,
    C,
    each_limits,
    GAP,
    measured,
    table,
    through,
    time_to_save,
    TORQUE_LIMITED,
)
import numpy as np
import pytest
from rrr_traj_planner.core.dynamics.rigid_body import gravity_torque, inertia_matrix
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.tasks import LEAST_JERK_RISE

# Table, limits, the least time of any motion whose jerk may jump (NOTES 3), what ours may take.
TIMES = [
    ('6.1', LIMITS, 2.1285, 2.16), ('6.3', STRONG, 2.5815, 2.615),
    ('6.1', replace(LIMITS, **TORQUE_LIMITED), 1.0490, 1.07),
    ('6.3', replace(STRONG, **TORQUE_LIMITED), 1.5389, 1.57),
    ('6.1', replace(LIMITS, max_acceleration=NONE, max_jerk=NONE), 0.9181, 0.945)]


@pytest.mark.parametrize(('name', 'limits', 'least', 'most'), TIMES)
def test_tables_are_near_the_limit_and_not_below(name, limits, least, most):
    answer = plan(ARM, limits, table(name))
    assert least - 5e-5 <= answer.trajectory.duration <= most
    assert answer.note == ''


@pytest.mark.parametrize(('name', 'limits'), [('6.1', LIMITS), ('6.3', STRONG)])
def test_tables_take_at_most_nine_tenths_of_cycloid_s_time(name, limits):
    ours, cycloid = (plan(ARM, limits, table(name, planner_id=p)).trajectory.duration
                     for p in ('time_optimal', 'cycloid'))
    assert ours <= 0.9 * cycloid


@pytest.mark.parametrize(('D', 'v', 'a', 'J'), [
    (0.4, 10.0, 1.0, 1e4), (1.2, 0.5, 1.0, 1e3), (0.3, 10.0, 50.0, 5.0), (0.8, 0.4, 0.6, 3.0)])
def test_a_single_segment_takes_about_the_closed_form_of_least_time(D, v, a, J):
    # From rest to rest with piecewise constant jerk: seven pieces or fewer.
    def least(J):
        def ramped(u):  # the least time of a change of velocity from 0 to u
            return u / a + a / J if u >= a * a / J else 2.0 * np.sqrt(u / J)

        low, high = 0.0, v
        for _ in range(100):
            u = 0.5 * (low + high)
            low, high = (u, high) if u * ramped(u) < D else (low, u)
        return 2.0 * ramped(u) + max(D - u * ramped(u), 0.0) / u

    limits = replace(LIMITS, max_velocity=[v] * 3, max_acceleration=[a] * 3, max_jerk=[J] * 3,
                     max_effort=NONE)
    q = [[0.2, 1.2, 0.1], [0.2 + D, 1.2, 0.1]]
    found = plan(ARM, limits, through(q, sample_period=0.002)).trajectory
    # Jerk takes least_jerk_rise from zero to its limit, and four pulses of it have two ends each.
    assert least(J) <= found.duration <= 1.02 * least(J) + 4.0 * LEAST_JERK_RISE


def test_motion_times_do_not_depend_on_the_unit_of_time():
    # Velocities by k, accelerations by k^2, jerk by k^3: the same motion, 1 / k as long.
    free = replace(LIMITS, max_effort=NONE, max_jerk=np.full(3, 1.0))
    fast = replace(free, max_velocity=2.0 * free.max_velocity,
                   max_acceleration=4.0 * free.max_acceleration, max_jerk=8.0 * free.max_jerk)
    slow, quick = (plan(ARM, limits, replace(table('6.1'), least_jerk_rise=rise)
                        ).trajectory.duration for limits, rise in ((free, 0.04), (fast, 0.02)))
    assert quick == pytest.approx(0.5 * slow, rel=GAP)


def test_lower_limits_never_make_a_motion_faster():
    times = [plan(ARM, replace(LIMITS, max_effort=LIMITS.max_effort * k),
                  table('6.1')).trajectory.duration for k in (1.0, 0.9, 0.83)]
    assert times[0] <= times[1] * (1.0 + GAP)
    assert times[1] <= times[2] * (1.0 + GAP)


@pytest.mark.parametrize('effort', [100.0, 20.0, 5.0, 1.0])
def test_joint_1_alone_takes_about_the_least_time_however_weak_its_motor(effort):
    q = [[0.2, 1.4, 0.1], [1.2, 1.4, 0.1]]
    limits = replace(LIMITS, max_velocity=NONE, max_acceleration=NONE, max_jerk=NONE,
                     max_effort=[effort, 250.0, 200.0])
    m = measured(limits, q)
    assert m.violations() == []
    # Full torque in both directions at the inertia of the two poses; ramps lose a part of it.
    most = 1.05 * 2.0 * np.sqrt(inertia_matrix(ARM, q[0])[0, 0] / effort)
    assert m.plan.via_times[-1] <= most


SMOOTH = np.stack([0.8 + 0.6 * np.sin(np.linspace(0.0, 9.0, 40)),
                   1.5 + 0.3 * np.cos(np.linspace(0.0, 13.0, 40)),
                   0.4 * np.sin(np.linspace(0.0, 17.0, 40))], axis=1)
NEAR = [1.0 + 6e-5, 1.8 - 6e-5, 0.3 + 5e-5]  # 1e-4 rad from B
SPECIAL = {
    'close pair': [A, B, NEAR, C], 'close pair at the start': [B, NEAR, A],
    'close pair alone': [B, NEAR], 'close pair and back': [A, B, NEAR, B, C],
    'repeated points': [A, A, B, B, B, C, C], 'reversal': [A, B, A, B], 'forty points': SMOOTH,
    'one joint moves': [A, [0.3, 1.4, 0.9], [0.3, 1.4, 0.2]],
    'points at the ends of ranges': [A, [0.0, 1.6, 0.2], [np.pi / 2, 1.5, -0.3],
                                     [0.0, 1.3, 0.1], [0.0, 1.5, 0.4]],
    'a joint stays at the end of its range': [[0.0, 1.3, 0.1], [0.0, 1.8, -0.3], [0.0, 1.5, 0.2]],
}


@pytest.mark.parametrize('name', SPECIAL)
@each_limits
def test_special_tasks_converge_within_every_limit(limits, name):
    m = measured(limits, SPECIAL[name])
    assert m.violations() == []
    assert time_to_save(m.plan) < 1.0


@pytest.mark.parametrize('name', HARD_CASES)
def test_hard_cases_are_planned_within_every_limit(name):
    q, changes = HARD_CASES[name]
    assert measured(replace(LIMITS, **changes), q).violations() == []


def test_repeated_points_share_their_via_time_and_take_no_time():
    once, more = (measured(LIMITS, q).plan for q in ([A, B, C], [A, A, B, B, C]))
    assert (once.via_times == more.via_times[[0, 2, 4]]).all()
    assert more.via_times[0] == more.via_times[1] == 0.0
    assert more.via_times[2] == more.via_times[3]


@each_limits
def test_another_point_close_to_a_via_point_takes_hardly_more_time(limits):
    # Every joint reverses at B: a point next to it takes the little time to reach it.
    with_pair, without = (measured(limits, q).plan.via_times[-1]
                          for q in ([A, B, NEAR, C], [A, B, C]))
    assert without * (1.0 - GAP) <= with_pair <= 1.01 * without


def test_a_start_state_is_the_first_point_of_the_same_motion():
    away = plan(ARM, LIMITS, through([B, C], start=A))
    whole = plan(ARM, LIMITS, through([A, B, C]))
    assert away.trajectory.duration == pytest.approx(whole.trajectory.duration, rel=GAP)
    assert len(away.via_times) == 2
    assert away.trajectory(np.zeros(1))[0][0] == pytest.approx(A, abs=HIT)
    # no stop at the first via point
    assert np.abs(away.trajectory(away.via_times[:1])[1]).max() > 0.01


def test_a_joint_with_equal_via_positions_ends_where_it_was():
    m = measured(LIMITS, [A, [0.3, 1.4, 0.9], A])
    assert m.violations() == []
    assert m.q[[0, -1], 0] == pytest.approx([0.3, 0.3], abs=HIT)


@pytest.mark.parametrize('heavy', [0, 1, 2])
def test_gravity_may_take_99_percent_of_a_torque_limit_at_a_via_point(heavy):
    lighter = [[0.8, 1.57, -0.4], [0.5, 1.5, 0.0]]
    q = np.insert(lighter, heavy, C, axis=0)
    holding = np.abs(gravity_torque(ARM, q))[:, 1]
    assert holding.argmax() == heavy
    limits = replace(LIMITS, max_effort=[150.0, holding[heavy] / 0.99, 200.0])
    assert measured(limits, q).violations() == []


def test_a_joint_with_neither_acceleration_nor_effort_limit_is_refused_by_name():
    limits = replace(LIMITS, max_acceleration=[1.0, np.inf, 1.0],
                     max_effort=[150.0, np.inf, 200.0])
    with pytest.raises(InvalidInputError, match=(
            'fastest motion needs an acceleration or an effort limit on every joint, '
            'joint_2 has neither')):
        plan(ARM, limits, table('6.1'))
    plan(ARM, replace(limits, max_effort=STRONG.max_effort), table('6.1'))


@pytest.mark.parametrize('name', ['trifinger', 'trifinger_pro', 'uarm_swift_pro', 'bolt_leg'])
@pytest.mark.parametrize('effort', [100.0, 1000.0, 1e5])
def test_effort_limits_that_are_placeholders_are_no_reason_to_refuse(name, effort):
    """Light arms with efforts of URDFs that nobody has measured, and no other limit."""
    arm = next(arm for arm in arms(name) if arm.name == name)
    arm = Arm(name, arm.model, replace(
        arm.limits, max_velocity=NONE, max_acceleration=NONE, max_jerk=NONE,
        max_effort=np.full(3, effort)))
    request = public_task(arm, 'time_optimal', np.random.default_rng(4))
    answer = plan(arm.model, arm.limits, request)
    assert violations(arm, request, answer) == []  # by Pinocchio
    segments = np.diff(answer.via_times)
    assert segments.max() < 1.2  # s: 100 sample periods from rest to rest, and to spare
