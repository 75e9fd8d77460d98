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
What every plan of the thesis's other functions and approaches keeps, on random feasible tasks.

As in `test_planned_motions`, each motion is evaluated on a grid of 20 points a sample that meets
every knot.
"""

from functools import cache

import numpy as np
import pytest
from random_tasks import Measured, random_task
from rrr_traj_planner.core.errors import LimitViolationError
from rrr_traj_planner.core.interpolation import Interpolant
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.registry import planner

EXACT = ['gauss', 'septic', 'cycloid_approach_c', 'poly_434']
MISSING = ['cycloid_approach_b', 'poly_414']
SEEDS = range(40)
FEW = {'gauss': range(32), 'septic': range(32)}  # a task beyond takes them long

HIT = 1e-9            # rad at the via points; rad, rad/s, rad/s^2 across a knot
LIMIT_ROOM = 1e-6     # relative
BETWEEN_POINTS = 1e-3  # relative, of the quintic through the sampled points
TORQUE_MISS = 1e-6    # relative, of a peak of torque between the points of its search


@cache
def outcomes(planner_id):
    """Return the measured plans, and the refusals."""
    planned, refused = {}, {}
    for seed in FEW.get(planner_id, SEEDS):
        task = random_task(seed)
        try:
            planned[seed] = Measured(
                task, plan(task.model, task.limits, task.asked_of(planner_id)))
        except LimitViolationError as error:
            refused[seed] = error
    return planned, refused


@pytest.fixture(scope='module', params=EXACT + MISSING)
def planner_id(request):
    return request.param


@pytest.fixture(scope='module')
def motions(planner_id):
    return outcomes(planner_id)[0]


def broken(motions, excess):
    """Return the seeds of motions for which a measure is above 0, with it."""
    found = {seed: float(np.max(excess(m))) for seed, m in motions.items()}
    return {seed: value for seed, value in found.items() if not value <= 0.0}


def off(m):
    """Return how far each via point is missed at its time [rad]."""
    wanted = m.task.q[len(m.task.q) - len(m.plan.via_times):]
    return np.abs(m.plan.trajectory(m.plan.via_times)[0] - wanted).max(axis=1)


def test_few_tasks_are_refused_and_all_for_gravity_on_the_way(planner_id):
    planned, refused = outcomes(planner_id)
    assert len(planned) >= 9 * len(refused)
    for error in refused.values():
        assert 'on its way' in str(error)
        assert error.value > error.limit


@pytest.mark.parametrize('planner_id', EXACT)
def test_via_points_are_hit_and_nothing_is_said(planner_id):
    assert not planner(planner_id).misses_via_points
    assert broken(outcomes(planner_id)[0], lambda m: off(m) - HIT) == {}
    assert {m.plan.note for m in outcomes(planner_id)[0].values()} == {''}


@pytest.mark.parametrize('planner_id', MISSING)
def test_start_and_end_are_hit_where_via_points_between_are_missed(planner_id):
    assert planner(planner_id).misses_via_points
    for m in outcomes(planner_id)[0].values():
        q = m.plan.trajectory(np.array([0.0, m.t[-1]]))[0]
        assert q == pytest.approx(m.task.q[[0, -1]], abs=HIT)


def test_motion_is_at_rest_at_both_ends(motions):
    for m in motions.values():
        _, qd, qdd, _ = m.plan.trajectory(np.array([0.0, m.plan.trajectory.duration]))
        assert np.abs(qd).max() <= HIT
        assert np.abs(qdd).max() <= HIT


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


@pytest.mark.parametrize(('values', 'limit'), [
    ('qd', 'max_velocity'), ('qdd', 'max_acceleration'), ('qddd', 'max_jerk'),
    ('torque', 'max_effort')])
def test_limits_are_kept_over_the_continuous_motion(motions, values, limit):
    assert broken(motions, lambda m: m.largest(values) - getattr(
        m.task.limits, limit) * (1.0 + LIMIT_ROOM)) == {}


def test_position_ranges_are_kept_between_the_via_points(motions):
    assert broken(motions, lambda m: np.maximum(
        m.task.limits.min_position - m.q, m.q - m.task.limits.max_position) - HIT) == {}


def test_peaks_bound_the_dense_grid(motions):
    for m in motions.values():
        peaks = m.plan.peaks
        for exact, dense in ((peaks.velocity, m.largest('qd')),
                             (peaks.acceleration, m.largest('qdd')),
                             (peaks.jerk, m.largest('qddd')),
                             (peaks.max_position, m.q.max(axis=0)),
                             (-peaks.min_position, -m.q.min(axis=0))):
            assert (dense <= exact + 1e-9 * (1.0 + np.abs(exact))).all()
        assert (m.largest('torque') <= m.plan.effort * (1.0 + TORQUE_MISS) + 1e-9).all()


def test_quintic_through_the_points_keeps_velocity_and_acceleration_limits(motions):
    def excess(m):
        times = m.plan.points.times
        within = np.diff(times)[:, np.newaxis] * np.linspace(0.0, 1.0, 21)
        _, qd, qdd = Interpolant(m.plan.points)((times[:-1, np.newaxis] + within).ravel())
        room = 1.0 + BETWEEN_POINTS
        return max((np.abs(qd).max(axis=0) - room * m.task.limits.max_velocity).max(),
                   (np.abs(qdd).max(axis=0) - room * m.task.limits.max_acceleration).max())

    assert broken(motions, excess) == {}


def test_via_times_rise_from_start_to_end(motions):
    for m in motions.values():
        wanted = m.task.q[len(m.task.q) - len(m.plan.via_times):]
        T, moves = np.diff(m.plan.via_times), np.abs(np.diff(wanted, axis=0)).max(axis=1)
        assert (T[moves > 1e-6] > 0.0).all()
        assert (T[moves == 0.0] == 0.0).all()
        if m.task.request.start is None:
            assert m.plan.via_times[0] == 0.0
        if moves.any():
            assert m.plan.via_times[-1] == pytest.approx(m.t[-1], rel=1e-12)


def test_same_request_gives_the_same_answer_bit_for_bit(planner_id):
    planned, _ = outcomes(planner_id)
    for seed in list(planned)[::12]:
        first, task = planned[seed].plan, random_task(seed)
        again = plan(task.model, task.limits, task.asked_of(planner_id))
        for name in ('times', 'positions', 'velocities', 'accelerations'):
            assert getattr(first.points, name).tobytes() == getattr(again.points, name).tobytes()
        assert first.via_times.tobytes() == again.via_times.tobytes()
        assert first.note == again.note
