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

"""The jerk limit due to sampling: a sampled motion must represent every change of acceleration."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.dynamics.rigid_body import gravity_torque, inertia_matrix
from rrr_traj_planner.core.errors import InvalidInputError

# Least number of samples in a reversal from full acceleration to full deceleration, chosen; more
# where the acceleration that a controller interpolates between them must keep a limit.
SAMPLES, SAMPLES_OF_LIMITED = 2.0, 4.0

# Least number of samples in a transition at full acceleration, so that a controller's quintics
# through them keep the limits; chosen.
SAMPLES_PER_TRANSITION = 5.0


# Part of the arm's largest inertia up to which a joint's is none: rounding of the tables. Chosen.
NO_INERTIA = 1e-12


def limits_for_sampling(limits: JointLimits, acceleration: Array,
                        sample_period: float) -> JointLimits:
    """
    Return limits with jerk bounded so that every change of acceleration lasts several samples.

    Parameters
    ----------
    limits : JointLimits
        The arm's.
    acceleration : ndarray, shape (3,)
        The largest of each joint, see `acceleration_scale` [rad/s^2].
    sample_period : float
        [s].

    Returns
    -------
    JointLimits
        With finite limits on jerk.

    """
    samples = np.where(np.isinf(limits.max_acceleration), SAMPLES, SAMPLES_OF_LIMITED)
    jerk = jerk_over_samples(np.pi, acceleration, samples, sample_period)
    if (limits.max_jerk <= jerk).all():
        return limits
    return replace(limits, max_jerk=np.minimum(limits.max_jerk, jerk))


def jerk_over_samples(peak_jerk: float, acceleration: Array, samples: Array | float,
                      sample_period: float) -> Array:
    """
    Return the peak jerk of a change of acceleration that lasts a number of samples.

    Parameters
    ----------
    peak_jerk : float
        Of the change, for unit acceleration and unit duration.
    acceleration : ndarray, shape (3,)
        Its peak [rad/s^2].
    samples : ndarray, shape (3,), or float
        Its duration in sample periods.
    sample_period : float
        [s].

    Returns
    -------
    ndarray, shape (3,)
        [rad/s^3].

    """
    return np.asarray(peak_jerk * acceleration / (samples * sample_period))


def acceleration_scale(model: RobotModel, limits: JointLimits, q: Array) -> Array:
    """
    Return the largest acceleration of each joint, by its limit or by its torque and inertia.

    Parameters
    ----------
    model : RobotModel
        The arm.
    limits : JointLimits
        Its limits.
    q : ndarray, shape (n, 3)
        Poses along the motion [rad].

    Returns
    -------
    ndarray, shape (3,)
        [rad/s^2].

    Raises
    ------
    InvalidInputError
        If a joint has neither an acceleration nor an effort limit.

    """
    inertia = np.diagonal(inertia_matrix(model, q), axis1=1, axis2=2)
    torque = limits.max_effort + np.abs(gravity_torque(model, q))
    is_none = inertia <= NO_INERTIA * inertia.max()
    by_torque = np.where(is_none, np.inf, torque / np.where(is_none, 1.0, inertia)).max(axis=0)
    scale = np.minimum(limits.max_acceleration, by_torque)
    if np.isinf(scale).any():
        j = int(np.isinf(scale).argmax())
        raise InvalidInputError(
            'the fastest motion needs an acceleration or an effort limit on every joint, '
            f'{model.joint_names[j]} has ' + (
                'neither' if np.isinf(limits.max_effort[j]) else
                'an effort limit only, and no inertia in some pose'))
    return np.asarray(scale)
