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

"""Kinematics of the arm from table 5.1's matrices, and its rates by differentiation."""

from helpers.comparison import rate
from helpers.random_cases import central_difference
import numpy as np

STEP = 1e-3  # s, step of differences in time


def denavit_hartenberg(theta, a, d, alpha):
    """Return Rz(theta) Tz(d) Tx(a) Rx(alpha): 5.2 with its translation; theta may be complex."""
    c, s, ca, sa = np.cos(theta), np.sin(theta), round(np.cos(alpha)), round(np.sin(alpha))
    return np.array([[c, -s * ca, s * sa, a * c],
                     [s, c * ca, -c * sa, a * s],
                     [0.0, sa, ca, d],
                     [0.0, 0.0, 0.0, 1.0]])


def frames(arm, q):
    """Return the homogeneous transformations of frames 1 to 3, frame 3 at joint axis 3."""
    first = denavit_hartenberg(q[0], 0.0, arm.d1, np.pi / 2)
    second = first @ denavit_hartenberg(q[1], arm.a2, 0.0, 0.0)
    return first, second, second @ denavit_hartenberg(q[2], 0.0, 0.0, np.pi / 2)


def rotation(arm, q, link):
    """Return the rotation of a link's frame in the base frame."""
    return frames(arm, q)[link - 1][:3, :3]


def elbow(arm, q):
    """Return the position of joint axis 3."""
    return frames(arm, q)[1][:3, 3]


def tip(arm, q):
    """Return the tip's position, d4 along z3."""
    return (frames(arm, q)[2] @ (0.0, 0.0, arm.d4, 1.0))[:3]


def centre_of_mass(arm, q, link):
    """Return the position of the centre of mass of link 2 or 3."""
    if link == 2:
        return (frames(arm, q)[0] @ denavit_hartenberg(q[1], arm.l2, 0.0, 0.0))[:3, 3]
    return (frames(arm, q)[2] @ (0.0, 0.0, arm.l3, 1.0))[:3]


def angular_velocity(arm, q, qd, link):
    """Return a link's angular velocity in its own frame: the vector of R^T dR/dt."""
    R = rotation(arm, q, link)
    W = R.T @ rate(lambda x: rotation(arm, x, link), q, qd)
    return np.array([W[2, 1], W[0, 2], W[1, 0]])


def second_rate(first_rate, q, qd, qdd):
    """Return the derivative in time of a rate (q, qd) -> values along a motion."""
    return central_difference(
        lambda t: first_rate(q + t * qd + 0.5 * t * t * qdd, qd + t * qdd), 0.0, STEP)
