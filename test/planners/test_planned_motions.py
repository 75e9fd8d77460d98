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
What every plan keeps, on random feasible tasks for each joint-space planner.

Each task is planned once; every claim is then tested on all plans, by evaluating the motion on a
grid of 20 points a sample that meets every knot.
"""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from random_tasks import KINDS, Measured, random_task
from rrr_traj_planner.core.dynamics import gravity_torque, inverse_dynamics
from rrr_traj_planner.core.errors import LimitViolationError
from rrr_traj_planner.core.interpolation import Interpolant
from rrr_traj_planner.planners.planning import plan

PLANNERS = ['cycloid', 'cycloid_approach_a']

# Approach (a) passes every via point at its cruise velocity: not where a joint has no room.
SEEDS = {'cycloid': range(212),
         'cycloid_approach_a': [s for s in range(252) if KINDS[s % len(KINDS)] != 'at a limit']}

MOST_REFUSALS = 0.1
HIT = 1e-9            # rad at the via points; rad, rad/s, rad/s^2 across a knot
LIMIT_ROOM = 1e-6     # relative
BETWEEN_POINTS = 1e-3  # relative, of the quintic through the sampled points
NANOSECOND = 1e-9
TORQUE_MISS = 1e-6    # relative, of a peak of torque between the points of its search


@cache
def outcomes(planner_id):
    """Return the measured plans, and the refusals with their tasks."""
    planned, refused = {}, {}
    for seed in SEEDS[planner_id]:
        task = random_task(seed)
        try:
            planned[seed] = Measured(
                task, plan(task.model, task.limits, task.asked_of(planner_id)))
        except LimitViolationError as error:
            refused[seed] = (task, error)
    return planned, refused


@pytest.fixture(scope='module', params=PLANNERS)
def planner_id(request):
    return request.param


@pytest.fixture(scope='module')
def motions(planner_id):
    return outcomes(planner_id)[0]


def test_of_200_tasks_a_few_are_refused_and_all_for_gravity_on_the_way(planner_id):
    planned, refused = outcomes(planner_id)
    assert len(planned) + len(refused) >= 200
    assert len(refused) <= MOST_REFUSALS * len(planned)
    for _, error in refused.values():
        assert 'on its way' in str(error)
        assert error.value > error.limit


def test_refused_segments_of_cycloid_hold_a_pose_that_gravity_makes_too_heavy():
    # Between stops every joint moves from point to point without turning back: inside the box
    # that two points span some pose must need the torque that the refusal names.
    for task, error in outcomes('cycloid')[1].values():
        joint = task.model.joint_names.index(error.joint)
        k = int(str(error).split(':')[0].split()[1])
        grid = np.stack(np.meshgrid(*np.linspace(task.q[k], task.q[k + 1], 25).T), -1)
        torque = np.abs(gravity_torque(task.model, grid.reshape(-1, 3)))[:, joint]
        assert torque.max() > task.limits.max_effort[joint]
        assert torque.max() >= error.value * (1.0 - 1e-2)


def broken(motions, excess):
    """Return the seeds of motions for which a measure is above 0, with it."""
    found = {seed: float(np.max(excess(m))) for seed, m in motions.items()}
    return {seed: value for seed, value in found.items() if not value <= 0.0}


def via_points(m):
    return m.task.q[len(m.task.q) - len(m.plan.via_times):]


def test_via_points_are_hit(motions):
    assert broken(motions, lambda m: np.abs(
        m.plan.trajectory(m.plan.via_times)[0] - via_points(m)) - HIT) == {}


def test_motion_starts_where_it_should_at_rest_and_ends_at_rest(motions):
    for m in motions.values():
        q, qd, qdd, _ = m.plan.trajectory(np.array([0.0, m.plan.trajectory.duration]))
        assert q == pytest.approx(m.task.q[[0, -1]], abs=HIT)
        assert np.abs(qd).max() <= HIT
        assert np.abs(qdd).max() <= HIT
        assert m.plan.points.velocities[[0, -1]].tolist() == [[0.0] * 3] * 2
        assert m.plan.points.accelerations[[0, -1]].tolist() == [[0.0] * 3] * 2


def test_position_velocity_and_acceleration_are_continuous_across_knots(motions):
    def jump(m):
        # The ends of neighbouring pieces of each joint, extrapolated by none.
        jumps = []
        for profile in m.plan.trajectory.profiles:
            pieces = profile.pieces
            ends, starts = pieces.at(1.0), pieces.at(0.0)
            jumps += [np.abs(e[:-1] - s[1:]).max(initial=0.0)
                      for e, s in zip(ends[:3], starts[:3])]
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
            assert m.largest('qddd') == pytest.approx(peaks.jerk, rel=1e-3, abs=1e-9)
            assert m.largest('torque') == pytest.approx(m.plan.effort, rel=1e-3, abs=1e-6)
            assert m.q.max(axis=0) == pytest.approx(peaks.max_position, abs=1e-3 * spread.max())


def test_quintic_through_the_points_keeps_velocity_and_acceleration_limits(motions):
    def excess(m):
        times = m.plan.points.times
        within = np.diff(times)[:, np.newaxis] * np.linspace(0.0, 1.0, 21)
        t = (times[:-1, np.newaxis] + within).ravel()
        _, qd, qdd = Interpolant(m.plan.points)(t)
        room = 1.0 + BETWEEN_POINTS
        return max((np.abs(qd).max(axis=0) - room * m.task.limits.max_velocity).max(),
                   (np.abs(qdd).max(axis=0) - room * m.task.limits.max_acceleration).max())

    assert broken(motions, excess) == {}


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


def test_via_times_rise_and_repeated_points_share_theirs(motions):
    for m in motions.values():
        T, moves = np.diff(m.plan.via_times), np.abs(np.diff(via_points(m), axis=0)).max(axis=1)
        assert (T[moves > 1e-6] > 0.0).all()
        assert (T[moves == 0.0] == 0.0).all()
        if moves.any():
            assert m.plan.via_times[-1] == pytest.approx(m.plan.trajectory.duration, rel=1e-12)


def test_joints_are_in_step(motions):
    for m in motions.values():
        ends = [p.duration for p in m.plan.trajectory.profiles]
        assert np.ptp(ends) <= 1e-9


def test_every_piece_is_a_full_period_cycloid_or_a_cruise(motions):
    for m in motions.values():
        for profile in m.plan.trajectory.profiles:
            assert (profile.pieces.w == 2.0 * np.pi).all()
            assert (profile.pieces.c == profile.pieces.b).all()


def pieces_in_segments(m):
    """Return for each joint and segment whether its pieces, in order, are transitions."""
    ends = m.plan.trajectory.via_times
    for profile in m.plan.trajectory.profiles:
        middle = 0.5 * (profile.knots[:-1] + profile.knots[1:])
        segment = np.searchsorted(ends[1:-1], middle)
        moving = np.abs(profile.pieces.b * profile.pieces.duration) > 1e-9
        yield [moving[segment == k].tolist() for k in range(len(ends) - 1)]


def test_cycloid_has_at_most_transition_cruise_transition_in_a_segment():
    for m in outcomes('cycloid')[0].values():
        for joint in pieces_in_segments(m):
            for pieces in joint:
                assert 1 <= len(pieces) <= 3
                assert len(pieces) < 3 or not pieces[1]


def test_approach_a_has_one_transition_then_a_cruise_and_in_the_last_segment_one_more():
    for m in outcomes('cycloid_approach_a')[0].values():
        for joint in pieces_in_segments(m):
            for pieces in joint[:-1]:
                assert sum(pieces) <= 1
                assert not any(pieces[1:])
            assert sum(joint[-1]) <= 2
            assert len(joint[-1]) <= 3


def test_slowed_motion_uses_some_limit_up():
    # A motion that is at no limit of its own, nor bound to its samples, could be faster.
    idle = {}
    for seed, m in outcomes('cycloid')[0].items():
        limits, peaks = m.task.limits, m.plan.peaks
        use = max((value / limit).max() for value, limit in (
            (peaks.velocity, limits.max_velocity), (peaks.acceleration, limits.max_acceleration),
            (peaks.jerk, limits.max_jerk), (m.plan.effort, limits.max_effort)))
        if use < 0.98 and m.task.request.sample_period <= 0.01 and m.t[-1] > 0.5:
            idle[seed] = float(use)
    assert idle == {}


def test_torque_slows_a_motion_no_more_than_running_the_same_path_slower_would():
    slower = {}
    for seed, m in list(outcomes('cycloid')[0].items())[::4]:
        task = m.task
        free = replace(task.limits, max_effort=np.full(3, np.inf))
        quick = plan(task.model, free, task.request).trajectory
        t = np.linspace(0.0, quick.duration, 4001)
        q, qd, qdd, _ = quick(t)
        gravity = gravity_torque(task.model, q)
        motion = np.abs(inverse_dynamics(task.model, q, qd, qdd) - gravity)
        with np.errstate(divide='ignore'):
            squared = motion / np.maximum(task.limits.max_effort - np.abs(gravity), 0.0)
        bound = quick.duration * max(1.0, np.sqrt(np.nanmax(squared)))
        if m.t[-1] > 1.01 * bound:
            slower[seed] = float(m.t[-1] / bound)
    assert slower == {}


def test_same_request_gives_the_same_answer_bit_for_bit(planner_id):
    planned, _ = outcomes(planner_id)
    for seed in list(planned)[::24]:
        first, task = planned[seed].plan, random_task(seed)
        again = plan(task.model, task.limits, task.asked_of(planner_id))
        for name in ('times', 'positions', 'velocities', 'accelerations'):
            assert getattr(first.points, name).tobytes() == getattr(again.points, name).tobytes()
        assert first.via_times.tobytes() == again.via_times.tobytes()
        assert first.effort.tobytes() == again.effort.tobytes()


@pytest.mark.xfail(strict=True, reason='torque slows the fastest motion more than another: 1.12')
def test_cycloid_is_hardly_ever_slower_than_approach_a_whose_structure_it_contains():
    a, free = outcomes('cycloid_approach_a')[0], outcomes('cycloid')[0]
    ratios = {seed: float(free[seed].t[-1] / a[seed].t[-1]) for seed in set(a) & set(free)}
    assert {seed: ratio for seed, ratio in ratios.items() if ratio > 1.1} == {}
