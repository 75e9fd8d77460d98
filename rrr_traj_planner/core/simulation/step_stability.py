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
The longest integration step that is stable and accurate with viscous friction and bumpers.

Hairer and Wanner, Solving Ordinary Differential Equations II, section IV.2.
"""

from __future__ import annotations

from functools import lru_cache
from math import inf

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

# Integration steps of one physics step, at most; chosen: the arm still keeps up with the clock.
MOST_STEPS = 200


def longest_step(model: RobotModel, soft_stops: SoftStops) -> float:
    """
    Return the longest integration step.

    Parameters
    ----------
    model : RobotModel
        The arm with its payload, its inertia matrix regular in every pose.
    soft_stops : SoftStops
        Of all joints.

    Returns
    -------
    float
        The shortest time constant of viscous friction, or inverse frequency of a bumper, in any
        pose [s]; infinite where there is neither.

    """
    bumper = soft_stops.stiffness if soft_stops.width else 0.0
    return min(_shortest_time_constant(model), _shortest_period(model, bumper))


def check_step(model: RobotModel, soft_stops: SoftStops, step: float) -> None:
    """
    Refuse friction or bumpers that are too stiff for a physics step.

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
        If a physics step needs more than `MOST_STEPS` integration steps.

    """
    most = MOST_STEPS * _shortest_time_constant(model)
    if step > most:
        raise InvalidInputError(
            f'friction.viscous is {model.friction.viscous.tolist()} N m s/rad (of the URDF: '
            f'<dynamics damping>), too much for a physics_step of {step:g} s: at most '
            f'{format_distinct(most / step, 1.0, digits=3)[0]} times that')
    bumper = soft_stops.stiffness if soft_stops.width else 0.0
    most = MOST_STEPS * _shortest_period(model, bumper)
    if step > most:
        stiffness, largest = format_distinct(bumper, bumper * (most / step) ** 2, digits=3)
        raise InvalidInputError(
            f'soft_stops.stiffness is {stiffness} N m/rad, must be at most {largest} N m/rad with '
            f'a physics_step of {step:g} s')


@lru_cache(maxsize=16)
def _shortest_time_constant(model: RobotModel) -> float:
    viscous = model.friction.viscous
    if not viscous.any():
        return inf
    decay = float(np.abs(np.linalg.eigvals(_inverse_inertia(model) * viscous)).max())  # [1/s]
    return LARGEST / decay


def _shortest_period(model: RobotModel, bumper: float) -> float:
    return LARGEST / (_largest_mobility(model) * bumper) ** 0.5 if bumper else inf


@lru_cache(maxsize=16)
def _largest_mobility(model: RobotModel) -> float:
    """Return the largest eigenvalue of the inverse inertia matrix [1/(kg m^2)]."""
    return float(np.abs(np.linalg.eigvals(_inverse_inertia(model))).max())


def _inverse_inertia(model: RobotModel) -> Array:
    """Return the inverse inertia matrix on a grid of the joints on which it depends."""
    q2, q3 = (x.ravel() for x in np.meshgrid(ANGLES, ANGLES))
    return np.asarray(np.linalg.inv(
        inertia_matrix(model, np.column_stack((np.zeros_like(q2), q2, q3)))))
