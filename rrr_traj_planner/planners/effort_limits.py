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
Effort limits as the planners use them.

They are dropped where the torque is undefined, and reduced by Coulomb friction.
"""

from __future__ import annotations

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.errors import format_distinct, LimitViolationError


def torque_note(model: RobotModel, limits: JointLimits) -> str:
    """
    Return the note on effort limits that mean nothing; usually empty.

    Parameters
    ----------
    model : RobotModel
        The arm.
    limits : JointLimits
        Its limits.

    Returns
    -------
    str
        For the plan.

    """
    if model.has_inertia or np.isinf(limits.max_effort).all():
        return ''
    return 'torque is not checked: no link has a mass'


def check_friction(model: RobotModel, limits: JointLimits) -> None:
    """
    Refuse effort limits that Coulomb friction reaches: such a joint could not be moved.

    Parameters
    ----------
    model : RobotModel
        The arm.
    limits : JointLimits
        Its limits.

    Raises
    ------
    LimitViolationError
        If one leaves no torque for motion; with joint, limit and friction.

    """
    coulomb = model.friction.coulomb
    for j in np.flatnonzero(coulomb >= limits.max_effort).tolist():
        least, most = format_distinct(float(coulomb[j]), float(limits.max_effort[j]))
        raise LimitViolationError(
            f'{model.joint_names[j]} has a Coulomb friction of {least} N m, limit {most} N m, '
            'which leaves no torque for motion', model.joint_names[j], float(coulomb[j]),
            float(limits.max_effort[j]))


def effort_less_friction(model: RobotModel, limits: JointLimits) -> Array:
    """
    Return effort limits less Coulomb friction, which is then left out of torques.

    Torque without it is smooth, as optimisation needs; lower limits are safe in both directions.

    Parameters
    ----------
    model : RobotModel
        The arm.
    limits : JointLimits
        Its limits.

    Returns
    -------
    ndarray, shape (3,)
        Positive [N m], infinite where there is none.

    Raises
    ------
    LimitViolationError
        If one would not be positive; with joint, limit and friction.

    """
    check_friction(model, limits)
    return np.asarray(limits.max_effort - model.friction.coulomb)
