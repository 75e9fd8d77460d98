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

"""
The factors of the Jacobian's determinant whose signs name the branches of the inverse kinematics.

With the common normal n, of length a, from joint axis 1 to joint axis 2, s the sine of their
angle, r and y the tip's components along n and across it at q1 = 0, k its distance along joint
axis 2 and Q the square of its distance from the foot of the normal on that axis:

    det J = s r Q' / 2 + a k' y

with derivatives by q3. The second term is zero where joint axes 1 and 2 meet (a = 0), and where
joint axes 2 and 3 are parallel (k' = 0). The arm is then singular where r = 0, the tip above or
below joint axis 1, and where Q' = 0, the arm stretched or folded: r is the factor of the shoulder,
Q' / 2 that of the elbow. (Own derivation, from the columns of the Jacobian; tests compare it with
the determinant, the sign aside.)

With S the foot of the common normal on joint axis 2, E a point on joint axis 3, T the tip and z3
the direction of joint axis 3, Q' / 2 = z3 . ((T - S) x (E - S)): its sign says on which side of
the line from shoulder to tip the elbow is.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array, joint_values
from rrr_traj_planner.core.kinematics.common_normal import (
    CAD_ROUNDING,
    common_normal,
    front_sign,
    leading_sign,
)

# Part of the cube of the arm's size up to which the rest of the determinant counts as zero.
# Chosen, above the rounding of descriptions with seven digits.
REST = 1e-6


def branch_factors(model: RobotModel, q: ArrayLike) -> tuple[Array, Array]:
    """
    Return the factors of the elbow and of the shoulder.

    For the thesis's arm they are a2 d4 cos theta_3 and the radial distance.

    Parameters
    ----------
    model : RobotModel
        The arm; without named postures, the signs do not tell its branches.
    q : array_like, shape (..., 3)
        Joint positions [rad].

    Returns
    -------
    elbow : ndarray, shape (...)
        Q' / 2 or -Q' / 2 [m^2] (`elbow_sign`): up where it is positive.
    shoulder : ndarray, shape (...)
        r [m], or -r if r is negative with all joints at zero (`front_sign`): front where it is
        positive.

    Raises
    ------
    InvalidInputError
        If the shape is wrong, or a value not finite.

    """
    q, g = joint_values('q', q), common_normal(model)
    c3, s3 = np.cos(q[..., 2]), np.sin(q[..., 2])
    u, v = (f[0] + f[1] * c3 + f[2] * s3 for f in (g.u, g.v))
    r = g.a + u * np.cos(q[..., 1]) - v * np.sin(q[..., 1])
    elbow = 0.5 * elbow_sign(model) * (g.Q[2] * c3 - g.Q[1] * s3)
    return np.asarray(elbow), np.asarray(front_sign(model) * r)


@lru_cache(maxsize=16)
def elbow_sign(model: RobotModel) -> float:
    """
    Return the sign of Q' where the elbow is up: above the line from shoulder to tip.

    Above, with the tip at the front: towards the upper end of joint axis 1, which is the one with
    the larger z in the base frame, or larger x, then y, for a horizontal axis. The names do not
    depend on the signs of the description's axes.

    Parameters
    ----------
    model : RobotModel
        The arm.

    Returns
    -------
    float
        1 or -1.

    """
    z1, z2, z3 = model.chain.axis
    upwards = leading_sign(z1[[2, 0, 1]])
    along = float(z2 @ z3)
    # z2 and the normal of the plane of front and up are on one side of that plane or on opposite
    # ones: z2 . (n x z1) is the sine of the angle of joint axes 1 and 2, positive.
    if abs(along) <= CAD_ROUNDING:  # joint axes 2 and 3 at right angles: neither above nor below
        return leading_sign(z3)
    return float(np.sign(along)) * front_sign(model) * upwards


def has_named_postures(model: RobotModel) -> bool:
    """
    Return whether the signs of the two factors tell the arm's branches.

    Parameters
    ----------
    model : RobotModel
        The arm.

    Returns
    -------
    bool
        Whether the determinant is their product, times s or -s, but for `REST`.

    """
    g = common_normal(model)
    return bool(abs(g.a) * np.hypot(g.k[1], g.k[2]) <= REST * g.size ** 2)
