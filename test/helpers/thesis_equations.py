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

tau = M(q) qdd + C(q, qd) qd + g(q), equation 5.39, where the thesis writes H for the inertia
matrix M and h for the Coriolis and centrifugal torques C qd. Every function takes joint values one
by one: floats (the simulation's inner loop) or arrays of one shape (whole trajectories).
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Any, NamedTuple

from helpers.thesis_arm import ThesisArm


class Constants(NamedTuple):
    """Combinations of lengths, masses and inertias that the equations are made of."""

    a2: float
    l3: float
    m3: float
    base_inertia: float      # I1y + I2x + I3z
    upper_inertia: float     # I2y + m2 l2^2 - I2x, times c2^2 in M11
    fore_inertia: float      # I3x - I3z, times s23^2 in M11
    shoulder_inertia: float  # M22 without its s3 term
    elbow_inertia: float     # M33
    coupling: float          # m3 a2 l3
    upper_weight: float      # (m2 l2 + m3 a2) g
    fore_weight: float       # m3 l3 g


class Terms(NamedTuple):
    """Elements and derivatives of M, and g, at one pose (floats) or many (arrays)."""

    M11: Any
    M22: Any
    M23: Any
    M33: Any
    dM11_dq2: Any
    dM11_dq3: Any
    dM23_dq3: Any  # m3 a2 l3 c3, half of dM22 / dq3
    g2: Any
    g3: Any


@lru_cache(maxsize=16)  # as costly as the rest of one evaluation; a model never changes
def constants(model: ThesisArm) -> Constants:
    """
    Return the constants of an arm's equations of motion.

    Parameters
    ----------
    model : ThesisArm
        The arm.

    Returns
    -------
    Constants
        In SI units.

    """
    (_, m2, m3), (I1, I2, I3) = model.mass.tolist(), model.inertia.tolist()
    a2, l2, l3, g = model.a2, model.l2, model.l3, model.g
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
    Return the terms of M, C and g (5.40-5.54 in their corrected form).

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
    half_dM11_dq3 = (fore + m3r * k.l3) * c23
    coupling_s3 = k.coupling * s3
    M11 = k.base_inertia + k.upper_inertia * c2 * c2 + fore * s23 + m3r * r
    M22 = k.shoulder_inertia + 2.0 * coupling_s3
    M23 = k.elbow_inertia + coupling_s3
    dM11_dq2 = 2.0 * (half_dM11_dq3 - (k.upper_inertia * c2 + m3r * k.a2) * s2)
    dM23_dq3 = k.coupling * c3
    g3 = k.fore_weight * s23
    g2 = k.upper_weight * c2 + g3
    # By position: keyword arguments would add two fifths to the time of this function.
    return Terms(M11, M22, M23, k.elbow_inertia, dM11_dq2, 2.0 * half_dM11_dq3, dM23_dq3, g2, g3)


def coriolis_torques(t: Terms, qd1: Any, qd2: Any, qd3: Any) -> tuple[Any, Any, Any]:
    """
    Return C(q, qd) qd, the Coriolis and centrifugal torques (5.49-5.51 corrected).

    Parameters
    ----------
    t : Terms
        At the pose.
    qd1, qd2, qd3 : float or ndarray
        Joint velocities [rad/s].

    Returns
    -------
    tuple
        Of the three joints [N m].

    """
    half_qd1_squared = 0.5 * qd1 * qd1
    return ((t.dM11_dq2 * qd2 + t.dM11_dq3 * qd3) * qd1,
            t.dM23_dq3 * qd3 * (qd3 + 2.0 * qd2) - t.dM11_dq2 * half_qd1_squared,
            -t.dM11_dq3 * half_qd1_squared - t.dM23_dq3 * qd2 * qd2)


def torques(t: Terms, qd1: Any, qd2: Any, qd3: Any, qdd1: Any, qdd2: Any,
            qdd3: Any) -> tuple[Any, Any, Any]:
    """
    Return the joint torques of a motion: inverse dynamics (5.39).

    Parameters
    ----------
    t : Terms
        At the pose.
    qd1, qd2, qd3 : float or ndarray
        Joint velocities [rad/s].
    qdd1, qdd2, qdd3 : float or ndarray
        Joint accelerations [rad/s^2].

    Returns
    -------
    tuple
        tau1, tau2, tau3 [N m].

    """
    C1, C2, C3 = coriolis_torques(t, qd1, qd2, qd3)
    return (t.M11 * qdd1 + C1,
            t.M22 * qdd2 + t.M23 * qdd3 + C2 + t.g2,
            t.M23 * qdd2 + t.M33 * qdd3 + C3 + t.g3)


def accelerations(t: Terms, qd1: Any, qd2: Any, qd3: Any, tau1: Any, tau2: Any,
                  tau3: Any) -> tuple[Any, Any, Any]:
    """
    Return the joint accelerations that torques cause: forward dynamics (5.39 solved for qdd).

    Parameters
    ----------
    t : Terms
        At the pose.
    qd1, qd2, qd3 : float or ndarray
        Joint velocities [rad/s].
    tau1, tau2, tau3 : float or ndarray
        Joint torques [N m].

    Returns
    -------
    tuple
        Accelerations of the three joints [rad/s^2].

    """
    C1, C2, C3 = coriolis_torques(t, qd1, qd2, qd3)
    b2, b3 = tau2 - C2 - t.g2, tau3 - C3 - t.g3
    det = t.M22 * t.M33 - t.M23 * t.M23
    return ((tau1 - C1) / t.M11,
            (t.M33 * b2 - t.M23 * b3) / det,
            (t.M22 * b3 - t.M23 * b2) / det)
