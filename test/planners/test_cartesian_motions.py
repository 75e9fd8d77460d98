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

"""What every plan along a Cartesian path keeps, on random feasible paths and on the tables."""

from dataclasses import replace

from helpers.random_paths import Measured, measured, PathCase, PLANNERS, random_case
import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.dynamics.rigid_body import inverse_dynamics
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.kinematics.inverse import inverse_kinematics
from rrr_traj_planner.core.kinematics.postures import posture_of
from rrr_traj_planner.core.trajectory.quintic_spline import spline_through
from rrr_traj_planner.planners.path_timing.planner import SMALLER, WORTH_IT
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.request import PlanningRequest

SEEDS = range(16)
HIT = 1e-9            # rad
PLACE = 1e-12         # m at the via points
ON_PATH = 1e-9        # m
LIMIT_ROOM = 1e-6     # relative
BETWEEN_POINTS = 1e-3  # relative, of the quintic through the points
REST = 1e-9           # rad/s, rad/s^2, rad/s^3
CONTINUOUS = 1e-9     # rad, rad/s, rad/s^2
TOLD = 1e-3           # rad/s^2: larger steps the note tells of
SLOWEST = 0.02        # of the largest speed of the tip, at a via point

TABLES = {  # tips [m] and torques [N m]
    '6.1': (((1.02, 0.59, 0.97), (0.46, 0.55, 1.44), (0.45, 0.38, 1.45)), (150.0, 200.0, 200.0)),
    '6.3': (((0.2, 0.8, 0.5), (0.5, 1.0, 1.0), (0.8, 1.2, 0.6)), (150.0, 250.0, 200.0))}

each_seed = pytest.mark.parametrize('seed', SEEDS)
each_planner = pytest.mark.parametrize('planner_id', PLANNERS)


@each_seed
@pytest.mark.parametrize(('values', 'limit'), [
    ('qd', 'max_velocity'), ('qdd', 'max_acceleration'), ('qddd', 'max_jerk'),
    ('torque', 'max_effort')])
def test_limits_are_kept_over_the_continuous_motion(seed, values, limit):
    m = measured(seed)
    bound = getattr(m.case.limits, limit) * (1.0 + LIMIT_ROOM)
    assert (np.abs(getattr(m, values)).max(axis=0) <= bound).all()


@each_seed
def test_position_ranges_are_kept(seed):
    m = measured(seed)
    assert (m.q >= m.case.limits.min_position - HIT).all()
    assert (m.q <= m.case.limits.max_position + HIT).all()


@each_seed
def test_motion_starts_and_ends_at_rest_with_zero_jerk(seed):
    m = measured(seed)
    q, *rest = m.motion(np.array([0.0, m.motion.duration]))
    assert forward_kinematics(m.case.model, q) == pytest.approx(
        m.case.request.via_points[[0, -1]], abs=1e-9)
    for derivative in rest:
        assert np.abs(derivative).max() <= REST
    # Not only because it is said of the end: a little before it, all is small as it should be.
    T, h = m.motion.duration, 1e-3 * (m.motion.knots[-1] - m.motion.knots[-2])
    for order, derivative in enumerate(m.motion(np.array([h, T - h]))[1:]):
        assert np.abs(derivative).max() <= 0.02 * np.abs(m.motion(m.t)[order + 1]).max()


@each_seed
def test_via_points_are_hit_on_the_branch_that_was_asked_for(seed):
    m = measured(seed)
    q, request = m.motion(m.plan.via_times)[0], m.case.request
    wanted = np.array([inverse_kinematics(m.case.model, p, request.elbow)
                       for p in request.via_points])
    assert np.exp(1j * q) == pytest.approx(np.exp(1j * wanted), abs=HIT)
    assert np.abs(forward_kinematics(m.case.model, q) - request.via_points).max() <= 10.0 * PLACE
    assert {posture_of(m.case.model, p).elbow for p in m.q} == {request.elbow}


@each_seed
def test_tip_is_on_the_path_and_within_the_deviation_of_the_polyline(seed):
    m = measured(seed)
    path, points = m.motion.arm_path.path, m.case.request.via_points
    s = np.clip(m.motion.progress(m.t)[0], 0.0, path.length)
    assert np.linalg.norm(m.tip - path(s)[0], axis=1).max() <= ON_PATH
    nearest = np.full(len(m.tip), np.inf)
    for a, b in zip(points[:-1], points[1:]):
        share = np.clip((m.tip - a) @ (b - a) / ((b - a) @ (b - a)), 0.0, 1.0)
        nearest = np.minimum(nearest, np.linalg.norm(
            m.tip - a - share[:, np.newaxis] * (b - a), axis=1))
    assert nearest.max() <= m.case.request.max_deviation + ON_PATH


@each_seed
def test_tip_goes_on_all_the_time_and_does_not_stop_at_via_points(seed):
    m = measured(seed)
    s, sd, _, _ = m.motion.progress(m.t)
    assert (np.diff(s) >= -1e-14 * s[-1]).all()
    assert s[[0, -1]] == pytest.approx((0.0, m.motion.arm_path.path.length), abs=1e-12)
    inner = m.motion.progress(m.plan.via_times[1:-1])[1]
    assert (inner > SLOWEST * sd.max()).all()
    assert (sd[1:-1] > 0.0).all()


