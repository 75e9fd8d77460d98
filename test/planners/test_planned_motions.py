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
What every plan keeps, on random feasible tasks for each joint-space planner but `time_optimal`.

Each task is planned once; every claim is then tested on all plans, by evaluating the motion on a
grid of 20 points a sample that meets every knot.
"""

from helpers.measured_plans import broken, EXACT, MISSING, outcomes, via_points
from helpers.random_tasks import random_task
import numpy as np
import pytest
from rrr_traj_planner.core.dynamics.rigid_body import inverse_dynamics
from rrr_traj_planner.core.trajectory.quintic_spline import spline_through
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.registry import planner

MOST_REFUSALS = 0.11
HIT = 1e-9            # rad at the via points; rad, rad/s, rad/s^2 across a knot
MOST_NOTES = {'poly_434': 5}  # of 38 motions, of what the points make a controller do; others none
TOLD_JERK = 1.1       # times its limit, of the quintic through the points
LIMIT_ROOM = 1e-6     # relative
BETWEEN_POINTS = 1e-3  # relative, of the quintic through the sampled points
NANOSECOND = 1e-9
TORQUE_MISS = 1e-6    # relative, of a peak of torque between the points of its search


@pytest.fixture(scope='module', params=EXACT + MISSING)
def planner_id(request):
    return request.param


@pytest.fixture(scope='module')
def motions(planner_id):
    return outcomes(planner_id)[0]


def test_few_tasks_are_refused_and_all_for_gravity_on_the_way(planner_id):
    planned, refused = outcomes(planner_id)
    assert len(refused) <= MOST_REFUSALS * len(planned)
    for _, error in refused.values():
        assert 'along the segment' in str(error)
        assert error.value > error.limit


@pytest.mark.parametrize('planner_id', EXACT)
def test_via_points_are_hit_and_hardly_anything_is_said_of_points(planner_id):
    assert not planner(planner_id).misses_via_points
    motions = outcomes(planner_id)[0]
    assert broken(motions, lambda m: np.abs(
        m.plan.trajectory(m.plan.via_times)[0] - via_points(m)) - HIT) == {}
    assert {m.plan.trajectory.note for m in motions.values()} == {''}
    said = {m.plan.note for m in motions.values() if m.plan.note}
    assert all('reach a jerk of' in note or '0.1 % slower' in note for note in said)
    assert len(said) <= MOST_NOTES.get(planner_id, 0)


@pytest.mark.parametrize('planner_id', MISSING)
def test_planner_that_misses_via_points_is_known_to(planner_id):
    assert planner(planner_id).misses_via_points


def test_motion_starts_where_it_should_at_rest_and_ends_at_rest(motions):
    for m in motions.values():
        q, qd, qdd, _ = m.plan.trajectory(np.array([0.0, m.plan.trajectory.duration]))
        assert q == pytest.approx(m.task.q[[0, -1]], abs=HIT)
        assert np.abs(qd).max() <= HIT
        assert np.abs(qdd).max() <= HIT
        assert m.plan.points.velocities[[0, -1]].tolist() == [[0.0] * 3] * 2
        assert m.plan.points.accelerations[[0, -1]].tolist() == [[0.0] * 3] * 2


def test_position_velocity_and_acceleration_are_continuous(motions):
    def jump(m):
        jumps = []
        for profile in m.plan.trajectory.profiles:
            ends, starts = profile.pieces.at(1.0), profile.pieces.at(0.0)
            jumps += [np.abs(e[:-1] - s[1:]).max(initial=0.0)
                      for e, s in zip(ends[:3], starts[:3])]
            jumps += [abs(starts[1][0]), abs(starts[2][0]), abs(ends[1][-1]), abs(ends[2][-1])]
        return max(jumps) - HIT

    assert broken(motions, jump) == {}


def test_neighbours_on_the_grid_differ_by_no_more_than_the_next_peak_allows(motions):
    def jump(m):
        dt, peaks = np.diff(m.t)[:, np.newaxis], m.plan.peaks
        return max((np.abs(np.diff(value, axis=0)) - rate * dt).max() for value, rate in (
            (m.q, peaks.velocity), (m.qd, peaks.acceleration), (m.qdd, peaks.jerk))) - HIT

    assert broken(motions, jump) == {}


@pytest.mark.parametrize(('values', 'limit'), [
    ('qd', 'max_velocity'), ('qdd', 'max_acceleration'), ('qddd', 'max_jerk'),
    ('torque', 'max_effort')])
def test_limits_are_kept_over_the_continuous_motion(motions, values, limit):
    assert broken(motions, lambda m: m.largest(values) - getattr(
        m.task.limits, limit) * (1.0 + LIMIT_ROOM)) == {}


def test_position_ranges_are_kept_between_the_via_points(motions):
    assert broken(motions, lambda m: np.maximum(
        m.task.limits.min_position - m.q, m.q - m.task.limits.max_position) - HIT) == {}


def test_peaks_are_those_of_the_dense_grid(motions):
    for m in motions.values():
        peaks = m.plan.peaks
        spread = np.ptp(m.q, axis=0)
        for exact, dense in ((peaks.velocity, m.largest('qd')),
                             (peaks.acceleration, m.largest('qdd')),
                             (peaks.jerk, m.largest('qddd')),
                             (peaks.max_position, m.q.max(axis=0)),
                             (-peaks.min_position, -m.q.min(axis=0))):
            assert (dense <= exact + 1e-9 * (1.0 + np.abs(exact))).all()
        assert (m.largest('torque') <= m.plan.effort * (1.0 + TORQUE_MISS) + 1e-9).all()
        # The grid misses the top of a bump by a part that its steps across it decide.
        shortest = min(p.pieces.duration.min() for p in m.plan.trajectory.profiles)
        if m.task.request.sample_period / 20.0 <= shortest / 200.0:
            assert m.largest('qd') == pytest.approx(peaks.velocity, rel=1e-3, abs=1e-9)
            assert m.largest('qdd') == pytest.approx(peaks.acceleration, rel=1e-3, abs=1e-9)
            # where jerk is largest at the end of a piece, the grid has the next one's there
            assert m.largest('qddd') == pytest.approx(peaks.jerk, rel=1.0 / 200.0, abs=1e-9)
            assert m.largest('torque') == pytest.approx(m.plan.effort, rel=1e-3, abs=1e-6)
            assert m.q.max(axis=0) == pytest.approx(peaks.max_position, abs=1e-3 * spread.max())


def test_quintic_through_the_points_keeps_velocity_acceleration_and_torque_limits(motions):
    def excess(m):
        times = m.plan.points.times
        within = np.diff(times)[:, np.newaxis] * np.linspace(0.0, 1.0, 21)
        t = (times[:-1, np.newaxis] + within).ravel()
        q, qd, qdd, _ = spline_through(m.plan.points).at(t)
        torque = inverse_dynamics(m.task.model, q, qd, qdd)
        room = 1.0 + BETWEEN_POINTS
        return max((np.abs(qd).max(axis=0) - room * m.task.limits.max_velocity).max(),
                   (np.abs(qdd).max(axis=0) - room * m.task.limits.max_acceleration).max(),
                   (np.abs(torque).max(axis=0) - room * m.task.limits.max_effort).max())

    assert broken(motions, excess) == {}


def test_jerk_through_the_points_is_told_just_where_it_exceeds_its_limit_by_a_tenth(motions):
    for m in motions.values():
        ratio = (quintic_jerk(m.plan.points) / m.task.limits.max_jerk).max()
        assert ('reach a jerk of' in m.plan.note) == (ratio > TOLD_JERK)


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
        inner = m.plan.via_times < m.plan.trajectory.duration
        inner &= m.plan.via_times > 0.0
        near = distance[regular][:, inner].min(initial=np.inf)
        assert near >= 0.1 * period - 2.0 * NANOSECOND


def test_via_times_rise_from_start_to_end(motions):
    for m in motions.values():
        T, moves = np.diff(m.plan.via_times), np.abs(np.diff(via_points(m), axis=0)).max(axis=1)
        assert (T[moves > 1e-6] > 0.0).all()
        assert (T[moves == 0.0] == 0.0).all()
        if m.task.request.start is None:
            assert m.plan.via_times[0] == 0.0
        if moves.any():
            assert m.plan.via_times[-1] == pytest.approx(m.t[-1], rel=1e-12)


def test_joints_are_in_step(motions):
    for m in motions.values():
        ends = [p.duration for p in m.plan.trajectory.profiles]
        assert np.ptp(ends) <= 1e-9


def test_same_request_gives_the_same_answer_bit_for_bit(planner_id):
    planned, _ = outcomes(planner_id)
    for seed in list(planned)[::12]:
        first, task = planned[seed].plan, random_task(seed)
        again = plan(task.model, task.limits, task.asked_of(planner_id))
        for name in ('times', 'positions', 'velocities', 'accelerations'):
            assert getattr(first.points, name).tobytes() == getattr(again.points, name).tobytes()
        assert first.via_times.tobytes() == again.via_times.tobytes()
        assert first.note == again.note
