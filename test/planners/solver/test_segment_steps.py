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

"""Steps that each segment of a long motion shortens for itself."""

from dataclasses import replace

from helpers.solving import never, solve
from helpers.spline_cases import all_free, FREE, LIMITS, NONE, random_motion, slow_start
import numpy as np
import pytest
from rrr_traj_planner.planners.solver import segment_steps
from rrr_traj_planner.planners.solver.interior_point import CentralPathPoint, minimise
from rrr_traj_planner.planners.solver.library import KERNELS
from rrr_traj_planner.planners.solver.segment_steps import SegmentSteps, take_own_steps

LONG = 50  # segments
SEEDS = range(3)
CORRIDOR, SMALL = 1e6, 0.5
CENTRE = 0.1   # a barrier parameter at which slacks are large
BESIDE = 1.05 * CENTRE
BY_TORQUE = replace(LIMITS, max_acceleration=NONE, max_jerk=[100.0] * 3)
WHICH = pytest.mark.parametrize('limits', [FREE, BY_TORQUE], ids=['plain', 'torque'])


def long_motion(seed):
    mesh, points, _ = random_motion(seed, n=10, segments=LONG)
    return mesh, points


def centred(seed, barrier):
    """Return a problem and its motion near the central path."""
    constraints, m = slow_start(FREE, *long_motion(seed))
    return constraints.problem, minimise(
        constraints.problem, CentralPathPoint(m, barrier), all_free(LONG), never,
        least_barrier=barrier).centres[-1].motion


def at_start(seed, barrier, limits=FREE):
    """Return a problem at its slow start, and the steps from there."""
    constraints, m = slow_start(limits, *long_motion(seed))
    return begun(constraints.problem, m, barrier)


def begun(problem, m, barrier):
    """Return a problem at a motion, its multipliers those of the central path, and the steps."""
    problem.begin(m, all_free(LONG))
    addresses = problem.arrays.addresses
    KERNELS.timing_slacks(problem.address, addresses['variables'], addresses['slack'])
    KERNELS.timing_central_duals(problem.address, barrier)
    return problem, SegmentSteps(problem, CORRIDOR, SMALL)


def merit(problem, barrier):
    slacks = problem.slacks(problem.motion(problem.arrays['variables'].copy()))
    cost = KERNELS.timing_cost(problem.address, problem.arrays.addresses['variables'])
    return cost - barrier * np.log(slacks[:-2 * LONG]).sum()


@WHICH
@pytest.mark.parametrize('seed', SEEDS)
def test_the_motion_is_as_fast_as_with_steps_of_the_whole(seed, limits, monkeypatch):
    own = solve(limits, *long_motion(seed))[3]
    for name in ('FEWEST', 'FEWEST_BY_TORQUE'):
        monkeypatch.setattr(segment_steps, name, 10 ** 6)
    whole = solve(limits, *long_motion(seed))[3]
    assert own.converged
    assert own.motion.T.sum() <= 1.002 * whole.motion.T.sum()
    assert whole.motion.T.sum() >= own.motion.T.sum() - own.gap


@WHICH
@pytest.mark.parametrize('seed', SEEDS)
def test_every_iterate_is_strictly_feasible_and_through_the_via_points(seed, limits):
    mesh, points = long_motion(seed)
    problem, _, seen, _ = solve(limits, mesh, points)
    assert take_own_steps(problem, all_free(LONG))
    assert len(seen) > 5
    for m in seen:
        assert problem.is_within(m)
        at = mesh.states(points, m)
        assert at.q[:, mesh.n] == pytest.approx(points[1:], abs=1e-10)
        assert at.qd[:, mesh.n] == pytest.approx(m.v[1:], abs=1e-9)
        assert at.qdd[:, mesh.n] == pytest.approx(m.a[1:], abs=1e-8)


@WHICH
@pytest.mark.parametrize('seed', SEEDS)
def test_the_merit_decreases_with_every_step(seed, limits):
    barrier = 1e-3
    problem, steps = at_start(seed, barrier, limits)
    before = merit(problem, barrier)
    for _ in range(8):
        steps.log_sum()
        assert steps.take(barrier)
        after = merit(problem, barrier)
        assert after < before
        assert steps.structure.cost - barrier * steps.structure.total_log == pytest.approx(after)
        before = after


