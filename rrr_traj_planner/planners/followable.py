"""Limits on jerk that let samples follow a motion, where nothing else bounds it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.dynamics import gravity_torque, inertia_matrix
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.limits import JointLimits
from rrr_traj_planner.core.model import RobotModel

# Samples that a full swing of acceleration lasts; more where the acceleration that a controller
# rebuilds from them must keep a limit.
SAMPLES, SAMPLES_OF_LIMITED = 2.0, 4.0


def followable(model: RobotModel, limits: JointLimits, q: Array,
               sample_period: float) -> JointLimits:
    """
    Return limits whose jerk keeps changes of acceleration so long that samples can follow them.

    Parameters
    ----------
    model : RobotModel
        The arm.
    limits : JointLimits
        Its limits.
    q : ndarray, shape (n, 3)
        Poses on the way [rad].
    sample_period : float
        [s].

    Returns
    -------
    JointLimits
        With finite jerk limits.

    Raises
    ------
    InvalidInputError
        If a joint has neither an acceleration nor an effort limit.

    """
    samples = np.where(np.isinf(limits.max_acceleration), SAMPLES, SAMPLES_OF_LIMITED)
    jerk = np.pi * acceleration_scale(model, limits, q) / (samples * sample_period)
    return replace(limits, max_jerk=np.minimum(limits.max_jerk, jerk))


def acceleration_scale(model: RobotModel, limits: JointLimits, q: Array) -> Array:
    """
    Return the acceleration that each joint can have, by its limit or by its torque.

    Parameters
    ----------
    model : RobotModel
        The arm.
    limits : JointLimits
        Its limits.
    q : ndarray, shape (n, 3)
        Poses on the way [rad].

    Returns
    -------
    ndarray, shape (3,)
        [rad/s^2].

    Raises
    ------
    InvalidInputError
        If a joint has neither an acceleration nor an effort limit.

    """
    lacking = np.isinf(limits.max_acceleration) & np.isinf(limits.max_effort)
    if lacking.any():
        raise InvalidInputError(
            'the fastest motion needs an acceleration or an effort limit on every joint, '
            f'{model.joint_names[int(lacking.argmax())]} has neither')
    inertia = np.diagonal(inertia_matrix(model, q), axis1=1, axis2=2)
    torque = limits.max_effort + np.abs(gravity_torque(model, q))
    return np.asarray(np.minimum(limits.max_acceleration, (torque / inertia).max(axis=0)))
