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

"""The kernels of the timing problem: against differences, and against a dense solve in NumPy."""

from dataclasses import replace

from helpers.random_cases import central_difference
from helpers.spline_cases import (
    bounds,
    flat,
    FREE,
    LIMITS,
    NONE,
    random_motion,
)
from helpers.timing_cases import BARRIER, Case
import numpy as np
import pytest
from rrr_traj_planner.planners.solver.library import KERNELS
from rrr_traj_planner.planners.solver.limits import DurationConstraints, fixed_ends
from rrr_traj_planner.planners.solver.splines import time_scaled

SEEDS = range(5)
SOLVED = 2e-6     # relative, to which a dense solve agrees with elimination


def agree(found, expected, rel=SOLVED):
    assert found == pytest.approx(expected, rel=rel, abs=rel * np.abs(expected).max())


@pytest.mark.parametrize('kind', ['bounds', 'torque', 'path'])
@pytest.mark.parametrize('seed', SEEDS)
def test_newton_step_is_that_of_a_dense_solve_of_all_conditions(kind, seed):
    case = Case(kind, seed)
    for exact in ((0,) if kind == 'bounds' else (0, 1)):
        direction, _, gain = case.newton(exact)
        expected, promised = case.dense(exact)
        if np.abs(case.by_unknowns(case.ends) @ expected).max() > 1e-6:
            continue  # least squares found no solution: the exact Hessian may have none
        agree(direction, expected, 1e-4 if kind.startswith('path') else SOLVED)
        assert gain == pytest.approx(promised, rel=1e-5)


@pytest.mark.parametrize(('free', 'tie'), [
    ((1, 0, 0, 1), (0.0, 1.5, 0.7, 0.0)), ((0, 0, 0, 0), (1.0, 2.0, 1.0, 0.5)),
    ((1, 0, 1, 1), (0.0, 0.0, 0.0, 0.0))])
@pytest.mark.parametrize('kind', ['bounds', 'torque'])
def test_durations_tied_fixed_or_with_floors_and_stops_are_those_of_a_dense_solve(
        kind, free, tie):
    still = fixed_ends(4, 3)
    still[2, 0, 1] = True
    case = Case(kind, 4, segments=4, least_T=True, durations=DurationConstraints(
        np.array(free, bool), np.array(tie), np.ones(4), still))
    direction, _, gain = case.newton(0)
    expected, promised = case.dense(0)
    agree(direction, expected, 1e-5)
    assert gain == pytest.approx(promised, rel=1e-5)
    assert gain > 0.0


@pytest.mark.parametrize('kind', ['bounds', 'torque', 'path', 'path with friction'])
@pytest.mark.parametrize('seed', SEEDS)
def test_rates_and_gain_are_differences_along_the_followed_step(kind, seed):
    case = Case(kind, seed, least_T=kind == 'bounds')
    _, rate, gain = case.newton(0)
    step, arrays = case.problem.steps[0], case.arrays
    near = arrays['slack'].copy()
    size = 1e-4 / max(step.structure.max_relative_slack_decrease, 1.0)

    def followed(part):
        arrays['slack'][:] = -np.inf  # whatever is left is kept
        assert KERNELS.timing_trial(case.address, step.address, part * size, 1.0, 0.0)
        arrays['slack'][:] = near
        merit = step.structure.cost - BARRIER * step.structure.log
        return np.append(arrays['slack 0'], merit)

    *difference, slope = central_difference(followed, 0.0, 1.0) / size
    scale = np.abs(rate).max()
    assert rate == pytest.approx(np.array(difference), rel=1e-3, abs=1e-6 * scale)
    assert gain == pytest.approx(-slope, rel=1e-4)


@pytest.mark.parametrize('seed', SEEDS)
@pytest.mark.parametrize('kind', ['torque', 'path', 'path with friction'])
def test_curvature_is_the_difference_of_the_weighted_gradients(kind, seed):
    case = Case(kind, seed)
    arrays, problem = case.arrays, case.problem
    N, P, E, Z = arrays['jacobian'].shape
    found = (arrays['exact'] - arrays['hessian']).copy()
    weights = np.zeros((N, P, E))
    bounded = int(problem.limits.bounded.sum())
    dual = arrays['dual'][:-2 * N].reshape(N, -1, 2)[:, bounded:]
    weights[:, problem.limits.general] = dual[..., 0] - dual[..., 1]
    x = case.x.copy()
    change = np.random.default_rng(seed).normal(size=x.size) * np.append(
        np.ones(x.size - N), 0.1 * case.motion.T)
    size = 1e-5

    def gradient(part):
        arrays['variables'][:] = x + part * size * change
        KERNELS.timing_linearise(case.address, BARRIER)
        return np.einsum('npe,npez->npz', weights, arrays['jacobian']), arrays['states'].copy()

    (plus, up), (minus, down) = gradient(1.0), gradient(-1.0)
    difference, dz = (plus - minus) / (2.0 * size), (up - down) / (2.0 * size)
    expected = np.einsum('npyz,npz->npy', found, dz)
    assert (found == np.swapaxes(found, -1, -2)).all()
    assert expected == pytest.approx(difference, rel=1e-3, abs=2e-3 * np.abs(difference).max())


