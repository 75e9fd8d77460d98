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

"""Limits of the joints: slacks against states and torques."""

from dataclasses import replace

from helpers.spline_cases import ARM, bounds, LIMITS, NONE, random_motion
import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.dynamics.rigid_body import inverse_dynamics
from rrr_traj_planner.planners.joint_timing.constraints import JointConstraints

SEEDS = range(6)


def slacks_of(constraints, m):
    """Return q, qd, qdd, jerk and torque's slacks, (2, N, P, 3) each, NaN where there is none."""
    problem, N, P = constraints.problem, len(m.T), 2 * constraints.mesh.n + 1
    limits, found = problem.limits, problem.slacks(m)[:-2 * N].reshape(N, -1, 2)
    states, tau = np.full((2, N, P, 12), np.nan), np.full((2, N, P, 3), np.nan)
    bounded = int(limits.bounded.sum())
    states[:, :, limits.bounded] = np.moveaxis(found[:, :bounded], -1, 0)
    tau[:, :, limits.general] = np.moveaxis(found[:, bounded:], -1, 0)
    return [*np.moveaxis(states.reshape(2, N, P, 4, 3), 3, 0), tau]


@pytest.mark.parametrize('seed', SEEDS)
def test_slacks_are_limits_less_states(seed):
    mesh, points, m = random_motion(seed)
    at, n = mesh.states(points, m), mesh.n
    q, qd, qdd, jerk, tau = slacks_of(bounds(LIMITS, mesh, points), m)
    inside = np.delete(np.arange(2 * n + 1), (0, n))
    for found, value, limit, where in (
            (qd, at.qd, LIMITS.max_velocity, np.arange(1, 2 * n + 1)),
            (qdd, at.qdd, LIMITS.max_acceleration, np.arange(1, 2 * n + 1)),
            (jerk, at.jerk, LIMITS.max_jerk, np.arange(1, n + 1)),
            (tau, inverse_dynamics(ARM, at.q, at.qd, at.qdd), LIMITS.max_effort,
             np.arange(1, 2 * n + 1))):
        assert found[0][:, where] == pytest.approx(limit - value[:, where])
        assert found[1][:, where] == pytest.approx(limit + value[:, where])
        assert np.isnan(np.delete(found, where, axis=2)).all()
    assert q[0][:, inside] == pytest.approx(LIMITS.max_position - at.q[:, inside], abs=1e-9)
    assert q[1][:, inside] == pytest.approx(at.q[:, inside] - LIMITS.min_position, abs=1e-9)


def test_least_durations_count_three_times_and_are_durations_less_their_least():
    mesh, points, m = random_motion(2)
    least_T, N = 0.5 * m.T, len(m.T)
    problem = bounds(LIMITS, mesh, points, least_T).problem
    assert problem.slacks(m)[-2 * N:].reshape(N, 2)[:, 1] == pytest.approx(m.T - least_T)


@pytest.mark.parametrize('seed', SEEDS)
def test_margins_count_at_their_own_points(seed):
    mesh, points, m = random_motion(seed)
    rng = np.random.default_rng(seed)
    shape = (len(m.T), 2 * mesh.n + 1, 3)
    q, qd, qdd, tau = rng.random((2, *shape)), *rng.random((3, *shape))
    plain = slacks_of(bounds(LIMITS, mesh, points), m)
    found = slacks_of(JointConstraints(ARM, LIMITS, mesh, points, q, qd, qdd, tau), m)
    for before, after, margin in zip(plain, found, (q, qd, qdd, 0.0, tau)):
        taken = before - after
        there = np.isfinite(taken)
        assert taken[there] == pytest.approx(np.broadcast_to(margin, taken.shape)[there])


def test_limits_that_are_infinite_never_bind():
    mesh, points, m = random_motion(2)
    limits = JointLimits([-9.0] * 3, [9.0] * 3, NONE, NONE, NONE, NONE)
    found = bounds(limits, mesh, points)
    assert not found.with_torque
    assert found.problem.limits.bounds_alone
    assert found.problem.limits.bounded.reshape(-1, 4, 3).any(axis=(0, 2)).tolist() == [
        True, False, False, False]  # the ranges
    some = replace(limits, max_effort=[np.inf, 200.0, np.inf], max_jerk=[np.inf, 5.0, np.inf])
    *_, jerk, tau = slacks_of(bounds(some, mesh, points), m)
    for slack in (jerk, tau):
        assert np.nanmin(slack[..., [0, 2]]) > 1e5
