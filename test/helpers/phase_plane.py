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

"""Least time along a path by the phase-plane method, with velocity and acceleration limits."""

from __future__ import annotations

import numpy as np

INTERVALS = 600
HALVINGS = 45


def least_time(arm_path, limits, max_tip_speed=np.inf):
    """
    Return the least time along a path, acceleration free to jump [s].

    In the plane of place and squared speed x, whose slope is twice the acceleration: a backward
    pass finds the largest x from which rest at the end can be reached, a forward pass speeds up
    as hard as it can below that.
    """
    ends = np.unique(np.concatenate((arm_path.path.via_s, arm_path.path.joins)))
    s = np.union1d(np.linspace(0.0, arm_path.path.length, INTERVALS + 1), ends)
    _, dq, ddq, _ = arm_path(0.5 * (s[1:] + s[:-1]))  # each interval has its middle's limits
    step = 2.0 * np.diff(s)
    A = limits.max_acceleration
    most = np.minimum((limits.max_velocity / np.maximum(np.abs(dq), 1e-12)).min(axis=1),
                      max_tip_speed) ** 2

    def slopes(i, x):
        """Return the least and the largest acceleration along the path."""
        with np.errstate(divide='ignore'):
            a, b = (-A - ddq[i] * x) / dq[i], (A - ddq[i] * x) / dq[i]
        return np.minimum(a, b).max(), np.maximum(a, b).min()

    reachable = np.zeros(len(s))
    for i in range(len(step) - 1, -1, -1):
        def fits(x, i=i):
            low, high = slopes(i, x)
            return max(low, -x / step[i]) <= min(high, (reachable[i + 1] - x) / step[i])

        low, high = 0.0, min(most[i], most[max(i - 1, 0)])
        for _ in range(0 if fits(high) else HALVINGS):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if fits(middle) else (low, middle)
        reachable[i] = high
    x = np.zeros(len(s))
    for i in range(len(step)):
        x[i + 1] = np.clip(x[i] + step[i] * slopes(i, x[i])[1], 0.0, reachable[i + 1])
    return float((step / (np.sqrt(x[:-1]) + np.sqrt(x[1:]))).sum())
