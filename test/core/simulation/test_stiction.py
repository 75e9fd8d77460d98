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

"""Which joints rest: the conditions of the convex problem, on random poses and ranges."""

from __future__ import annotations

from math import cos, inf, sin

import numpy as np
import pytest
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.dynamics.equations import constants, terms
from rrr_traj_planner.core.dynamics.rigid_body import inertia_matrix
from rrr_traj_planner.core.simulation.stiction import NO_REACTION, resting_accelerations

MODEL = RobotModel()

# Torques of some 100 N m, through an inverse.
ROUNDING = 1e-9


def random_range(rng):
    c = rng.uniform(0.0, 60.0)
    return [NO_REACTION, (-c, c), (-inf, c), (-c, inf), (0.0, inf)][rng.integers(5)]


def random_cases(count, seed=4):
    rng = np.random.default_rng(seed)
    for _ in range(count):
        q = rng.uniform(-3.0, 3.0, 3)
        yield (inertia_matrix(MODEL, q), terms(constants(MODEL), q[1], q[2], sin, cos),
               tuple(rng.normal(0.0, 5.0, 3).tolist()), tuple(random_range(rng) for _ in range(3)))


def test_accelerations_and_reactions_meet_their_conditions():
    resting = 0
    for H, t, x, ranges in random_cases(3000):
        a = np.array(resting_accelerations(t, x, ranges))
        reaction = H @ (a - x)
        for ai, ri, (low, high) in zip(a, reaction, ranges):
            if (low, high) == NO_REACTION:
                assert abs(ri) <= ROUNDING
            elif ai == 0.0:
                resting += 1
                assert low - ROUNDING <= ri <= high + ROUNDING
            else:
                assert abs(ri - (low if ai > 0.0 else high)) <= ROUNDING
    assert resting > 1000


def test_a_load_at_the_edge_of_friction_still_rests():
    t = terms(constants(MODEL), 0.7, 0.3, sin, cos)
    x = (10.0 / t.M11, 0.0, 0.0)
    edge = t.M11 * x[0]
    assert resting_accelerations(t, x, ((-edge, edge), NO_REACTION, NO_REACTION))[0] == 0.0
    less = edge * (1.0 - 1e-9)
    assert resting_accelerations(t, x, ((-less, less), NO_REACTION, NO_REACTION))[0] > 0.0


@pytest.mark.parametrize('joint', [1, 2])
def test_one_resting_joint_is_felt_by_the_other(joint):
    H = inertia_matrix(MODEL, (0.0, 0.7, 0.3))
    t = terms(constants(MODEL), 0.7, 0.3, sin, cos)
    ranges = [NO_REACTION] * 3
    ranges[joint] = (-inf, inf)
    x = (1.0, 2.0, -3.0)
    a = resting_accelerations(t, x, tuple(ranges))
    other = 3 - joint
    assert (a[0], a[joint]) == (1.0, 0.0)
    assert a[other] == pytest.approx((H @ x)[other] / H[other, other])
