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

"""Factors of time that bring torques to their limits: against a fine search, and at the edges."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from rrr_traj_planner.core.trajectory.time_scaling import (
    squared_scaling,
    squared_scaling_any_slower,
    squared_scaling_if_held,
    TorqueParts,
)

LIMIT = 10.0
ALL = (squared_scaling, squared_scaling_any_slower, squared_scaling_if_held)
ROUNDED = LIMIT * (1.0 + 1e-10)  # what counts as the limit


def factor(function, *parts):
    """Return a function's factor, for one torque; overflow and the like are errors."""
    with warnings.catch_warnings():
        warnings.simplefilter('error')
        squared = function(np.array([LIMIT]), TorqueParts(*(np.array([x]) for x in parts)))
    return float(np.sqrt(squared[0]))


def within(f, k, v, m):
    return np.abs(k + v / f + m / f ** 2) <= LIMIT


def brute_force(*parts):
    """Return the nearest factor of a torque by a fine search from 1 down, or up."""
    if within(1.0, *parts):
        f = np.linspace(1.0, 1e-3, 100001)
        kept = within(f, *parts)
        return 0.0 if kept.all() else f[np.argmin(kept)]
    f = np.geomspace(1.0, 1e3, 1000001)
    kept = within(f, *parts)
    return f[np.argmax(kept)] if kept.any() else np.inf


def random_parts(seed):
    """Return random parts, the constant one within the limit or not, some without friction."""
    rng = np.random.default_rng(seed)
    (v, m), viscous = rng.normal(size=2) * rng.choice([1.0, 10.0, 30.0], 2), seed % 4 > 0
    return rng.uniform(-1.5, 1.5) * LIMIT, v * viscous, m


@pytest.mark.parametrize('seed', range(120))
def test_nearest_factor_is_that_of_a_fine_search(seed):
    parts = random_parts(seed)
    assert factor(squared_scaling, *parts) == pytest.approx(
        brute_force(*parts), rel=2e-5, abs=2e-3)


@pytest.mark.parametrize('seed', range(120))
def test_from_the_other_factor_on_every_slower_motion_is_within_and_the_next_faster_is_not(seed):
    parts = random_parts(seed)
    found = factor(squared_scaling_any_slower, *parts)
    assert np.isinf(found) == (abs(parts[0]) > LIMIT)
    if np.isinf(found):
        return
    f = np.geomspace(max(found, 1e-3) * (1.0 + 1e-9), 1e4, 20001)
    assert (np.abs(parts[0] + parts[1] / f + parts[2] / f ** 2) <= ROUNDED).all()
    assert found < 1e-3 or not within(found * (1.0 - 1e-6), *parts)
    assert found >= factor(squared_scaling, *parts) * (1.0 - 1e-12)


@pytest.mark.parametrize('seed', range(120))
def test_a_torque_that_cannot_be_held_has_no_factor_if_it_is_to_be(seed):
    parts = random_parts(seed)
    expected = np.inf if abs(parts[0]) > LIMIT else factor(squared_scaling, *parts)
    assert factor(squared_scaling_if_held, *parts) == expected


@pytest.mark.parametrize('viscous', [0.0, 1e-200, 1.0])
@pytest.mark.parametrize('inertial', [0.0, 1e-200, 2.0])
@pytest.mark.parametrize('constant', [LIMIT, ROUNDED])
def test_without_any_margin_only_what_does_not_press_on_is_possible(constant, viscous, inertial):
    expected = 0.0 if viscous == inertial == 0.0 else np.inf
    for function in ALL:
        assert factor(function, constant, viscous, inertial) == expected
        assert factor(function, -constant, -viscous, -inertial) == expected


@pytest.mark.parametrize('function', ALL)
def test_without_any_margin_friction_against_gravity_leaves_what_inertia_may_take(function):
    # 10 N m of gravity, less 3 / f of viscous friction: 2 / f^2 of inertia at f of at least 2 / 3.
    assert factor(function, LIMIT, -3.0, 2.0) == pytest.approx(2.0 / 3.0, rel=1e-12)


@pytest.mark.parametrize('function', ALL)
def test_factors_whose_square_no_float_holds_are_infinite(function):
    with warnings.catch_warnings():
        warnings.simplefilter('error')
        squared = function(np.array([1e-180]), TorqueParts(*np.array([[0.0], [1e10], [1.0]])))
    assert squared.tolist() == [np.inf]


@pytest.mark.parametrize('function', ALL)
def test_joints_without_a_limit_need_no_factor_beside_others(function):
    parts = TorqueParts(np.array([1e6, LIMIT, 0.0]), np.array([5.0, 1.0, 1.0]),
                        np.array([5.0, 0.0, 0.0]))
    with warnings.catch_warnings():
        warnings.simplefilter('error')
        found = function(np.array([np.inf, LIMIT, LIMIT]), parts)
    assert found.tolist() == pytest.approx([0.0, np.inf, 0.01], rel=1e-12)


@pytest.mark.parametrize('function', ALL)
def test_without_viscous_friction_the_quadratic_is_the_one_of_gravity_and_inertia(function):
    rng = np.random.default_rng(0)
    k, m, small = rng.uniform(-15.0, 15.0, 200), rng.normal(0.0, 20.0, 200), np.full(200, 1e-13)
    limit = np.full(200, LIMIT)
    plain = function(limit, TorqueParts(k, np.zeros(200), m))
    np.testing.assert_allclose(function(limit, TorqueParts(k, small, m)), plain, rtol=1e-9)
