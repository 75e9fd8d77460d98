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

"""
What the plans of every planner satisfy, on random feasible tasks.

Each task is planned once; every claim is then tested on all plans of a planner, by evaluating the
motion on a grid of 20 times a sample, with every knot and the time just before it.
"""

from helpers.measured_motions import (
    CARTESIAN,
    exceeding,
    HIT,
    LIMIT_MARGIN,
    LIMITED,
    outcomes,
    planned_motions,
    task_for,
)
import numpy as np
import pytest
from rrr_traj_planner.core.dynamics.rigid_body import inverse_dynamics
from rrr_traj_planner.core.trajectory.quintic_spline import spline_through
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.registry import planner, planner_ids

MOST_REFUSALS = 0.11   # of the motions that are planned
REPORTED_JERK = 1.1    # times its limit, of the quintic through the points
BETWEEN_POINTS = 1e-3  # relative, of the quintic through the points
NANOSECOND = 1e-9
TORQUE_MISS = 1e-6     # relative, of a torque peak between the points of its search
FINE = 200.0           # times in the shortest piece
STEP = 1e-3            # rad/s^2: larger steps of acceleration are reported
BLENDING = ['cycloid_approach_b', 'poly_414']  # they miss via points by construction
CONTINUOUS_JERK = ['cycloid', 'cycloid_approach_a', 'cycloid_approach_b', 'cycloid_approach_c',
                   'septic', 'time_optimal']
JERK_RATE = 20.0       # of jerk: peaks in the shortest piece; a septic's begins with 16
PATH_EXTREMES = 2e-7   # rad: how far the extremes of a motion along a path are from its peaks


def shortest_piece(trajectory):
    """Return the duration of the shortest piece [s]."""
    if hasattr(trajectory, 'profiles'):
        return min(p.pieces.duration.min() for p in trajectory.profiles)
    return np.diff(trajectory.knots).min()


@pytest.fixture(scope='module', params=planner_ids())
def planner_id(request):
    return request.param


@pytest.fixture(scope='module')
def motions(planner_id):
    return planned_motions(planner_id)


def test_few_tasks_are_refused_and_all_for_gravity_between_via_points(planner_id):
    planned, refused = outcomes(planner_id)
    assert len(refused) <= MOST_REFUSALS * len(planned)
    for _, error in refused.values():
        assert 'along the segment' in str(error) or 'no path found' in str(error)
        assert error.value > error.limit


def test_via_points_are_passed_exactly_but_by_planners_that_blend_them(planner_id, motions):
    assert planner(planner_id).misses_via_points == (planner_id in BLENDING)
    if planner_id in BLENDING:
        assert all('missed by construction' in m.plan.note for m in motions.values()
                   if m.via_point_errors().max() > HIT)
    else:
        assert exceeding(motions, lambda m: m.via_point_errors() - HIT) == {}


def test_motion_starts_and_ends_at_rest_at_the_right_positions(motions):
    for m in motions.values():
        q, qd, qdd, _ = m.trajectory(np.array([0.0, m.trajectory.duration]))
        assert np.exp(1j * q) == pytest.approx(np.exp(1j * m.task.q[[0, -1]]), abs=HIT)
        assert max(np.abs(qd).max(), np.abs(qdd).max()) <= HIT
        assert m.plan.points.velocities[[0, -1]].tolist() == [[0.0] * 3] * 2
        assert m.plan.points.accelerations[[0, -1]].tolist() == [[0.0] * 3] * 2


def test_position_velocity_and_acceleration_are_continuous_but_for_reported_steps(motions):
    def jump(m):
        dt, peaks = np.diff(m.t)[:, np.newaxis], m.plan.peaks
        jumps = [np.abs(np.diff(value, axis=0)) - rate * dt for value, rate in (
            (m.q, peaks.velocity), (m.qd, peaks.acceleration), (m.qdd, peaks.jerk))]
        at_step = np.isin(m.t[1:], m.trajectory.step_times)
        steps = jumps[2][at_step].max(initial=0.0)
        jumps[2][at_step] = 0.0
        assert ('joint accelerations step' in m.plan.note) == (steps > STEP)
        return np.max(jumps) - HIT

    assert exceeding(motions, jump) == {}


@pytest.mark.parametrize('planner_id', CONTINUOUS_JERK, indirect=True)
def test_jerk_is_continuous_where_the_planner_promises_it(motions):
    def jump(m):
        rate = JERK_RATE * m.plan.peaks.jerk / shortest_piece(m.trajectory)
        return np.abs(np.diff(m.qddd, axis=0)) - rate * np.diff(m.t)[:, np.newaxis] - HIT

    assert exceeding(motions, jump) == {}


@pytest.mark.parametrize(('values', 'limit'), LIMITED)
def test_limits_hold_over_the_continuous_motion(motions, values, limit):
    assert exceeding(motions, lambda m: m.largest(values) - getattr(m.task.limits, limit) * (
        1.0 + LIMIT_MARGIN)) == {}


def test_joints_stay_in_their_ranges_between_the_via_points(motions):
    assert exceeding(motions, lambda m: m.outside_ranges() - HIT) == {}


def test_peaks_are_those_of_the_dense_grid(planner_id, motions):
    extremes = PATH_EXTREMES if planner_id in CARTESIAN else 1e-9
    for m in motions.values():
        peaks = m.plan.peaks
        assert (m.q <= peaks.max_position + extremes).all()
        assert (m.q >= peaks.min_position - extremes).all()
        for exact, dense in ((peaks.velocity, m.largest('qd')),
                             (peaks.acceleration, m.largest('qdd')),
                             (peaks.jerk, m.largest('qddd'))):
            assert (dense <= exact + 1e-9 * (1.0 + exact)).all()
        assert (m.largest('torque') <= m.plan.effort * (1.0 + TORQUE_MISS) + 1e-9).all()
        # From a time of the grid to the next, a value rises by half a step's change at most.
        half = 0.5 * np.diff(m.t).max()
        assert (peaks.velocity <= m.largest('qd') + half * peaks.acceleration + HIT).all()
        assert (peaks.acceleration <= m.largest('qdd') + half * peaks.jerk + HIT).all()


