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

"""The barrier's derivatives against finite differences of its value."""

from dataclasses import replace

import numpy as np
import pytest
from random_cases import central_difference
from rrr_traj_planner.planners.barrier import (
    damped,
    derivatives,
    local,
    misjudged,
    Parts,
    values,
)
from rrr_traj_planner.planners.chain import Chain
from rrr_traj_planner.planners.segment import TransitionLaw

SEEDS = range(20)


def chain_and_point(seed):
    """Return a chain, least durations or none, and a strictly feasible point."""
    rng = np.random.default_rng(1500 + seed)
    n = int(rng.integers(2, 6))
    law = TransitionLaw(rng.uniform(0.5, 3.0, 3),
                        rng.uniform(0.3, 1.5, 3) * (rng.random(3) < 0.5))
    highest = rng.uniform(0.5, 1.0, (n - 1, 3))
    chain = Chain(rng.normal(0.0, 0.5, (n, 3)), law, np.full(3, 1.2), -highest, highest)
    T = chain.rest_to_rest_times() * rng.uniform(1.3, 2.0, n)
    v = 0.05 * rng.uniform(-1.0, 1.0, (n - 1, 3))
    return chain, 0.8 * T if seed % 2 else None, v, T


def undamped(chain):
    """Return no damping of any part."""
    n = len(chain.displacements)
    return Parts(np.zeros((n, 3)), np.zeros((n - 1, 3)), np.zeros(n))


def value(chain, floor, v, T):
    """Return the barrier."""
    return sum(p.sum() for p in values(chain, floor, v, T))


def dense_hessian(d):
    """Return the Hessian, durations first, then velocities."""
    n = len(d.T_T)
    hessian = np.zeros((4 * n - 3, 4 * n - 3))  # T0, ..., then v0, v1, ...
    hessian[range(n), range(n)] = d.T_T
    for k in range(n - 1):
        at = n + 3 * k + np.arange(3)
        hessian[at, at] = d.v_v[k]
        hessian[at, k] = hessian[k, at] = d.v1_T[k]
        hessian[at, k + 1] = hessian[k + 1, at] = d.v0_T[k + 1]
        if k + 1 < n - 1:
            hessian[at, at + 3] = hessian[at + 3, at] = d.v_next[k]
    return hessian


@pytest.mark.parametrize('seed', SEEDS)
def test_value_is_the_sum_of_logarithms_of_what_is_left_of_each_limit(seed):
    # each slack by brute force over cruise velocities, as a limit on the displacement
    chain, floor, v, T = chain_and_point(seed)
    v0, v1 = np.vstack((np.zeros(3), v)), np.vstack((v, np.zeros(3)))
    u = np.linspace(-chain.max_velocity, chain.max_velocity, 8001)[:, np.newaxis]
    t0, t1 = chain.law.least_time(u - v0), chain.law.least_time(u - v1)
    covered = 0.5 * (v0 + u) * t0 + u * (T[:, np.newaxis] - t0 - t1) + 0.5 * (u + v1) * t1
    fits = t0 + t1 <= T[:, np.newaxis]
    D = chain.displacements
    change = chain.law.largest_change(T[:, np.newaxis])
    slacks = (np.where(fits, covered, -np.inf).max(axis=0) - D,
              D - np.where(fits, covered, np.inf).min(axis=0),
              change - (v1 - v0), change + (v1 - v0))
    found = values(chain, floor, v, T)
    # the grid of cruises misses the best one by a bit, which hardly counts where much is left
    enough = np.minimum(slacks[0], slacks[1]) > 0.05
    assert enough.any()
    assert found.segments[enough] == pytest.approx(
        -sum(np.log(s) for s in slacks)[enough], abs=0.02)
    assert found.velocities == pytest.approx(
        -np.log(v - chain.lowest) - np.log(chain.highest - v), rel=1e-12)
    assert found.durations == pytest.approx(
        np.zeros(len(T)) if floor is None else -np.log(T - floor), rel=1e-12)


