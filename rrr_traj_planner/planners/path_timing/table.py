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
Joint derivatives and dynamics along a path, tabulated in smooth pieces.

Torque along a path is m sdd + c sd^2 + g (Bobrow, Dubowsky & Gibson, Time-optimal control of
robotic manipulators along specified paths, IJRR 4, 1985), and viscous friction dq sd. Between the
table's positions all terms are cubic splines (de Boor, A Practical Guide to Splines).
"""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.dynamics.motor_torque import direction_of, rest_speed_of
from rrr_traj_planner.core.dynamics.rigid_body import path_torque_terms
from rrr_traj_planner.core.path.arm_path import ArmPath
from rrr_traj_planner.core.trajectory.sampling import STEP_OVERSHOOT
from rrr_traj_planner.planners.path_timing.pieces import piece_ends
from scipy.interpolate import CubicSpline

# Of each piece, between the table's positions; chosen: half and twice as many change 48 random
# motions by 0.001 % in the mean, by 0.02 % at most.
INTERVALS = 64


class PathTerms(NamedTuple):
    """
    The joints' derivatives by path length and the dynamics' terms, shape (..., 3) each.

    Velocity is dq sd; acceleration ddq sd^2 + dq sdd; jerk dddq sd^3 + 3 ddq sd sdd + dq sddd;
    torque m sdd + c sd^2 + g + viscous dq sd.
    """

    dq: Array    # [rad/m]
    ddq: Array   # [rad/m^2]
    dddq: Array  # [rad/m^3]
    m: Array     # [N m s^2/m]
    c: Array     # [N m s^2/m^2]
    g: Array     # [N m], with Coulomb friction where the joint moves in one direction


class PathTable:
    """
    A path in pieces, on each of which all terms are smooth.

    Parameters
    ----------
    arm_path : ArmPath
        The path in joint space.

    Attributes
    ----------
    ends : ndarray, shape (N + 1,)
        Path lengths where the pieces meet [m] (`pieces`).
    places : ndarray, shape (N, INTERVALS + 1)
        Path lengths of the table's values [m].
    values : PathTerms
        The terms there, one-sided at the pieces' ends, shape (N, INTERVALS + 1, 3) each.
    friction : Friction
        Of the joints.
    reserve : ndarray, shape (N, 1, 3)
        Coulomb friction of joints that turn on a piece, which is not in g: to be taken off both
        limits there [N m].
    coefficients : ndarray, shape (N, 4, INTERVALS, 18)
        Of the cubic splines of all terms, highest power first, by the part of a piece.
    overshoot : ndarray, shape (N, 2, 3)
        Near each piece's end, by how much a controller's quintic overshoots steps of ddq and c
        there (`core.trajectory.sampling.STEP_OVERSHOOT`); in the last two intervals of its mesh,
        as the quintic overshoots up to a sample before the step.

    """

    def __init__(self, arm_path: ArmPath) -> None:
        path, self.friction = arm_path.path, arm_path.model.friction
        self.ends = piece_ends(arm_path)
        self._lengths = np.diff(self.ends)
        u = np.linspace(0.0, 1.0, INTERVALS + 1)
        self.places = self.ends[:-1, np.newaxis] + self._lengths[:, np.newaxis] * u
        self.places[:, -1] = self.ends[1:]
        self.reserve, self.values = self._with_friction(self._terms(arm_path))
        stepping = np.stack((self.values.ddq, self.values.c), axis=2)
        steps = np.where(np.isin(self.ends[1:-1], path.joins)[:, np.newaxis, np.newaxis],
                         stepping[1:, 0] - stepping[:-1, -1], 0.0)
        self.overshoot = np.concatenate((-STEP_OVERSHOOT * steps, np.zeros((1, 2, 3))))
        self.coefficients = (_spline() @ np.concatenate(self.values, axis=-1)).reshape(
            len(self.places), 4, INTERVALS, -1)

    def _terms(self, arm_path: ArmPath) -> PathTerms:
        """Return all terms at the table's path lengths, one-sided at the pieces' ends."""
        ending = np.zeros(self.places.shape, bool)
        ending[:, -1] = True
        q, dq, ddq, dddq = (f.reshape(*self.places.shape, 3) for f in arm_path(
            self.places.ravel(), left=ending.ravel()))
        m, c, g = path_torque_terms(arm_path.model, q, dq, ddq)
        return PathTerms(dq, ddq, dddq, m, c, g)

    def _with_friction(self, terms: PathTerms) -> tuple[Array, PathTerms]:
        """Return the friction that is left out, and terms with that of joints that do not turn."""
        direction, coulomb = direction_of(terms.dq, rest_speed_of(terms.dq)), self.friction.coulomb
        least, most = direction.min(axis=1, keepdims=True), direction.max(axis=1, keepdims=True)
        turns = least * most < 0.0
        one_way = np.where(turns, 0.0, np.sign(least + most))
        return coulomb * turns, terms._replace(g=terms.g + coulomb * one_way)


@cache
def _spline() -> Array:
    """Return the matrix from values to the coefficients of a cubic spline through them."""
    unit = CubicSpline(np.linspace(0.0, 1.0, INTERVALS + 1), np.eye(INTERVALS + 1)).c
    return np.ascontiguousarray(unit.reshape(4 * INTERVALS, INTERVALS + 1))