@WHICH
@pytest.mark.parametrize('seed', SEEDS)
def test_the_step_before_damping_is_newtons(seed, limits):
    problem, steps = at_start(seed, 1e-3, limits)
    KERNELS.timing_linearise(problem.address, 1e-3)
    newton = problem.steps[2]
    assert KERNELS.timing_newton(problem.address, 0, newton.address)
    assert steps.newton(1e-3) == pytest.approx(newton.structure.predicted_decrease, rel=1e-9)
    whole, by_segments = (problem.arrays[f'direction {k}'] for k in (2, 3))
    assert by_segments == pytest.approx(whole, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize('seed', SEEDS)
def test_multipliers_take_newton_steps_of_their_own(seed):
    problem, steps = begun(*centred(seed, CENTRE), BESIDE)
    KERNELS.timing_linearise(problem.address, BESIDE)
    newton = problem.steps[2]
    assert KERNELS.timing_newton(problem.address, 0, newton.address)
    slack, dual, rate = (problem.arrays[name][:-2 * LONG].reshape(LONG, -1)
                         for name in ('slack', 'dual', 'rate 2'))
    change = (BESIDE - dual * rate) / slack - dual  # of the linearised product with the slack
    fall = (-change / dual).max(axis=1, keepdims=True)
    expected = dual + np.minimum(segment_steps.TO_BOUNDARY / fall, 1.0) * change
    steps.log_sum()
    assert steps.take(BESIDE)
    assert problem.arrays['trial_slack'][:-2 * LONG] == pytest.approx(
        expected.ravel(), rel=1e-6)


def test_segments_that_rest_do_not_move():
    problem, steps = at_start(0, 1e-3)
    before = problem.motion(problem.arrays['variables'].copy())
    steps.log_sum()
    steps.active[:] = 0
    steps.active[10:14] = 1
    assert steps.take(1e-3)
    after = problem.motion(problem.arrays['variables'].copy())
    moves = np.arange(LONG)[(after.inner != before.inner).any(axis=(1, 2))]
    assert moves.tolist() == np.flatnonzero(after.T != before.T).tolist() == [10, 11, 12, 13]
    assert np.flatnonzero((after.v != before.v).any(axis=1)).tolist() == [11, 12, 13]
    assert problem.is_within(after)


def test_what_needs_a_short_step_does_not_shorten_the_others():
    problem, steps = begun(*centred(0, CENTRE), BESIDE)
    per_segment = problem.arrays['dual'][:-2 * LONG].reshape(LONG, -1)
    per_segment[20] *= 1e-3  # its slacks hardly resist the step
    KERNELS.timing_linearise(problem.address, BESIDE)
    newton = problem.steps[2]
    assert KERNELS.timing_newton(problem.address, 0, newton.address)
    assert newton.structure.max_relative_slack_decrease > 10.0
    steps.log_sum()
    before = problem.motion(problem.arrays['variables'].copy())
    assert steps.take(BESIDE)
    after = problem.motion(problem.arrays['variables'].copy())
    part = (after.T - before.T) / problem.motion(problem.arrays['direction 2']).T
    far = np.abs(np.arange(LONG) - 20) > 8
    assert abs(part[20]) < 0.1
    assert np.median(part[far]) == pytest.approx(1.0)


def test_short_motions_and_fixed_durations_take_whole_steps():
    mesh, points = long_motion(0)
    problem = slow_start(FREE, mesh, points)[0].problem
    assert take_own_steps(problem, all_free(LONG))
    fixed = all_free(LONG)._replace(free=np.arange(LONG) > 0)
    assert not take_own_steps(problem, fixed)
    mesh, points, _ = random_motion(0, n=10, segments=5)
    assert not take_own_steps(slow_start(FREE, mesh, points)[0].problem, all_free(5))


def test_by_torque_alone_whole_steps_are_taken():
    for limits, own in ((BY_TORQUE, True), (replace(BY_TORQUE, max_jerk=NONE), False)):
        problem = slow_start(limits, *long_motion(0))[0].problem
        assert take_own_steps(problem, all_free(LONG)) == own


@pytest.mark.parametrize('seed', SEEDS)
def test_what_limits_are_relaxed_by_shrinks_by_each_segments_part_of_the_step(seed):
    barrier = 1e-3
    problem, steps = at_start(seed, barrier)
    problem.shift(problem.limits.widened(10.0))
    addresses = problem.arrays.addresses
    KERNELS.timing_slacks(problem.address, addresses['variables'], addresses['slack'])
    KERNELS.timing_central_duals(problem.address, barrier)
    shifts = problem.arrays['shift'][:-2 * LONG].reshape(LONG, -1)
    before = shifts.copy()
    damping = steps._floats[0]
    assert steps.take(barrier)
    left = shifts > 0.0  # the others are removed
    assert left.any()
    expected = (1.0 - 1.0 / damping[:, np.newaxis]) * before
    assert shifts[left] == pytest.approx(expected[left], rel=1e-12)
