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

"""Slacks of a chain of ramps against its states, and their derivatives against differences."""

from dataclasses import replace

import numpy as np
import pytest
from ramp_cases import ARM, bounds, LIMITS, NONE, own_unknowns, random_motion, random_step, shifted
from random_cases import central_difference
from rrr_traj_planner.core.dynamics import gravity_torque, inverse_dynamics
from rrr_traj_planner.core.limits import JointLimits
from rrr_traj_planner.planners.ramp_constraints import Constraints, torque_hessian

SEEDS = range(10)
# The equations' terms are differentiated by a one-sided difference over 1e-7 rad.
DIFFERENCE = {'rel': 2e-5, 'abs': 2e-4}


@pytest.mark.parametrize('seed', SEEDS)
def test_slacks_are_limits_less_states(seed):
    grid, points, m = random_motion(seed)
    at, n = grid.states(points, m), grid.n
    qd, qdd, jerk, q, tau = bounds(LIMITS, grid, points).slacks(m)
    assert qd[0] == pytest.approx(LIMITS.max_velocity - at.qd[:, 1:])
    assert qdd[1] == pytest.approx(LIMITS.max_acceleration + at.qdd[:, 1:n + 1])
    assert jerk[0] == pytest.approx(LIMITS.max_jerk - at.jerk)
    inside = np.delete(at.q, (0, n), axis=1)
    assert q[0] == pytest.approx(LIMITS.max_position - inside, abs=1e-9)
    assert q[1] == pytest.approx(inside - LIMITS.min_position, abs=1e-9)
    torque = inverse_dynamics(ARM, at.q, at.qd, at.qdd)[:, 1:]
    assert tau[0] == pytest.approx(LIMITS.max_effort - torque)
    assert tau[1] == pytest.approx(LIMITS.max_effort + torque)


def test_margins_and_floors_take_their_part():
    grid, points, m = random_motion(2)
    plain, inside = (bounds(LIMITS, grid, points, margin=x).slacks(m)[3] for x in (0.0, 0.1))
    assert inside == pytest.approx(plain - 0.1)
    floor = 0.5 * m.T
    assert bounds(LIMITS, grid, points, floor).slacks(m)[0][1] == pytest.approx(
        np.broadcast_to((m.T - floor)[:, np.newaxis, np.newaxis], (len(m.T), 1, 3)))


@pytest.mark.parametrize('seed', SEEDS)
def test_margins_of_velocity_torque_and_position_count_at_their_own_points(seed):
    grid, points, m = random_motion(seed)
    rng, n = np.random.default_rng(seed), grid.n
    shape = (len(m.T), 2 * n + 1, 3)
    q, qd, tau = rng.random((2, *shape)), rng.random(shape), rng.random(shape)
    plain = bounds(LIMITS, grid, points).slacks(m)
    found = Constraints(ARM, LIMITS, grid, points, q, qd, tau).slacks(m)
    assert plain[0] - found[0] == pytest.approx(np.stack((qd, qd))[:, :, 1:])
    assert plain[3] - found[3] == pytest.approx(np.delete(q, (0, n), axis=2))
    assert plain[4] - found[4] == pytest.approx(np.stack((tau, tau))[:, :, 1:])
    for k in (1, 2):
        assert (plain[k] == found[k]).all()


def test_limits_that_are_infinite_never_bind():
    grid, points, m = random_motion(2)
    limits = JointLimits([-9.0] * 3, [9.0] * 3, NONE, NONE, NONE, NONE)
    found = bounds(limits, grid, points)
    assert not found.with_torque
    assert len(found.slacks(m)) == 1  # the ranges
    some = replace(limits, max_effort=[np.inf, 200.0, np.inf], max_jerk=[np.inf, 5.0, np.inf])
    for slack in bounds(some, grid, points).slacks(m)[::2]:
        assert slack[..., [0, 2]].min() > 1e5


@pytest.mark.parametrize('seed', SEEDS)
@pytest.mark.parametrize('with_floor', [False, True])
def test_changes_are_finite_differences_of_slacks(seed, with_floor):
    grid, points, m = random_motion(seed)
    step = random_step(seed, m)
    constraints = bounds(LIMITS, grid, points, 0.5 * m.T if with_floor else None)
    slacks, changes, _ = constraints.linear(m)
    for s, plain in zip(slacks, constraints.slacks(m)):
        assert s == pytest.approx(plain)
    y = own_unknowns(grid, step)
    for k, x in enumerate(changes):
        rate = x.by_y @ y if x.by_y.ndim == 3 else np.einsum('npijm,nmj->npi', x.by_y, y)
        rate = rate + x.by_T * step.T[:, np.newaxis, np.newaxis]
        for side, sign in ((0, -1.0), (1, 1.0)):
            difference = central_difference(lambda z, k=k, side=side: constraints.slacks(
                shifted(m, step, z))[k][side], 0.0, 1e-3)
            assert sign * rate == pytest.approx(difference, **DIFFERENCE)


@pytest.mark.parametrize('seed', SEEDS)
def test_torque_hessian_is_torque_s_second_difference_by_position_twice_gravity_s_alone(seed):
    grid, points, m = random_motion(seed)
    rng = np.random.default_rng(seed)
    constraints = bounds(LIMITS, grid, points)
    slacks, changes, curvature = constraints.linear(m)
    duals = rng.uniform(0.1, 1.0, slacks[-1].shape)
    yy, yT, TT = torque_hessian(curvature, duals)
    sigma, step = duals[0] - duals[1], random_step(seed, m)
    y = np.swapaxes(own_unknowns(grid, step), 1, 2).reshape(len(m.T), -1)
    found = (y * (yy @ y[..., np.newaxis])[..., 0]).sum(axis=1) + 2.0 * step.T * (
        yT.reshape(len(m.T), -1) * y).sum(axis=1) + TT * step.T ** 2

    # How states move on the step, to first order: the second order of states is not torque's own.
    at = grid.states(points, m)
    by_y, by_T = grid.changes(m), grid.changes_by_duration(m, at)
    dq, dqd, dqdd = (getattr(by_y, kind) @ own_unknowns(grid, step)
                     + getattr(by_T, kind) * step.T[:, np.newaxis, np.newaxis]
                     for kind in ('q', 'qd', 'qdd'))

    def total(x, z):
        tau = inverse_dynamics(ARM, at.q + x * dq, at.qd + z * dqd, at.qdd + z * dqdd)
        return (sigma * tau[:, 1:]).sum(axis=(1, 2))

    def gravity(x):
        return (sigma * gravity_torque(ARM, at.q + x * dq)[:, 1:]).sum(axis=(1, 2))

    # twice along the whole step, with gravity's part in the place of what position alone has
    e = 1e-3
    whole = (total(e, e) - 2.0 * total(0.0, 0.0) + total(-e, -e)) / e ** 2
    position = (total(e, 0.0) - 2.0 * total(0.0, 0.0) + total(-e, 0.0)) / e ** 2
    expected = whole - position + (gravity(e) - 2.0 * gravity(0.0) + gravity(-e)) / e ** 2
    assert found == pytest.approx(expected, rel=1e-3, abs=1e-3 * np.abs(found).max())
