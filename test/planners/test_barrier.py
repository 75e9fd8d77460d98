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
from rrr_traj_planner.planners.barrier import Chain, derivatives, value
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


@pytest.mark.parametrize('seed', SEEDS)
def test_gradient_is_the_finite_difference_of_the_value(seed):
    chain, floor, v, T = chain_and_point(seed)
    assert np.isfinite(value(chain, floor, v, T))
    ours = derivatives(chain, floor, v, T)
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
    d, n = derivatives(chain, floor, v, T), len(T)
    hessian = np.zeros((4 * n - 3, 4 * n - 3))  # T0, ..., then v0, v1, ...
    hessian[range(n), range(n)] = d.T_T
    for k in range(n - 1):
        at = n + 3 * k + np.arange(3)
        hessian[at, at] = d.v_v[k]
        hessian[at, k] = hessian[k, at] = d.v1_T[k]
        hessian[at, k + 1] = hessian[k + 1, at] = d.v0_T[k + 1]
        if k + 1 < n - 1:
            hessian[at, at + 3] = hessian[at + 3, at] = d.v_next[k]
    assert np.linalg.eigvalsh(hessian).min() > 0.0


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


def test_reaches_are_mirror_images_of_each_other():
    chain, _, v, T = chain_and_point(0)
    v0, v1 = np.vstack((np.zeros(3), v)), np.vstack((v, np.zeros(3)))
    ours = chain.reaches(v0, v1, T[:, np.newaxis]).distance
    mirrored = chain.reaches(-v0, -v1, T[:, np.newaxis]).distance
    assert (ours[0] == mirrored[1]).all()
    assert (ours[1] == mirrored[0]).all()
