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
Stability of the integration step with viscous friction and bumpers.

Hairer and Wanner, Solving Ordinary Differential Equations II, section IV.2.
"""

from __future__ import annotations

import numpy as np
from rrr_traj_planner.core.arm.inertia_check import ANGLES
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.dynamics.rigid_body import inertia_matrix
from rrr_traj_planner.core.errors import format_distinct, InvalidInputError
from rrr_traj_planner.core.simulation.soft_stops import SoftStops

# Step times decay rate, or times angular frequency. The method is stable up to 2.8 (for a decay as
# the classical Runge-Kutta method) and accurate up to 1.
LARGEST = 1.0


def check_step(model: RobotModel, soft_stops: SoftStops, step: float) -> None:
    """
    Refuse friction or bumpers that are too stiff for a time step.

    Parameters
    ----------
    model : RobotModel
        The arm with its payload, its inertia matrix regular in every pose.
    soft_stops : SoftStops
        Of all joints.
    step : float
        [s].

    Raises
    ------
    InvalidInputError
        If the time constant of viscous friction, or the inverse frequency of a bumper, is shorter
        than a step in some pose.

    """
    friction = model.friction
    bumper = soft_stops.stiffness if soft_stops.width else 0.0
    if not friction.viscous.any() and not bumper:
        return
    inverse = np.linalg.inv(inertia_matrix(model, _poses()))
    decay = float(np.abs(np.linalg.eigvals(inverse * friction.viscous)).max())  # [1/s]
    if decay * step > LARGEST:
        raise InvalidInputError(
            f'friction.viscous is {friction.viscous.tolist()} N m s/rad, too much for '
            f'a physics step of {step:g} s: at most '
            f'{format_distinct(LARGEST / (decay * step), 1.0, digits=3)[0]} times that')
    squared = float(np.abs(np.linalg.eigvals(inverse)).max()) * bumper  # [1/s^2]
    if squared * step ** 2 > LARGEST:
        stiffness, most = format_distinct(
            bumper, bumper * LARGEST / (squared * step ** 2), digits=3)
        raise InvalidInputError(
            f'soft_stops.stiffness is {stiffness} N m/rad, must be at most {most} N m/rad with '
            f'a physics step of {step:g} s')


def _poses() -> Array:
    """Return a grid of the joints on which inertia depends, shape (n, 3)."""
    q2, q3 = (x.ravel() for x in np.meshgrid(ANGLES, ANGLES))
    return np.column_stack((np.zeros_like(q2), q2, q3))
