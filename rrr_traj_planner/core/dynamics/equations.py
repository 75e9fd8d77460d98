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
The thesis's equations of motion, corrected, written once for floats and for arrays.

tau = H(q) qdd + h(q, qd) + g(q), equation 5.39. Every function takes joint values one by one;
they may be floats (the simulation's inner loop) or arrays of one shape (whole trajectories).
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Any, NamedTuple

from rrr_traj_planner.core.arm.model import RobotModel


class Constants(NamedTuple):
    """Combinations of lengths, masses and inertias that the equations are made of."""

    a2: float
    l3: float
    m3: float
    base_inertia: float      # I1y + I2x + I3z
    upper_inertia: float     # I2y + m2 l2^2 - I2x, times c2^2 in H11
    fore_inertia: float      # I3x - I3z, times s23^2 in H11
    shoulder_inertia: float  # H22 without its s3 term
    elbow_inertia: float     # H33
    coupling: float          # m3 a2 l3
    upper_weight: float      # (m2 l2 + m3 a2) g
    fore_weight: float       # m3 l3 g


class Terms(NamedTuple):
    """What H, h and g are made of, at one pose (floats) or many (arrays)."""

    H11: Any
    H22: Any
    H23: Any
    H33: Any
    D2: Any   # dH11 / dtheta2
    D3: Any   # dH11 / dtheta3
    bc3: Any  # m3 a2 l3 c3
    g2: Any
    g3: Any


@lru_cache(maxsize=16)  # they take as long as all else of one state; a model never changes
def constants(model: RobotModel) -> Constants:
    """
    Return the constants of an arm's equations of motion.

    Parameters
    ----------
    model : RobotModel
        The arm.

    Returns
    -------
    Constants
        In SI units.

    """
    (_, m2, m3), (I1, I2, I3) = model.mass.tolist(), model.inertia.tolist()
    a2, l2, l3, g = model.a2, model.l2, model.l3, model.gravity
    return Constants(
        a2=a2, l3=l3, m3=m3,
        base_inertia=I1[1] + I2[0] + I3[2],
        upper_inertia=I2[1] + m2 * l2 ** 2 - I2[0],
        fore_inertia=I3[0] - I3[2],
        shoulder_inertia=I2[2] + I3[1] + m2 * l2 ** 2 + m3 * (a2 ** 2 + l3 ** 2),
        elbow_inertia=I3[1] + m3 * l3 ** 2,
        coupling=m3 * a2 * l3,
        upper_weight=(m2 * l2 + m3 * a2) * g,
        fore_weight=m3 * l3 * g)


def terms(k: Constants, q2: Any, q3: Any, sin: Callable[[Any], Any],
          cos: Callable[[Any], Any]) -> Terms:
    """
    Return the terms of H, h and g (5.40-5.54 in their corrected form).

    Parameters
    ----------
    k : Constants
        The arm's constants.
    q2, q3 : float or ndarray
        Positions of joints 2 and 3 [rad].
    sin, cos : callable
        `math`'s for floats, numpy's for arrays.

    Returns
    -------
    Terms
        Inertias [kg m^2], their derivatives [kg m^2/rad], gravity torques [N m].

    """
    s2, c2 = sin(q2), cos(q2)
    s3, c3 = sin(q3), cos(q3)
    s23, c23 = s2 * c3 + c2 * s3, c2 * c3 - s2 * s3
    r = k.l3 * s23 + k.a2 * c2  # distance of link 3's centre of mass from joint axis 1
    m3r = k.m3 * r
    fore = k.fore_inertia * s23
    half_D3 = (fore + m3r * k.l3) * c23
    bs3 = k.coupling * s3
    H11 = k.base_inertia + k.upper_inertia * c2 * c2 + fore * s23 + m3r * r
    H22 = k.shoulder_inertia + 2.0 * bs3
    H23 = k.elbow_inertia + bs3
    D2 = 2.0 * (half_D3 - (k.upper_inertia * c2 + m3r * k.a2) * s2)
    bc3 = k.coupling * c3
    g3 = k.fore_weight * s23
    g2 = k.upper_weight * c2 + g3
    # In the order of the fields: their names would add two fifths to the time of all this.
    return Terms(H11, H22, H23, k.elbow_inertia, D2, 2.0 * half_D3, bc3, g2, g3)


def velocity_torques(t: Terms, w1: Any, w2: Any, w3: Any) -> tuple[Any, Any, Any]:
    """
    Return h, the Coriolis and centrifugal torques (5.49-5.51 corrected).

    Parameters
    ----------
    t : Terms
        At the pose.
    w1, w2, w3 : float or ndarray
        Joint velocities [rad/s].

    Returns
    -------
    tuple
        h1, h2, h3 [N m].

    """
    half_w1_squared = 0.5 * w1 * w1
    return ((t.D2 * w2 + t.D3 * w3) * w1,
            t.bc3 * w3 * (w3 + 2.0 * w2) - t.D2 * half_w1_squared,
            -t.D3 * half_w1_squared - t.bc3 * w2 * w2)


def torques(t: Terms, w1: Any, w2: Any, w3: Any, a1: Any, a2: Any,
            a3: Any) -> tuple[Any, Any, Any]:
    """
    Return the joint torques of a motion (5.39).

    Parameters
    ----------
    t : Terms
        At the pose.
    w1, w2, w3 : float or ndarray
        Joint velocities [rad/s].
    a1, a2, a3 : float or ndarray
        Joint accelerations [rad/s^2].

    Returns
    -------
    tuple
        tau1, tau2, tau3 [N m].

    """
    h1, h2, h3 = velocity_torques(t, w1, w2, w3)
    return (t.H11 * a1 + h1,
            t.H22 * a2 + t.H23 * a3 + h2 + t.g2,
            t.H23 * a2 + t.H33 * a3 + h3 + t.g3)


def accelerations(t: Terms, w1: Any, w2: Any, w3: Any, tau1: Any, tau2: Any,
                  tau3: Any) -> tuple[Any, Any, Any]:
    """
    Return the joint accelerations that torques cause (5.39 solved for qdd).

    Parameters
    ----------
    t : Terms
        At the pose.
    w1, w2, w3 : float or ndarray
        Joint velocities [rad/s].
    tau1, tau2, tau3 : float or ndarray
        Joint torques [N m].

    Returns
    -------
    tuple
        Accelerations of the three joints [rad/s^2].

    """
    h1, h2, h3 = velocity_torques(t, w1, w2, w3)
    b2, b3 = tau2 - h2 - t.g2, tau3 - h3 - t.g3
    det = t.H22 * t.H33 - t.H23 * t.H23
    return ((tau1 - h1) / t.H11,
            (t.H33 * b2 - t.H23 * b3) / det,
            (t.H22 * b3 - t.H23 * b2) / det)
