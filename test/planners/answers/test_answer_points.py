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

"""The points of answers: what a controller makes of them, worked out anew and with Pinocchio."""

from dataclasses import replace
from functools import cache

from helpers.pinocchio_arm import PinocchioArm
from helpers.thesis_arm import ThesisArm
from helpers.thesis_cases import POINTS
import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.registry import planner, planner_ids
from rrr_traj_planner.planners.request import PlanningRequest

ARM, LIMITS = ThesisArm(), JointLimits()
TORQUE = replace(LIMITS, max_acceleration=np.full(3, np.inf), max_jerk=np.full(3, 100.0))
TABLE_6_1 = [POINTS[f'6.1 point {k}'][0] for k in (1, 2, 3)]
CORNER = [(1.2308, 0.0, 1.3749), (0.2161, 1.1514, 0.8252), (1.1438, 0.0, 0.9368)]
COARSE = [0.1, 0.5, 1.0]
TOUCHING = [5, 9, 12, 14, 37]
WITHOUT_ACCELERATION_LIMITS = ['line_arc', 'line_polynomial', 'time_optimal']
TOLERANCE = 1.0 + 1e-3  # of limits, for quintics between points
OVERSHOOT = 1e-6   # rad, beyond the end of a range
STRONG = np.full(3, 400.0)  # N m, enough to hold the arm anywhere
NANOSECOND = 1e-9
PER_INTERVAL = 12


def controller_motion(points, per_interval=PER_INTERVAL):
    """Return q, qd, qdd that joint_trajectory_controller follows, from the six conditions."""
    h = np.diff(points.times)
    x = np.linspace(0.0, 1.0, per_interval)

    def rows(at, derivative):
        k = np.arange(6)
        factor = np.prod([k - i for i in range(derivative)], axis=0) if derivative else 1.0
        return factor * np.asarray(at)[:, np.newaxis] ** np.maximum(k - derivative, 0)

    conditions = np.concatenate([rows([end], d) for end in (0.0, 1.0) for d in range(3)])
    q, qd, qdd = points.positions, points.velocities, points.accelerations
    s = h[:, np.newaxis]
    wanted = np.stack([x[side] * s ** d for side in (slice(None, -1), slice(1, None))
                       for d, x in enumerate((q, qd, qdd))])
    c = np.linalg.solve(conditions, wanted.reshape(6, -1)).reshape(wanted.shape)
    return [(np.einsum('xk,ksj->xsj', rows(x, d), c) / s ** d).reshape(-1, 3) for d in range(3)]


def torques(points):
    arm = PinocchioArm(ARM)
    return np.array([arm.inverse_dynamics(*state) for state in zip(*controller_motion(points))])


@cache
def planned_finely(planner_id):
    return plan(ARM, LIMITS, PlanningRequest(TABLE_6_1, planner_id=planner_id))


@pytest.mark.parametrize('period', COARSE)
@pytest.mark.parametrize('planner_id', planner_ids())
def test_a_long_sample_period_costs_no_time_or_the_note_says_how_much(planner_id, period):
    fine = planned_finely(planner_id)
    coarse = plan(ARM, LIMITS, PlanningRequest(
        TABLE_6_1, planner_id=planner_id, sample_period=period))
    slower = coarse.trajectory.duration / fine.trajectory.duration
    assert slower >= 1.0 - 1e-9
    assert (slower > 1.001) == (' % slower' in coarse.note)
    if period <= 0.1 or planner_id in ('cycloid', 'gauss', 'septic'):
        assert slower <= 1.001
    _, qd, qdd = controller_motion(coarse.points)
    assert (np.abs(qd) <= LIMITS.max_velocity * TOLERANCE).all()
    assert (np.abs(qdd) <= LIMITS.max_acceleration * TOLERANCE).all()


