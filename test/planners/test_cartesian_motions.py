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

"""Motions along a Cartesian path: tip, path and speed, on random paths and on the tables."""

from dataclasses import replace

from helpers.measured_motions import BESIDE, CARTESIAN, Measured, planned_motions, seeds_for
from helpers.path_cases import distance_to_polyline
from helpers.random_paths import PathCase
import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.kinematics.postures import posture_of
from rrr_traj_planner.core.trajectory.quintic_spline import spline_through
from rrr_traj_planner.planners.path_timing.planner import SMALLER, WORTH_IT
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.request import PlanningRequest

CASES = [(planner_id, seed) for planner_id in CARTESIAN for seed in seeds_for(planner_id)]
VIA_POINT = 1e-11     # m
ON_PATH = 1e-9        # m
REST = 1e-9           # rad/s^3
STEP = 1e-5           # rad/s^2, within BESIDE
QUINTIC_JERK = 1.15   # of the limit, as the answer's points are divided from 1.1 on
PER_INTERVAL = 20     # evaluations between two points
SLOWEST = 0.02        # of the tip's largest speed, at a via point

TABLES = {  # tips [m] and torques [N m]
    '6.1': (((1.02, 0.59, 0.97), (0.46, 0.55, 1.44), (0.45, 0.38, 1.45)), (150.0, 200.0, 200.0)),
    '6.3': (((0.2, 0.8, 0.5), (0.5, 1.0, 1.0), (0.8, 1.2, 0.6)), (150.0, 250.0, 200.0))}

each_planner = pytest.mark.parametrize('planner_id', CARTESIAN)


@pytest.fixture(params=CASES, ids=lambda case: f'{case[0]}-{case[1]}')
def m(request):
    """Return the measured motion of a random path."""
    planner_id, seed = request.param
    return planned_motions(planner_id)[seed]


def test_jerk_is_zero_at_the_ends_and_everything_small_beside_them(m):
    motion, T = m.trajectory, m.trajectory.duration
    assert np.abs(motion(np.array([0.0, T]))[3]).max() <= REST
    # The ends may be set by definition: what is beside them is computed.
    h = 1e-3 * (motion.knots[-1] - motion.knots[-2])
    beside = motion(np.array([h, T - h]))
    for derivative, name in zip(beside[1:], ('qd', 'qdd', 'qddd')):
        assert np.abs(derivative).max() <= 0.02 * m.largest(name).max()


def test_tip_passes_the_via_points_and_the_elbow_stays_on_the_requested_branch(m):
    tip = forward_kinematics(m.task.model, m.trajectory(m.plan.via_times)[0])
    assert np.abs(tip - m.task.request.via_points).max() <= VIA_POINT
    assert {posture_of(m.task.model, q).elbow for q in m.q} == {m.task.request.elbow}


def test_tip_is_on_the_path_and_within_the_deviation_from_the_polyline(m):
    path, request = m.trajectory.arm_path.path, m.task.request
    s = np.clip(m.trajectory.progress(m.t)[0], 0.0, path.length)
    assert np.linalg.norm(m.tip - path(s)[0], axis=1).max() <= ON_PATH
    distance = distance_to_polyline(request.via_points, m.tip)
    assert distance.max() <= request.max_deviation + ON_PATH


def test_tip_never_stops_or_turns_back_before_the_end(m):
    s, sd, _, _ = m.trajectory.progress(m.t)
    assert (np.diff(s) >= -1e-14 * s[-1]).all()
    assert s[[0, -1]] == pytest.approx((0.0, m.trajectory.arm_path.path.length), abs=1e-12)
    inner = m.trajectory.progress(m.plan.via_times[1:-1])[1]
    assert (inner > SLOWEST * sd.max()).all()
    assert (sd[1:-1] > 0.0).all()


def test_accelerations_step_by_what_the_motion_reports(m):
    motion, at = m.trajectory, m.trajectory.join_times
    steps = np.abs(motion(at)[2] - motion(at - BESIDE)[2])
    wanted = motion.acceleration_steps() if m.task.request.planner_id == 'line_arc' else 0.0
    assert steps == pytest.approx(np.broadcast_to(wanted, steps.shape), abs=STEP)


@pytest.mark.parametrize('seed', seeds_for('line_polynomial'))
def test_a_controller_s_quintics_keep_the_jerk_limit_where_acceleration_is_continuous(seed):
    # Jerk steps at joins, by up to twice its limit: without a point there it would be 1.74 of it.
    m = planned_motions('line_polynomial')[seed]
    times = m.plan.points.times
    share = np.arange(PER_INTERVAL) / PER_INTERVAL
    t = (times[:-1, np.newaxis] + np.diff(times)[:, np.newaxis] * share).ravel()
    jerk = np.abs(spline_through(m.plan.points).at(t)[3])
    assert (jerk <= QUINTIC_JERK * m.task.sampled_limits.max_jerk).all()


def test_radii_are_the_largest_or_smaller_where_that_is_faster(m):
    largest = m.task.arm_path.path.radii
    if not len(largest):
        return
    part = m.trajectory.arm_path.path.radii / largest
    steps = np.log(part[0]) / np.log(SMALLER)
    assert part == pytest.approx(SMALLER ** round(steps), rel=1e-6)
    along_largest = m.task.timed(max_jerk=m.task.sampled_limits.max_jerk).duration
    gained = 1.0 - m.trajectory.duration / along_largest
    assert gained >= -2.0 * WORTH_IT  # rough motions are compared


def test_some_radii_are_smaller_than_the_largest():
    motions = [planned_motions(planner_id)[seed] for planner_id, seed in CASES]
    assert any((m.trajectory.arm_path.path.radii < 0.9 * m.task.arm_path.path.radii).any()
               for m in motions)


def test_some_limit_is_used_to_95_percent(m):
    # A motion that was slowed down as a whole reaches none.
    assert m.utilisation().max() >= 0.95


def share_of_time_at_limits(table, planner_id, **limits):
    """Return the part of the time in which some limit is used to 95 percent."""
    tips, effort = TABLES[table]
    case = PathCase(RobotModel(), replace(JointLimits(max_effort=effort), **limits),
                    PlanningRequest(tips, planner_id=planner_id))
    found = case.planned()
    t = np.linspace(0.0, found.trajectory.duration, 20001)
    return float((Measured(case, found, t=t).utilisation() >= 0.95).mean())


@each_planner
@pytest.mark.parametrize('table', TABLES)
def test_some_limit_is_used_to_95_percent_for_80_percent_of_the_time(planner_id, table):
    assert share_of_time_at_limits(table, planner_id) >= 0.8


@each_planner
@pytest.mark.parametrize('table', TABLES)
def test_some_limit_is_used_as_long_with_ten_times_the_jerk(planner_id, table):
    assert share_of_time_at_limits(table, planner_id, max_jerk=[100.0] * 3) >= 0.8


def test_a_circle_about_joint_axis_1_takes_the_time_of_one_turn_however_many_its_points():
    # From rest to rest with 1 rad/s and 1 rad/s^2: 2 pi + 1 s.
    angle = np.linspace(-np.pi, np.pi, 80)
    tips = np.stack((0.8 * np.cos(angle), 0.8 * np.sin(angle), np.full(80, 0.9)), axis=1)
    limits = JointLimits(min_position=[-4.0, 0.0, -np.pi], max_position=[4.0, np.pi, 6.0])
    found = plan(RobotModel(), limits, PlanningRequest(tips, planner_id='line_arc'))
    assert 1.0 <= found.via_times[-1] / (2.0 * np.pi + 1.0) <= 1.1
