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
The four branches of the inverse kinematics: elbow up or down, shoulder front or back.

Thesis (5.8)-(5.12).
"""

from __future__ import annotations

from typing import Literal, NamedTuple

import numpy as np
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.kinematics.forward import radial_distance
from rrr_traj_planner.core.rounding import TIP_ROUNDING

Elbow = Literal['up', 'down']
Shoulder = Literal['front', 'back']
ELBOWS: tuple[Elbow, Elbow] = ('up', 'down')
SHOULDERS: tuple[Shoulder, Shoulder] = ('front', 'back')


class Posture(NamedTuple):
    """
    A branch of the inverse kinematics.

    Parameters
    ----------
    elbow : {'up', 'down'}
        By the sign of cos theta_3 (5.10): up where theta_3 is within a right angle of 0. With
        the shoulder at the front, the elbow is then above the line from shoulder to tip.
    shoulder : {'front', 'back'}
        Front where joint 1 turns the arm's plane towards the tip, back where the arm reaches
        over its shoulder: joint 1 is half a turn away.

    """

    elbow: Elbow = 'up'
    shoulder: Shoulder = 'front'

    def __str__(self) -> str:
        """Return the posture for an error's message."""
        return f'elbow {self.elbow}' + (', shoulder back' if self.shoulder == 'back' else '')


def elbow_angles(model: RobotModel, distance: Array, elbow: Elbow) -> tuple[Array, Array]:
    """
    Return the angles of the triangle of shoulder, elbow and tip (5.9, 5.11).

    Half-angle and tangent forms: accurate at the workspace's edges too.

    Parameters
    ----------
    model : RobotModel
        The arm.
    distance : ndarray
        Of the tip from the shoulder, within reach [m].
    elbow : {'up', 'down'}
        The branch.

    Returns
    -------
    shoulder : ndarray
        From the direction of the tip to that of link 2 [rad].
    theta_3 : ndarray
        Position of joint 3, in [-pi/2, 3 pi/2] [rad].

    """
    (least, most), W = model.reach, distance
    gamma = 2.0 * np.arctan2(np.sqrt((W - least) * (W + least)), np.sqrt((most - W) * (most + W)))
    beta = np.arctan2(model.d4 * np.sin(gamma), model.a2 - model.d4 * np.cos(gamma))
    return (beta, gamma - 0.5 * np.pi) if elbow == 'up' else (-beta, 1.5 * np.pi - gamma)


def posture_of(model: RobotModel, q: Array) -> Posture:
    """
    Return the posture of joint positions.

    Parameters
    ----------
    model : RobotModel
        The arm.
    q : ndarray, shape (3,)
        Joint positions [rad].

    Returns
    -------
    Posture
        At a singular position, up rather than down and front rather than back.

    """
    return postures_of(model, q, 0.0)[0]


def postures_of(model: RobotModel, q: Array, tolerance: float) -> list[Posture]:
    """
    Return the posture of joint positions, and others within a tolerance.

    Postures meet where the arm is stretched or folded, and where the tip is on joint axis 1.

    Parameters
    ----------
    model : RobotModel
        The arm.
    q : ndarray, shape (3,)
        Joint positions [rad].
    tolerance : float
        Distance of joint 3 from the angle at which elbow up and down meet [rad]; times the arm's
        reach, distance of the tip from joint axis 1 [m].

    Returns
    -------
    list of Posture
        The posture of the positions themselves first.

    """
    cosine, r = float(np.cos(q[2])), float(radial_distance(model, q))
    elbows = ELBOWS if cosine >= 0.0 else ELBOWS[::-1]
    shoulders = SHOULDERS if r >= -TIP_ROUNDING else SHOULDERS[::-1]
    return [Posture(elbow, shoulder)
            for shoulder in shoulders[:2 if abs(r) <= tolerance * model.reach[1] else 1]
            for elbow in elbows[:2 if abs(cosine) <= tolerance else 1]]