def test_peaks_are_close_to_the_grid_where_it_is_fine_enough(motions):
    for m in motions.values():
        peaks, spread = m.plan.peaks, np.ptp(m.q, axis=0)
        if np.diff(m.t).max() > shortest_piece(m.trajectory) / FINE:
            continue
        assert m.largest('qd') == pytest.approx(peaks.velocity, rel=1e-3, abs=1e-9)
        assert m.largest('qdd') == pytest.approx(peaks.acceleration, rel=1e-3, abs=1e-9)
        assert m.largest('qddd') == pytest.approx(peaks.jerk, rel=1.0 / FINE, abs=1e-9)
        assert m.largest('torque') == pytest.approx(m.plan.effort, rel=1e-3, abs=1e-6)
        for exact, dense in ((peaks.max_position, m.q.max(axis=0)),
                             (peaks.min_position, m.q.min(axis=0))):
            assert dense == pytest.approx(exact, abs=1e-3 * spread.max())


def test_quintic_through_the_points_is_within_velocity_acceleration_and_torque_limits(motions):
    def excess(m):
        times, limits = m.plan.points.times, m.task.limits
        within = np.diff(times)[:, np.newaxis] * np.linspace(0.0, 1.0, 21)
        q, qd, qdd, _ = spline_through(m.plan.points).at((times[:-1, np.newaxis] + within).ravel())
        torque = inverse_dynamics(m.task.model, q, qd, qdd)
        return max((np.abs(value).max(axis=0) - (1.0 + BETWEEN_POINTS) * limit).max()
                   for value, limit in ((qd, limits.max_velocity), (qdd, limits.max_acceleration),
                                        (torque, limits.max_effort)))

    assert exceeding(motions, excess) == {}


def test_jerk_through_the_points_is_reported_just_where_it_exceeds_its_limit_by_a_tenth(motions):
    for m in motions.values():
        ratio = (quintic_jerk(m.plan.points) / m.task.limits.max_jerk).max()
        assert ('reach a jerk of' in m.plan.note) == (ratio > REPORTED_JERK)


def quintic_jerk(points):
    """Return each joint's largest jerk, of 21 a piece (fifth-order polynomials)."""
    h = np.diff(points.times)[:, np.newaxis]
    q, (v0, v1), (a0, a1) = np.diff(points.positions, axis=0), *(
        (x[:-1], x[1:]) for x in (points.velocities, points.accelerations))
    c3 = (20.0 * q - (8.0 * v1 + 12.0 * v0) * h - (3.0 * a0 - a1) * h ** 2) / (2.0 * h ** 3)
    c4 = (-30.0 * q + (14.0 * v1 + 16.0 * v0) * h + (3.0 * a0 - 2.0 * a1) * h ** 2) / (
        2.0 * h ** 4)
    c5 = (12.0 * q - 6.0 * (v1 + v0) * h + (a1 - a0) * h ** 2) / (2.0 * h ** 5)
    t = h * np.linspace(0.0, 1.0, 21)[:, np.newaxis, np.newaxis]
    return np.abs(6.0 * c3 + 24.0 * c4 * t + 60.0 * c5 * t ** 2).max(axis=(0, 1))


def test_points_stand_at_every_via_time_and_no_two_are_too_close(motions):
    for m in motions.values():
        times, period = m.plan.points.times, m.task.request.sample_period
        counts = times / NANOSECOND
        assert np.abs(counts - np.round(counts)).max() <= 1e-4
        assert (np.diff(np.round(counts)) >= 1).all()
        assert times[0] == 0.0
        assert np.diff(times).max() <= 1.2 * period
        distance = np.abs(times[:, np.newaxis] - m.plan.via_times)
        assert distance.min(axis=0).max() <= NANOSECOND
        regular = distance.min(axis=1) > 2.0 * NANOSECOND
        inner = (m.plan.via_times < m.trajectory.duration) & (m.plan.via_times > 0.0)
        near = distance[regular][:, inner].min(initial=np.inf)
        assert near >= 0.1 * period - 2.0 * NANOSECOND


def test_via_times_rise_from_start_to_end(motions):
    for m in motions.values():
        q = m.task.q[len(m.task.q) - len(m.plan.via_times):]
        T, moves = np.diff(m.plan.via_times), np.abs(np.diff(q, axis=0)).max(axis=1)
        assert (T[moves > 1e-6] > 0.0).all()
        assert (T[moves == 0.0] == 0.0).all()
        if m.task.request.start is None:
            assert m.plan.via_times[0] == 0.0
        if moves.any():
            assert m.plan.via_times[-1] == pytest.approx(m.t[-1], rel=1e-12)


def test_same_request_gives_the_same_plan_bit_for_bit(planner_id, motions):
    for seed in list(motions)[::7]:
        first, task = motions[seed].plan, task_for(planner_id, seed)
        again = plan(task.model, task.limits, task.request)
        for name in ('times', 'positions', 'velocities', 'accelerations'):
            assert getattr(first.points, name).tobytes() == getattr(again.points, name).tobytes()
        assert first.via_times.tobytes() == again.via_times.tobytes()
        assert first.effort.tobytes() == again.effort.tobytes()
        assert first.note == again.note
