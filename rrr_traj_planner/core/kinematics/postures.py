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
The named branches of the inverse kinematics: elbow up or down, shoulder front or back.

They are the signs of the two factors of the Jacobian's determinant (`branch_factors`); an arm
whose determinant has no such factors has no named postures. Thesis (5.8)-(5.12) for its arm.
"""

from __future__ import annotations

from typing import Literal, NamedTuple

import numpy as np
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.core.kinematics.axis_frame import axis_frame
from rrr_traj_planner.core.kinematics.branch_factors import branch_factors, has_named_postures
from rrr_traj_planner.core.kinematics.forward import forward_kinematics

ROUNDING = 1e-9  # part of a factor's scale up to which it is none; chosen

# The same where two solutions coincide, which are known to half the digits: for positions known to
# 1e-14 of the arm's size, 5e-7. Chosen.
DOUBLE_ROOT = 1e-6

Elbow = Literal['up', 'down']
Shoulder = Literal['front', 'back']
ELBOWS: tuple[Elbow, Elbow] = ('up', 'down')
SHOULDERS: tuple[Shoulder, Shoulder] = ('front', 'back')


class Posture(NamedTuple):
    """
    A branch of the inverse kinematics, or what is asked of one.

    Parameters
    ----------
    elbow : {'up', 'down'}, optional
        None: either. Up: with the shoulder at the front, the elbow is above the line from shoulder
        to tip, towards the upper end of joint axis 1 (`elbow_sign`; of the thesis's arm, theta_3
        within a right angle of 0). With the shoulder at the back it is below that line.
    shoulder : {'front', 'back'}, optional
        Front where the tip is on that side of joint axis 1 on which it is with all joints at zero,
        back where the arm reaches over its shoulder. None: either.

    """

    elbow: Elbow | None = None
    shoulder: Shoulder | None = None

    def __str__(self) -> str:
        """Return the posture for an error's message."""
        return ', '.join(
            f'{kind} {name}' for kind, name in zip(self._fields, self) if name is not None)

    def includes(self, other: Posture | None) -> bool:
        """
        Return whether another posture is one of those asked for.

        Parameters
        ----------
        other : Posture, optional
            None: without a name.

        Returns
        -------
        bool
            False where a name is asked for that the other does not have.

        """
        return all(asked is None or (other is not None and asked == name)
                   for asked, name in zip(self, other or self))


ANY_POSTURE = Posture()
ALL_POSTURES = tuple(Posture(elbow, shoulder) for shoulder in SHOULDERS for elbow in ELBOWS)


def posture_of(model: RobotModel, q: Array) -> Posture | None:
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
    Posture or None
        None where the arm's postures have no names. At a singular position, up rather than down
        and front rather than back.

    """
    if not has_named_postures(model):
        return None
    (elbow, shoulder), (no_elbow, no_shoulder) = _relative_factors(model, q)
    return Posture(ELBOWS[0 if elbow >= -no_elbow else 1],
                   SHOULDERS[0 if shoulder >= -no_shoulder else 1])


def in_posture(model: RobotModel, q: Array, posture: Posture) -> BoolArray:
    """
    Return which joint positions are in a posture.

    Parameters
    ----------
    model : RobotModel
        The arm.
    q : ndarray, shape (n, 3)
        Joint positions [rad].
    posture : Posture
        What is asked for.

    Returns
    -------
    ndarray of bool, shape (n,)
        All where nothing is asked for; none where the arm's postures have no names. Positions
        where postures meet are in both.

    """
    if posture == ANY_POSTURE:
        return np.ones(len(q), dtype=bool)
    if not has_named_postures(model):
        return np.zeros(len(q), dtype=bool)
    fits = np.ones(len(q), dtype=bool)
    for factor, none, asked, names in zip(
            *_relative_factors(model, q), posture, (ELBOWS, SHOULDERS)):
        if asked is not None:
            fits &= (factor if asked == names[0] else -factor) >= -none
    return fits


def postures_near(model: RobotModel, q: Array, tolerance: float) -> list[Posture]:
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
        Part of their scales up to which factors of the determinant count as zero.

    Returns
    -------
    list of Posture
        The posture of the positions themselves first; none where postures have no names.

    """
    own = posture_of(model, q)
    if own is None:
        return []
    near = [bool(abs(float(factor)) <= tolerance) for factor in _relative_factors(model, q)[0]]
    others = [p for p in ALL_POSTURES if p != own and all(
        meets or a == b for meets, a, b in zip(near, p, own))]
    return [own, *others]


def _relative_factors(model: RobotModel, q: Array) -> tuple[tuple[Array, ...], tuple[Array, ...]]:
    """
    Return the factors over their scales, and the tolerance within which each counts as zero.

    Their scales are a product of two links' lengths, and the reach. Two solutions coincide where
    the elbow's factor is zero; where the shoulder's is, only if the tip is beside joint axis 1. On
    the axis they are half a turn apart.
    """
    elbow, shoulder = branch_factors(model, q)
    frame, size = axis_frame(model), model.chain.size
    x, y, _ = np.moveaxis(frame.coordinates(forward_kinematics(model, q)), -1, 0)
    beside = np.sqrt(np.maximum(x * x + y * y - shoulder ** 2, 0.0)) / size
    return (elbow / (0.5 * size) ** 2, shoulder / size), (
        np.array(DOUBLE_ROOT), np.maximum(ROUNDING, DOUBLE_ROOT * np.sqrt(beside)))
