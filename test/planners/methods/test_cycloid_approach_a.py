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

"""Approach (a)'s search for durations, against scans that leave nothing out."""

from dataclasses import replace

import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.request import PlanningRequest

ARM = RobotModel()
LIMITS = JointLimits(min_position=[-3.1, -1.5, -1.57], max_position=[3.1, 3.1, 1.57],
                     max_jerk=[np.inf] * 3, max_effort=[np.inf] * 3)
SLOPE = 2.0  # of the least duration of a transition at 1 rad/s^2 [s^2/rad]
VELOCITY = 1.0  # rad/s


def cruise(v0, D, T):
    """Return the cruise velocity after a transition at full acceleration; NaN without one."""
    ahead = D - v0 * T
    with np.errstate(invalid='ignore'):
        change = np.sign(ahead) * (T - np.sqrt(T ** 2 - 2.0 * SLOPE * np.abs(ahead))) / SLOPE
    return np.where(np.abs(v0 + change) <= VELOCITY, v0 + change, np.nan)


def covered(u, v, T):
    return (0.5 * (v + u) * SLOPE * np.abs(u - v) + 0.5 * u * SLOPE * np.abs(u)
            + u * (T - SLOPE * (np.abs(u - v) + np.abs(u))))


def stop(v, D):
    """Return the least time to come to rest after D [s]; v of shape (n, 3)."""
    T = np.arange(0.02, 8.0, 0.01)[:, np.newaxis, np.newaxis]
    left = 0.5 * (T / SLOPE - np.abs(v))
    low = np.maximum(np.minimum(v, 0.0) - left, -VELOCITY)
    high = np.minimum(np.maximum(v, 0.0) + left, VELOCITY)
    fits = (left >= 0.0) & (covered(low, v, T) <= D) & (D <= covered(high, v, T))
    every = fits.all(axis=-1) & np.isfinite(v).all(axis=-1)
    return np.where(every.any(axis=0), T[every.argmax(axis=0), 0, 0], np.inf)


def planned(q):
    request = PlanningRequest(forward_kinematics(ARM, q), planner_id='cycloid_approach_a')
    return plan(ARM, LIMITS, request).trajectory.duration


def points(seed, n):
    """Return points far from the ends of the ranges: nothing overshoots them."""
    rng = np.random.default_rng(2500 + seed)
    return rng.uniform([-1.0, 0.7, -0.5], [1.0, 1.5, 0.5], (n, 3))


@pytest.mark.parametrize('seed', range(8))
def test_three_points_take_no_more_than_1_percent_above_a_dense_scan(seed):
    q = points(seed, 3)
    D = np.diff(q, axis=0)
    T = np.geomspace(0.3, 12.0, 2000)[:, np.newaxis]
    v = cruise(np.zeros(3), D[0], T)
    best = (T[:, 0] + stop(v, D[1])).min()
    assert planned(q) <= 1.01 * best
    assert planned(q) >= best - 0.02  # the scan's own steps


@pytest.mark.parametrize('seed', range(4))
def test_four_points_take_no_more_than_1_percent_above_a_dense_scan(seed):
    q = points(100 + seed, 4)
    D = np.diff(q, axis=0)
    first = np.geomspace(0.3, 8.0, 120)[:, np.newaxis, np.newaxis]
    second = np.geomspace(0.3, 8.0, 120)[:, np.newaxis]
    v1 = cruise(np.zeros(3), D[0], first)
    v2 = cruise(v1, D[1], second)
    so_far = np.broadcast_to((first + second)[..., 0], v2.shape[:2])
    whole = np.isfinite(v2).all(axis=-1) & np.isfinite(v1).all(axis=-1)
    best = (so_far[whole] + stop(v2[whole], D[2])).min()
    assert planned(q) <= 1.01 * best


def test_leaving_the_range_is_avoided_by_other_durations():
    # Close to the end of joint 1's range the fastest motion would overshoot it.
    narrow = replace(LIMITS, max_position=[1.05, 3.1, 1.57])
    q = np.array([[0.0, 1.0, 0.0], [1.0, 1.2, 0.3], [0.3, 1.4, -0.3]])
    request = PlanningRequest(forward_kinematics(ARM, q), planner_id='cycloid_approach_a')
    answer = plan(ARM, narrow, request)
    assert answer.peaks.max_position[0] <= 1.05 + 1e-9
    assert answer.trajectory.duration >= planned(q)
