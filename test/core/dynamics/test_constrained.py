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

"""Joints held by stops and friction: the conditions of the convex problem, on any arm."""

from __future__ import annotations

from math import inf

from helpers.random_chains import random_arm
import numpy as np
import pytest
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.dynamics.arm_dynamics import ArmDynamics
from rrr_traj_planner.core.dynamics.constrained import (
    held,
    held_and_stopped,
    NO_REACTION,
    permitted,
    rates_with_reactions,
)
from rrr_traj_planner.core.dynamics.rigid_body import inertia_matrix

FREE = (0, 0, 0)
ARMS = [RobotModel(), *(random_arm(seed) for seed in range(3))]
ROUNDING = 1e-9   # of torques of some 100 N m, by way of an inverse


def random_range(rng):
    c = rng.uniform(0.0, 60.0)
    return [NO_REACTION, (-c, c), (-inf, c), (-c, inf), (0.0, inf)][rng.integers(5)]


def random_terms(arm, count, seed):
    """Return inertia matrices, and the terms at the same random positions at rest."""
    rng, dynamics = np.random.default_rng(seed), ArmDynamics(arm)
    for q in rng.uniform(-3.0, 3.0, (count, 3)):
        yield inertia_matrix(arm, q), dynamics((*q, 0.0, 0.0, 0.0)), rng


@pytest.mark.parametrize('arm', ARMS)
def test_accelerations_and_reactions_satisfy_their_conditions(arm):
    resting = 0
    for M, t, rng in random_terms(arm, 1000, 4):
        x = tuple(rng.normal(0.0, 5.0, 3).tolist())
        ranges = tuple(random_range(rng) for _ in range(3))
        a = np.array(rates_with_reactions(t, x, ranges))
        reaction = M @ (a - x)
        for ai, ri, (low, high) in zip(a, reaction, ranges):
            if (low, high) == NO_REACTION:
                assert abs(ri) <= ROUNDING
            elif ai == 0.0:
                resting += 1
                assert low - ROUNDING <= ri <= high + ROUNDING
            else:
                assert abs(ri - (low if ai > 0.0 else high)) <= ROUNDING
    assert resting > 300


def test_a_load_at_the_edge_of_friction_still_rests():
    t = ArmDynamics(RobotModel())((0.0, 0.7, 0.3, 0.0, 0.0, 0.0))
    x = (10.0 / t.M11, 0.0, 0.0)
    edge = t.M11 * x[0]
    assert rates_with_reactions(t, x, ((-edge, edge), NO_REACTION, NO_REACTION))[0] == 0.0
    less = edge * (1.0 - 1e-9)
    assert rates_with_reactions(t, x, ((-less, less), NO_REACTION, NO_REACTION))[0] > 0.0


@pytest.mark.parametrize('joint', range(3))
def test_one_resting_joint_acts_on_the_others_as_the_rest_of_the_arm(joint):
    arm, q = ARMS[1], (0.0, 0.7, 0.3)
    M, t, others = inertia_matrix(arm, q), ArmDynamics(arm)((*q, 0.0, 0.0, 0.0)), [
        j for j in range(3) if j != joint]
    ranges = [NO_REACTION] * 3
    ranges[joint] = (-inf, inf)
    x = (1.0, 2.0, -3.0)
    a = np.array(rates_with_reactions(t, x, tuple(ranges)))
    assert a[joint] == 0.0
    assert a[others] == pytest.approx(np.linalg.solve(M[np.ix_(others, others)], (M @ x)[others]))


@pytest.mark.parametrize('arm', ARMS)
def test_permitted_rates_satisfy_the_conditions_of_the_nearest_point(arm):
    for M, t, rng in random_terms(arm, 300, 3):
        x, at = rng.uniform(-5.0, 5.0, 3), rng.integers(-1, 2, 3)
        y = np.array(permitted(t, tuple(x), tuple(at.tolist())))
        reaction = M @ (y - x)
        assert (at * y >= 0.0).all()                  # no joint moves into its stop
        assert (at * reaction >= -ROUNDING).all()     # stops push, never pull
        assert reaction[at == 0] == pytest.approx(0.0, abs=ROUNDING)
        assert reaction * y == pytest.approx(np.zeros(3), abs=ROUNDING)  # nor work
        assert y @ M @ y <= x @ M @ x + ROUNDING      # no more energy than before


@pytest.mark.parametrize('arm', ARMS)
def test_joints_away_from_stops_move_freely(arm):
    for _, t, rng in random_terms(arm, 20, 5):
        x = tuple(rng.uniform(-5.0, 5.0, 3).tolist())
        assert permitted(t, x, FREE) == x
        assert held(t, x, FREE) == x


@pytest.mark.parametrize('arm', ARMS)
def test_held_joints_rest_and_no_force_acts_on_the_others(arm):
    for M, t, rng in random_terms(arm, 200, 6):
        x, lock = rng.uniform(-5.0, 5.0, 3), rng.integers(-1, 2, 3)
        y = np.array(held(t, tuple(x.tolist()), tuple(lock.tolist())))
        assert (y[lock != 0] == 0.0).all()
        assert (M @ (y - x))[lock == 0] == pytest.approx(0.0, abs=ROUNDING)


@pytest.mark.parametrize('arm', ARMS)
def test_joints_driven_into_their_stops_by_another_s_impulse_rest_too(arm):
    struck = 0
    for _, t, rng in random_terms(arm, 300, 7):
        at = tuple(rng.integers(-1, 2, 3).tolist())
        qd = permitted(t, tuple(rng.uniform(-5.0, 5.0, 3).tolist()), at)
        lock = tuple(int(v == 0.0 or rng.random() < 0.5) for v in qd)
        after, resting = held_and_stopped(t, qd, lock, at)
        assert all(s * v >= 0.0 for s, v in zip(at, after))
        assert all(v == 0.0 for v, rests in zip(after, resting) if rests)
        assert all(rests for rests, first in zip(resting, lock) if first)
        struck += resting != lock
    assert struck > 0