@pytest.mark.parametrize('kind', ['bounds', 'torque', 'path'])
def test_a_correction_is_the_dense_solution_for_what_rates_leave_out(kind):
    case = Case(kind, 3)
    _, rate, _ = case.newton(0)
    plain, corrected = case.problem.steps[:2]
    size = 0.02 / max(plain.structure.max_relative_slack_decrease, 1.0)
    arrays = case.arrays
    near = arrays['slack'].copy()
    assert KERNELS.timing_correct(case.address, plain.address, size, corrected.address)
    left = {}
    for step, k in ((plain, 0), (corrected, 1)):
        arrays['slack'][:] = -np.inf
        assert KERNELS.timing_trial(case.address, step.address, size, 1.0, 0.0)
        arrays['slack'][:] = near
        left[k] = arrays[f'slack {k}'] - near - size * rate
    weight = arrays['dual'] / near

    def error(aside):
        return float(np.sqrt((weight * aside ** 2).sum()))

    assert error(left[1]) <= error(left[0]) * (1.0 + 1e-9)
    # its condition: no change that keeps the ends leaves less of the weighted squares
    rates = case.by_unknowns(lambda x: case.problem.slacks(case.problem.motion(x)))
    E = case.by_unknowns(case.ends)
    basis = case.allowed()
    null = basis @ np.linalg.svd(E @ basis)[2][len(E):].T
    moved = rates @ arrays['correction 1'] + left[0] / size ** 2
    slope = null.T @ rates.T @ (weight * moved)
    largest = error(moved) * np.sqrt(((rates @ null) ** 2 * weight[:, np.newaxis]).sum(axis=0))
    assert (np.abs(slope) <= 1e-4 * largest).all()


def test_accepting_a_step_moves_multipliers_and_keeps_them_positive_in_sight_of_the_centre():
    case = Case('torque', 2)
    _, rate, _ = case.newton(0)
    arrays, step = case.arrays, case.problem.steps[0]
    before, slack = arrays['dual'].copy(), arrays['slack'].copy()
    assert KERNELS.timing_trial(
        case.address, step.address, 0.1 / step.structure.max_relative_slack_decrease, 0.0, 0.0)
    KERNELS.timing_accept(case.address, step.address, 1, BARRIER, 0.995, 1e6)
    assert (arrays['variables'] == arrays['variables 0']).all()
    # Newton for dual * slack = barrier, shortened by the part that keeps each above 1 - 0.995
    change = (BARRIER - before * rate) / slack - before
    part = min(1.0, 0.995 / (-change / before).max())
    central = BARRIER / arrays['slack 0']
    assert arrays['dual'] == pytest.approx(
        np.clip(before + part * change, central / 1e6, central * 1e6))
    assert (arrays['dual'] > 0.0).all()


def test_shifts_are_what_former_limits_are_wider_by_and_go_with_the_step():
    mesh, points, m = random_motion(1)
    wide = bounds(LIMITS, mesh, points).problem
    close = bounds(replace(LIMITS, max_velocity=0.5 * LIMITS.max_velocity), mesh, points).problem
    close.begin(m, DurationConstraints.all_free(len(m.T), 3))
    close.shift(wide.limits)
    arrays = close.arrays
    assert close.shifted and close.slacks(m) == pytest.approx(wide.slacks(m))
    shift = arrays['shift'].copy()
    assert set(np.round(shift, 9)) == {0.0, *np.round(0.5 * LIMITS.max_velocity, 9)}
    step = close.steps[0]
    arrays['slack 0'][:] = 10.0
    KERNELS.timing_reduce_shifts(close.address, step.address, 0.25, 0.0)
    assert arrays['shift'] == pytest.approx(0.75 * shift)
    assert close.shifted
    KERNELS.timing_reduce_shifts(close.address, step.address, 0.0, 1.0)  # small: slacks are 10
    assert not close.shifted and (arrays['shift'] == 0.0).all()
    assert arrays['slack 0'] == pytest.approx(10.0 - 0.75 * shift)


def test_a_band_that_rounding_left_indefinite_still_gives_a_finite_step():
    case = Case('bounds', 0, segments=3)
    case.arrays['hessian'][:] *= 1e-18
    direction, _, _ = case.newton(0)
    assert np.isfinite(direction).all()


def test_limits_on_no_state_but_ranges_are_none_of_the_others():
    mesh, points, m = random_motion(2)
    free = replace(FREE, max_velocity=NONE, max_acceleration=NONE, max_jerk=NONE)
    assert len(bounds(free, mesh, points).problem.slacks(m)) == 2 * len(m.T) * (
        3 * (2 * mesh.n - 1) + 1)


def test_slacks_are_of_the_motion_given_and_leave_the_iterate_alone():
    case = Case('torque', 1)
    before = case.x.copy()
    other = time_scaled(case.motion, 2.0)
    assert (case.problem.slacks(other) != case.problem.slacks(case.motion)).any()
    assert (case.arrays['variables'] == before).all()
    assert flat(case.motion) == pytest.approx(before)


def test_the_objective_is_the_weighted_sum_of_durations_for_python_and_the_kernels_alike():
    mesh, points, m = random_motion(3, segments=3)
    m = m._replace(T=np.array([1.0, 7.0, 4.0]))
    durations = DurationConstraints.all_free(3, 3)._replace(weights=np.array([2.0, 0.0, 0.5]))
    problem = bounds(FREE, mesh, points).problem
    problem.begin(m, durations)
    kernels_own = KERNELS.timing_cost(problem.address, problem.arrays.addresses['variables'])
    assert durations.cost(m.T) == kernels_own == 4.0
