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

"""Requests whose numbers are special: equal, zero, symmetric, repeated, tiny or huge."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.planners.request import PlanningRequest
from tasks import ARM, gentle, NONE, Task, WEAK

KINDS = ('equal steps', 'equal steps, then a corner', 'collinear', 'one joint still',
         'two joints still', 'close pairs', 'mirrored', 'there and back', 'repeated points',
         'at the ends of ranges', 'round numbers', 'all of it')
LOW, HIGH = np.array([0.0, 0.6, -0.4]), np.array([np.pi / 2, 1.7, 0.8])  # tip before the axis
STRONG = np.full(3, 400.0)  # N m, enough to hold the arm anywhere
MOST_POINTS = 20_000
SPEEDS = (1.0, 1.0, 1.0, 0.01, 0.3)
PERIODS = (0.01, 0.01, 0.01, 0.001, 0.02, 0.1, 0.5)
ALONG_PATHS = ('line_arc', 'line_polynomial')  # they take no durations


def degenerate_task(seed: int, planner_id: str) -> Task:
    """Return the request of a seed to a planner; KINDS[seed % len(KINDS)] is its kind."""
    rng = np.random.default_rng(seed)
    kind = KINDS[seed % len(KINDS)]
    n = int(rng.integers(2, 13))
    if kind == 'all of it':
        q = joint_points(rng, str(rng.choice(KINDS[:-1])), n)
        q = _specialised(rng, str(rng.choice(KINDS[5:-1])), q)
        q = _specialised(rng, str(rng.choice(KINDS[3:5])), q)
    else:
        q = joint_points(rng, kind, n)
    limits = _limits(rng, planner_id)
    request = PlanningRequest(
        forward_kinematics(ARM, q), planner_id=planner_id, elbow='up',
        velocity_scaling=float(rng.choice(SPEEDS)),
        acceleration_scaling=float(rng.choice(SPEEDS)),
        sample_period=float(rng.choice(PERIODS)), max_points=MOST_POINTS,
        max_deviation=float(rng.choice([0.001, 0.01, 0.05, 0.5])))
    durations = _long_enough(
        q, limits.scaled(request.velocity_scaling, request.acceleration_scaling))
    request = replace(request, sample_period=max(
        request.sample_period, 2.0 * durations.sum() / MOST_POINTS))
    if planner_id not in ALONG_PATHS and rng.random() < 0.25:
        request = replace(request, segment_durations=durations)
    return Task(f'seed {seed}, {kind}', limits, request)


def _long_enough(q: np.ndarray, limits: JointLimits) -> np.ndarray:
    """Return equal durations [s], in which each segment can be gone from rest to rest."""
    longest = np.abs(np.diff(q, axis=0)).max(axis=0)
    each = 4.0 * (longest / limits.max_velocity + np.sqrt(longest / limits.max_acceleration)
                  + np.cbrt(longest / limits.max_jerk))
    return np.full(len(q) - 1, np.ceil(10.0 * max(each.max(), 0.05)) / 10.0)


def joint_points(rng: np.random.Generator, kind: str, n: int) -> np.ndarray:
    """Return joint positions of a kind, at least two, shape (n, 3) [rad]."""
    start = rng.uniform(LOW, HIGH)
    if kind.startswith('equal steps'):
        corner = kind.endswith('corner')
        step = (rng.uniform(LOW, HIGH) - start) / max(n - 1, 1)
        if rng.random() < 0.5:
            step[rng.random(3) < 0.5] = 0.0
        q = start + step * np.arange(n)[:, np.newaxis]
        if corner:
            q[-1] = rng.uniform(LOW, HIGH) if rng.random() < 0.5 else q[-1] + 0.5 * step
        return np.clip(q, LOW, HIGH)
    if kind == 'collinear':
        share = np.sort(rng.random(n) if rng.random() < 0.5 else rng.integers(0, 9, n) / 8.0)
        return start + (rng.uniform(LOW, HIGH) - start) * share[:, np.newaxis]
    return _specialised(rng, kind, rng.uniform(LOW, HIGH, (n, 3)))


def _specialised(rng: np.random.Generator, kind: str, q: np.ndarray) -> np.ndarray:
    """Return drawn points changed to what their kind asks for."""
    q, n = q.copy(), len(q)
    if kind in ('one joint still', 'two joints still'):
        still = rng.permutation(3)[:1 if kind.startswith('one') else 2]
        q[:, still] = q[0, still]
    elif kind == 'close pairs':
        for k in range(1, n, 2):
            step = rng.normal(size=3)
            size = 10.0 ** rng.uniform(-8.0, -3.0)
            q[k] = np.clip(q[k - 1] + size * step / np.linalg.norm(step), LOW, HIGH)
    elif kind == 'mirrored':
        q[:, 0] = 0.25 * np.pi + (q[:, 0] - 0.25 * np.pi) * np.where(np.arange(n) % 2, 1.0, -1.0)
        q = np.concatenate((q, q[::-1] * (-1.0, 1.0, 1.0) + (0.5 * np.pi, 0.0, 0.0)))
    elif kind == 'there and back':
        q = np.concatenate((q, q[-2::-1])) if rng.random() < 0.5 else q[np.arange(n) % 2]
    elif kind == 'repeated points':
        q = np.repeat(q, rng.integers(1, 4, n), axis=0)
    elif kind == 'at the ends of ranges':
        low, high = JointLimits().min_position, JointLimits().max_position
        q[:, 0] = rng.choice([low[0], high[0], 0.5], n)
        q[rng.integers(n)] = (0.0, 0.5 * np.pi, 0.0)
    elif kind == 'round numbers':
        q = np.clip(np.round(q, 1), LOW.round(1), (1.5, 1.7, 0.8))
    return q


def _limits(rng: np.random.Generator, planner_id: str) -> JointLimits:
    """Return the thesis's limits, or ones of which some are tiny, huge or missing."""
    limits = gentle(STRONG if rng.random() < 0.7 else WEAK)
    if rng.random() < 0.5:
        return limits
    free_acceleration = planner_id in ('time_optimal', *ALONG_PATHS)
    sizes = {'max_velocity': [1e-2, 0.3, 1.0, 1.0, 1e3, np.inf],
             'max_acceleration': [1e-2, 1.0, 1.0, 5.0, 50.0] + [np.inf] * free_acceleration,
             'max_jerk': [1e-1, 10.0, 100.0, 1e5, np.inf]}
    return replace(limits, **{
        name: rng.choice(values, 3) if rng.random() < 0.5 else np.full(3, rng.choice(values))
        for name, values in sizes.items()}, max_effort=(
            NONE if planner_id not in ('time_optimal', *ALONG_PATHS)
            and rng.random() < 0.2 else limits.max_effort))
