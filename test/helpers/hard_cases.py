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

"""Tasks that were once hard to plan: joint positions [rad] and unusual limits, by name."""

import numpy as np


def _smooth_points(n):
    """Return n points close together on a smooth curve through joint space."""
    s = np.linspace(0.0, 2.0 * np.pi, n)
    return np.stack((0.8 + 0.5 * np.sin(s), 1.5 + 0.3 * np.cos(2.0 * s), 0.3 * np.sin(3.0 * s)),
                    axis=1)


# name: joint positions, and limits that differ from the thesis arm's.
HARD_CASES = {
    '80 points close together, smooth': (_smooth_points(80), {}),
    '40 points close together, tight jerk limit': (
        _smooth_points(40), {'max_jerk': [2.0, 2.0, 2.0]}),
    'steps of a microradian between large ones': (
        [[0.3, 1.4, 0.0], [1.0, 1.8, 0.3], [1.0, 1.8 + 1e-6, 0.3], [0.4, 1.5, -0.4]], {}),
    'one joint moves alone, there and back': (
        [[0.5, 1.6, 0.2], [0.5, 1.6, 0.9], [0.5, 1.6, 0.2], [0.5, 1.6, 0.9]], {}),
    'corner of the joint ranges': (
        [[0.3, 1.4, 0.0], [0.0, 2.0, 0.2], [np.pi / 2, 1.5, -0.3], [0.2, 1.3, 0.1]], {}),
    'limits of very different sizes': (
        [[0.3, 1.4, 0.0], [1.0, 1.8, 0.3], [0.2, 1.3, -0.5]],
        {'max_velocity': [0.01, 5.0, np.inf], 'max_acceleration': [10.0, 0.1, 1.0]}),
    'torque all but used up by gravity': (
        [[0.3, 1.4, 0.0], [1.0, 1.2, 0.1], [0.2, 1.5, -0.2]],
        {'max_effort': [150.0, 123.8, 200.0]}),
}

# Infeasible for approach (a), which continues beyond a via point in the direction of arrival: the
# range ends there, or gravity is too large.
NOT_FOR_APPROACH_A = ('corner of the joint ranges', 'torque all but used up by gravity')