@pytest.mark.parametrize('seed', SEEDS)
def test_gradient_is_the_finite_difference_of_the_value(seed):
    chain, floor, v, T = chain_and_point(seed)
    assert np.isfinite(value(chain, floor, v, T))
    ours = derivatives(local(chain, floor, v, T))
    for index in np.ndindex(v.shape):
        step = np.zeros_like(v)
        step[index] = 1.0
        difference = central_difference(
            lambda x, step=step: value(chain, floor, v + x * step, T), 0.0, 1e-5)
        assert ours.g_v[index] == pytest.approx(difference, rel=1e-5, abs=1e-4)
    for k, unit in enumerate(np.eye(len(T))):
        difference = central_difference(
            lambda x, unit=unit: value(chain, floor, v, T + x * unit), 0.0, 1e-5)
        assert ours.g_T[k] == pytest.approx(difference, rel=1e-5, abs=1e-4)


@pytest.mark.parametrize('seed', SEEDS)
@pytest.mark.parametrize('spare', [1.0, 4.0])
def test_hessian_is_positive_definite(seed, spare):
    chain, floor, v, T = chain_and_point(seed)
    T = spare * T  # much time to spare: there the barrier itself is not convex
    d = derivatives(local(chain, floor, v, T))
    assert np.linalg.eigvalsh(dense_hessian(d)).min() > 0.0


@pytest.mark.parametrize('seed', SEEDS)
def test_damping_of_all_parts_alike_scales_the_hessian_and_no_gradient(seed):
    chain, floor, v, T = chain_and_point(seed)
    at, none = local(chain, floor, v, T), undamped(chain)
    plain = derivatives(at)
    twice = derivatives(damped(at, Parts(*(p + 1.0 for p in none))))
    assert dense_hessian(twice) == pytest.approx(2.0 * dense_hessian(plain), rel=1e-12)
    assert (twice.g_v == plain.g_v).all() and (twice.g_T == plain.g_T).all()


@pytest.mark.parametrize('seed', SEEDS)
def test_a_part_that_is_left_is_misjudged_and_none_else_once_they_are_stiff(seed):
    chain, floor, v, T = chain_and_point(seed)
    at, before = local(chain, floor, v, T), values(chain, floor, v, T)
    rng = np.random.default_rng(seed)
    dv, dT = rng.normal(size=v.shape), rng.normal(size=T.shape)
    dv, dT = 0.2 * chain.highest[:, :1] * dv, 0.2 * T * dT
    after = values(chain, floor, v + dv, T + dT)
    change = Parts(*(a - b for a, b in zip(after, before)))
    wrong = misjudged(at, dv, dT, change)
    left = [np.isinf(p) for p in after]
    for out, found in zip(left, wrong):
        assert found[out].all()
    stiff = damped(at, Parts(*(p + 1e9 for p in undamped(chain))))
    again = misjudged(stiff, dv, dT, change)
    if any(out.any() for out in left):
        for out, found in zip(left, again):
            assert (found == out).all()


@pytest.mark.parametrize('seed', SEEDS)
def test_value_is_infinite_where_a_constraint_is_broken(seed):
    chain, floor, v, T = chain_and_point(seed)
    too_fast = v.copy()
    too_fast[0, 1] = 1.01 * chain.highest[0, 1]
    too_short = T.copy()
    too_short[-1] = 1e-3
    none = T.copy()
    none[0] = 0.0
    assert value(chain, floor, too_fast, T) == np.inf
    assert value(chain, floor, v, too_short) == np.inf
    assert value(chain, floor, v, none) == np.inf
    assert value(chain, 1.001 * T, v, T) == np.inf


def test_rest_to_rest_times_are_what_a_hand_calculation_gives():
    # 1 rad/s^2, 1 rad/s: 0.5 rad: sqrt(D slope) twice, 2 s. 3 rad: 2 s + 3 s. Nothing: 0.
    law = TransitionLaw(np.full(3, 2.0), np.zeros(3))
    D = np.array([[0.5, 0.1, 0.0], [0.0, -3.0, 0.2], [0.0, 0.0, 0.0]])
    none = np.zeros((2, 3))
    chain = Chain(D, law, np.ones(3), none, none)
    assert chain.rest_to_rest_times() == pytest.approx([2.0, 5.0, 0.0])
    # Jerk alone, root 2: D = u t, t = 2 sqrt(u): u = (D / 2)^(2/3); 2 rad: 2 t = 4 s.
    jerky = replace(chain, law=TransitionLaw(np.full(3, 1e-9), np.full(3, 2.0)),
                    max_velocity=np.full(3, 9.0), displacements=np.full((1, 3), 2.0))
    assert jerky.rest_to_rest_times() == pytest.approx([4.0])
