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

"""Joint stops: the law of inelastic impact and of least constraint, by its conditions."""

from __future__ import annotations

from math import cos, sin

import numpy as np
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.dynamics.equations import constants, terms
from rrr_traj_planner.core.dynamics.rigid_body import inertia_matrix
from rrr_traj_planner.core.simulation.joint_stops import contact, FREE, held, permitted

MODEL = RobotModel()
ROUNDING = 1e-9


def random_cases(count):
    rng = np.random.default_rng(3)
    for _ in range(count):
        q = rng.uniform(-3.0, 3.0, 3)
        yield (inertia_matrix(MODEL, q), terms(constants(MODEL), q[1], q[2], sin, cos),
               rng.uniform(-5.0, 5.0, 3), rng.integers(-1, 2, 3))


def test_permitted_rates_meet_the_conditions_of_the_nearest_point():
    for H, t, x, at in random_cases(500):
        y = np.array(permitted(t, tuple(x), tuple(at)))
        reaction = H @ (y - x)
        assert (at * y >= 0.0).all()                  # no joint moves into its stop
        assert (at * reaction >= -ROUNDING).all()     # stops push, never pull
        np.testing.assert_allclose(reaction[at == 0], 0.0, atol=ROUNDING)
        np.testing.assert_allclose(reaction * y, 0.0, atol=ROUNDING)  # nor work


def test_permitted_rates_have_no_more_energy():
    for H, t, x, at in random_cases(200):
        y = np.array(permitted(t, tuple(x), tuple(at)))
        assert y @ H @ y <= x @ H @ x + ROUNDING


def test_joints_away_from_stops_are_left_alone():
    for _, t, x, _ in random_cases(20):
        assert permitted(t, tuple(x), FREE) == tuple(x)
        assert held(t, tuple(x), FREE) == tuple(x)


def test_held_joints_stay_and_the_others_feel_no_force():
    for H, t, x, lock in random_cases(200):
        y = np.array(held(t, tuple(x), tuple(lock)))
        assert (y[lock != 0] == 0.0).all()
        np.testing.assert_allclose((H @ (y - x))[lock == 0], 0.0, atol=ROUNDING)


def test_contact_names_the_side():
    state = (0.0, 2.0, 0.5, 0.0, 0.0, 0.0)
    assert contact(state, (0.0, 0.0, 0.0), (1.0, 2.0, 1.0)) == (1, -1, 0)
