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

"""The brake of one joint: it ends at rest, keeps its bounds, and is the quickest."""

from __future__ import annotations

import numpy as np
from rrr_traj_planner.core.stopping.joint_brake import greatest_deceleration, joint_brake

COUNT = 500


def random_brakes(seed):
    """Return states with bounds, and their quickest brakes."""
    rng = np.random.default_rng(seed)
    v, a = rng.normal(size=(2, COUNT)) * 10.0 ** rng.uniform(-4.0, 1.0, (2, COUNT))
    A, J = 10.0 ** rng.uniform((-1.0, 0.0), (1.0, 2.0), (COUNT, 2)).T
    A[::7], J[::5] = np.inf, np.inf
    return v, a, A, J, joint_brake(v, a, greatest_deceleration(v, a, A, J), J)


def test_brake_ends_at_rest_within_its_bounds():
    v, a, A, J, brake = random_brakes(1)
    t = np.linspace(0.0, 1.0, 101)[:, np.newaxis] * brake.duration
    _, velocity, acceleration, jerk = brake.at(t)
    assert (np.abs(velocity[-1]) <= 1e-12 * (np.abs(v) + np.abs(a) * brake.duration)).all()
    assert (np.abs(acceleration) <= np.maximum(A, np.abs(a)) * (1.0 + 1e-12)).all()
    assert (np.abs(jerk) <= J).all()
    limited = np.isfinite(J)
    assert np.abs(acceleration[-1, limited]).max() <= 1e-9


def test_displacement_and_velocity_are_integrals():
    _, _, _, _, brake = random_brakes(2)
    t = np.linspace(0.0, 1.0, 2001)[:, np.newaxis] * brake.duration
    moved, velocity, acceleration, _ = brake.at(t)
    scale = np.abs(velocity).max(axis=0) * brake.duration
    assert (np.abs(np.trapezoid(velocity, t, axis=0) - moved[-1]) <= 1e-6 * scale).all()
    change = np.trapezoid(acceleration, t, axis=0)
    size = np.abs(acceleration).max(axis=0) * brake.duration
    assert (np.abs(velocity[0] + change - velocity[-1]) <= 2e-3 * size + 1e-12).all()


def test_extremes_are_those_of_a_fine_grid():
    *_, brake = random_brakes(3)
    least, greatest = brake.extremes()
    moved, velocity, *_ = brake.at(np.linspace(0.0, 1.0, 2001)[:, np.newaxis] * brake.duration)
    margin = 1e-6 * np.abs(velocity).max(axis=0) * brake.duration
    assert (moved.min(axis=0) >= least).all() and (moved.max(axis=0) <= greatest).all()
    assert (moved.min(axis=0) <= least + margin).all()
    assert (moved.max(axis=0) >= greatest - margin).all()


def test_no_other_deceleration_is_quicker_or_shorter():
    v, a, A, J, brake = random_brakes(4)
    greatest = greatest_deceleration(v, a, A, J)
    for part in (0.99, 0.7, 0.3):
        other = joint_brake(v, a, part * greatest, J)
        assert (other.duration >= brake.duration * (1.0 - 1e-12)).all()
        same_direction = v * a >= 0.0  # nothing to turn back from
        assert (np.abs(other.at(other.duration)[0]) >= np.abs(
            brake.at(brake.duration)[0]) * (1.0 - 1e-9))[same_direction].all()


def test_joint_at_rest_takes_no_time():
    zero = np.zeros(3)
    assert joint_brake(zero, zero, zero, np.full(3, 10.0)).duration.tolist() == [0.0, 0.0, 0.0]