@pytest.mark.parametrize('period', [0.25, 0.5, 1.0])
def test_points_are_put_between_the_regular_ones(period):
    answer = plan(ARM, LIMITS, PlanningRequest(TABLE_6_1, sample_period=period))
    assert answer.trajectory.duration == pytest.approx(2.850, abs=2e-3)  # as with any period
    stamps = np.round(answer.points.times / NANOSECOND).astype(np.int64)
    assert (np.diff(stamps) >= 0.1 * period / NANOSECOND - 2).all()
    regular = period * np.arange(int(answer.trajectory.duration / period) + 1)
    away = np.abs(regular[:, np.newaxis] - answer.via_times).min(axis=1)
    regular = regular[(away > 0.1 * period) | (away < NANOSECOND)]
    assert np.isin(np.round(regular / NANOSECOND).astype(np.int64), stamps).all()
    assert len(stamps) > len(regular) + 2  # of the via times the first is regular
    assert '% slower' not in answer.note


def test_prescribed_durations_are_kept_with_any_sample_period():
    for period in (0.01, 1.4, 7.0):
        answer = plan(ARM, LIMITS, PlanningRequest(
            TABLE_6_1, segment_durations=[1.9, 1.3], sample_period=period))
        assert answer.via_times == pytest.approx([0.0, 1.9, 3.2], abs=1e-9)
        _, qd, qdd = controller_motion(answer.points)
        assert (np.abs(qdd) <= LIMITS.max_acceleration * TOLERANCE).all()


def test_further_points_count_as_points():
    # Every 0.5 s of 2.85 s, the via time and the end: 8. One more does not do: it must be slower.
    request = PlanningRequest(TABLE_6_1, sample_period=0.5)
    assert len(plan(ARM, LIMITS, request).points.times) > 9
    fewer = plan(ARM, LIMITS, replace(request, max_points=9))
    assert len(fewer.points.times) <= 9
    assert fewer.note.startswith('sample_period 0.5 s makes the motion ')
    with pytest.raises(InvalidInputError, match='has more than 5 points'):
        plan(ARM, LIMITS, replace(request, max_points=5))


@pytest.mark.parametrize(('points', 'max_deviation'), [(CORNER, 0.01), (TABLE_6_1, 0.05)])
@pytest.mark.parametrize('period', [0.01, 0.05, 0.5])
@pytest.mark.parametrize('planner_id', WITHOUT_ACCELERATION_LIMITS)
def test_torque_that_a_controller_makes_is_within_its_limits_and_reported(
        points, max_deviation, planner_id, period):
    answer = plan(ARM, TORQUE, PlanningRequest(
        points, planner_id=planner_id, sample_period=period, max_deviation=max_deviation))
    made = np.abs(torques(answer.points)).max(axis=0)
    assert (made <= TORQUE.max_effort * TOLERANCE).all()
    assert (made <= answer.effort * TOLERANCE).all()
    assert (answer.effort <= TORQUE.max_effort * (1.0 + 1e-6)).all()


@pytest.mark.parametrize('planner_id', ['time_optimal', 'line_arc', 'cycloid'])
def test_jerk_that_a_controller_makes_is_reported_where_it_is_a_tenth_above_its_limit(planner_id):
    for period in (0.002, 0.01, 0.05):
        answer = plan(ARM, LIMITS, PlanningRequest(
            TABLE_6_1, planner_id=planner_id, sample_period=period))
        _, _, qdd = controller_motion(answer.points)
        x = np.linspace(0.0, 1.0, PER_INTERVAL)
        h = np.repeat([np.diff(answer.points.times)], PER_INTERVAL, axis=0).reshape(-1, 1)
        bends = np.polynomial.polynomial.polyfit(x, qdd.reshape(PER_INTERVAL, -1), 3)
        jerk = np.abs(np.polynomial.polynomial.polyval(
            x, np.polynomial.polynomial.polyder(bends))).T.reshape(qdd.shape) / h
        share = (jerk.max(axis=0) / LIMITS.max_jerk).max()
        assert ('reach a jerk of' in answer.note) == (share > 1.1)
        if share > 1.1:
            j = int(jerk.max(axis=0).argmax())
            assert f'joint_{j + 1} reach a jerk of {jerk[:, j].max():.3g} rad/s^3' in answer.note


def test_jerk_without_a_limit_is_not_reported():
    free = replace(LIMITS, max_jerk=np.full(3, np.inf))
    assert plan(ARM, free, PlanningRequest(TABLE_6_1, planner_id='time_optimal')).note == ''