@each_seed
def test_radii_are_the_largest_or_smaller_where_that_is_faster(seed):
    m = measured(seed)
    largest = m.case.arm_path.path.radii
    if not len(largest):
        return
    part = m.motion.arm_path.path.radii / largest
    steps = np.log(part[0]) / np.log(SMALLER)
    assert part == pytest.approx(SMALLER ** round(steps), rel=1e-6)
    gained = 1.0 - m.motion.duration / m.case.timed().duration
    assert gained >= (0.5 * WORTH_IT * round(steps) if round(steps) else -2.0 * WORTH_IT)


def test_some_radii_are_smaller():
    assert any((measured(seed).motion.arm_path.path.radii
                < 0.9 * measured(seed).case.arm_path.path.radii).any() for seed in SEEDS)


@each_seed
def test_position_velocity_and_acceleration_are_continuous_but_for_told_steps(seed):
    m = measured(seed)
    knots = m.motion.knots
    h = np.minimum(1e-9, 1e-3 * np.minimum(np.diff(knots)[1:], np.diff(knots)[:-1]))
    left, right = m.motion(knots[1:-1] - h), m.motion(knots[1:-1] + h)
    steps = np.zeros((len(h), 3))
    if m.case.request.planner_id == 'line_arc':
        at = np.searchsorted(knots[1:-1], m.motion.join_times)
        steps[at] = m.motion.acceleration_steps()
        told = 'joint accelerations step where arcs begin and end' in m.plan.note
        assert told == (steps.max() > TOLD)
    else:
        assert 'step' not in m.plan.note
    for order in range(3):
        change = right[order] - left[order] - h[:, np.newaxis] * (
            right[order + 1] + left[order + 1])
        allowed = steps * (1.0 + 1e-6) if order == 2 else 0.0
        assert (np.abs(change) <= allowed + CONTINUOUS).all()


@each_seed
def test_quintic_through_the_points_keeps_velocity_acceleration_and_torque_limits(seed):
    m = measured(seed)
    times, limits = m.plan.points.times, m.case.limits
    t = (times[:-1, np.newaxis] + np.diff(times)[:, np.newaxis] * np.linspace(0, 1, 21)).ravel()
    q, qd, qdd, _ = spline_through(m.plan.points).at(t)
    torque = inverse_dynamics(m.case.model, q, qd, qdd)
    assert (np.abs(torque).max(axis=0) <= limits.max_effort * (1.0 + BETWEEN_POINTS)).all()
    assert (np.abs(qd).max(axis=0) <= limits.max_velocity * (1.0 + BETWEEN_POINTS)).all()
    assert (np.abs(qdd).max(axis=0) <= limits.max_acceleration * (1.0 + BETWEEN_POINTS)).all()
    assert np.abs(times[:, np.newaxis] - m.plan.via_times).min(axis=0).max() <= 1e-9


@each_seed
def test_some_limit_is_all_but_used_up(seed):
    # A motion that was slowed as a whole uses none.
    m = measured(seed)
    assert m.use().max() >= 0.95


def test_same_request_gives_the_same_answer_bit_for_bit():
    for seed in (0, 1):
        first, again = measured(seed).plan, random_case(seed).planned()
        for name in ('times', 'positions', 'velocities', 'accelerations'):
            assert getattr(first.points, name).tobytes() == getattr(again.points, name).tobytes()


def share_of_time_at_limits(table, planner_id, **limits):
    """Return the part of the time in which some limit is used to 95 percent."""
    tips, effort = TABLES[table]
    case = PathCase(RobotModel(), replace(JointLimits(max_effort=effort), **limits),
                    PlanningRequest(tips, planner_id=planner_id))
    found = case.planned()
    t = np.linspace(0.0, found.trajectory.duration, 20001)
    return float((Measured(case, found, t=t).use() >= 0.95).mean())


@each_planner
@pytest.mark.parametrize('table', TABLES)
def test_some_limit_is_used_to_95_percent_for_80_percent_of_the_time(planner_id, table):
    assert share_of_time_at_limits(table, planner_id) >= 0.8


@each_planner
@pytest.mark.parametrize('table', TABLES)
def test_the_same_with_ten_times_the_jerk(planner_id, table):
    assert share_of_time_at_limits(table, planner_id, max_jerk=[100.0] * 3) >= 0.8


def test_a_circle_about_joint_axis_1_takes_the_time_of_one_turn_however_many_its_points():
    # From rest to rest with 1 rad/s and 1 rad/s^2: 2 pi + 1 s.
    angle = np.linspace(-np.pi, np.pi, 80)
    tips = np.stack((0.8 * np.cos(angle), 0.8 * np.sin(angle), np.full(80, 0.9)), axis=1)
    limits = JointLimits(min_position=[-4.0, 0.0, -np.pi], max_position=[4.0, np.pi, 6.0])
    found = plan(RobotModel(), limits, PlanningRequest(tips, planner_id='line_arc'))
    assert 1.0 <= found.via_times[-1] / (2.0 * np.pi + 1.0) <= 1.1