def test_no_interval_begins_or_ends_at_a_step_of_acceleration():
    # The quintic of an interval with a step at a share of it swings beyond both sides: by 37 % of
    # the step where it is at an end, and its jerk is 9 steps per interval; inside by 13 % at most.
    rng = np.random.default_rng(3)
    for period in rng.uniform(0.004, 0.03, 12):
        answer = plan(ARM, LIMITS, PlanningRequest(
            TABLE_6_1, planner_id='line_arc', sample_period=period))
        steps, times = answer.trajectory.step_times, answer.points.times
        assert len(steps) >= 1
        index = np.searchsorted(times, steps) - 1
        share = (steps - times[index]) / np.diff(times)[index]
        assert (share > 0.15).all() and (share < 0.85).all()
        assert (np.diff(times)[index] > 0.3 * period).all()
        assert np.diff(times).max() <= 1.1 * period


def outside(points, limits):
    """Return how far a controller leaves the ranges between points [rad]."""
    q = controller_motion(points, 200)[0]
    return np.maximum(limits.min_position - q, q - limits.max_position).max()


def in_ranges_that_the_motion_touches(seed, planner_id, period):
    """Return ranges that end where the joints of a motion turn back, and the two motions."""
    rng = np.random.default_rng(seed)
    q = rng.uniform([0.2, 0.7, -0.3], [1.5, 1.6, 0.7], (int(rng.integers(3, 6)), 3))
    wide = JointLimits(
        min_position=[-3.0, -1.0, -3.0], max_position=[3.0, 4.0, 3.0], max_effort=STRONG,
        max_velocity=rng.choice([0.3, 1.0, 3.0], 3), max_jerk=rng.choice([2.0, 10.0, 100.0], 3),
        max_acceleration=rng.choice([0.3, 1.0, 5.0], 3))
    request = PlanningRequest(forward_kinematics(ARM, q), planner_id=planner_id, elbow='up',
                              sample_period=period, max_deviation=0.02)
    free = plan(ARM, wide, request)
    exact = 1e-8  # to which the peaks of motions along paths are known [rad]
    limits = replace(wide, min_position=free.peaks.min_position - exact,
                     max_position=free.peaks.max_position + exact)
    return limits, free, plan(ARM, limits, request)


@pytest.mark.parametrize('seed', TOUCHING)
@pytest.mark.parametrize('planner_id', [
    p for p in planner_ids() if not planner(p).misses_via_points or p == 'cycloid_approach_a'])
def test_a_controller_stays_in_ranges_that_the_motion_touches(planner_id, seed):
    limits, free, touching = in_ranges_that_the_motion_touches(seed, planner_id, 2.0)
    assert outside(touching.points, limits) <= OVERSHOOT
    if planner_id.startswith('line'):  # the path is the same: closer points do, all but alone
        assert touching.trajectory.duration <= 1.1 * free.trajectory.duration


@pytest.mark.parametrize('end', ['min_position', 'max_position'])
@pytest.mark.parametrize('planner_id', [
    'cycloid', 'cycloid_approach_b', 'cycloid_approach_c', 'poly_414', 'poly_434'])
def test_a_controller_stays_in_ranges_at_whose_ends_joints_come_to_rest(planner_id, end):
    limits = JointLimits(min_position=[0.2, 0.7, -0.4], max_position=[1.5, 1.7, 0.8],
                         max_effort=STRONG, max_velocity=np.full(3, 0.3))
    at, sign = getattr(limits, end), 1.0 if end == 'min_position' else -1.0
    displacements = np.array([[0.5, 0.4, 0.3], [0.0, 0.2, 0.0], [0.0, 0.0, 0.4], [0.3, 0.0, 0.2]])
    tips = forward_kinematics(ARM, at + sign * displacements)
    for period in (0.3, 1.0, 2.0):
        answer = plan(ARM, limits, PlanningRequest(
            tips, planner_id=planner_id, elbow='up', sample_period=period))
        assert outside(answer.points, limits) <= OVERSHOOT
