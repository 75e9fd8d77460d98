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

"""A path of the tip as an arm follows it: joint positions and derivatives along it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.core.kinematics.along_path import joint_path_near, JointPath
from rrr_traj_planner.core.path.axis_planes import AxisPlanes
from rrr_traj_planner.core.path.cartesian_path import CartesianPath
from rrr_traj_planner.core.read_only import ReadOnlyArrays


@dataclass(frozen=True, eq=False)
class ArmPath(ReadOnlyArrays):
    """
    A path of the tip as one arm follows it, on one branch of its inverse kinematics.

    Made by `followed_path`.

    Parameters
    ----------
    model : RobotModel
        The arm.
    path : CartesianPath
        The path, within the workspace.
    planes : AxisPlanes
        Parts of the path in a plane through joint axis 1, where joint 1 is constant.
    s : ndarray, shape (m,)
        Path coordinates from 0 to the path's length [m], so near to one another that cubic
        polynomials between them identify the branch.
    q : ndarray, shape (m, 3)
        Joint positions there [rad].
    rates : ndarray, shape (2, m, 3)
        Their derivatives by s as the path leaves and as it reaches each of them [rad/m].

    """

    model: RobotModel
    path: CartesianPath
    planes: AxisPlanes
    s: Array
    q: Array
    rates: Array

    def __call__(self, s: Array, left: bool | BoolArray = False) -> JointPath:
        """
        Return joint positions and their derivatives by arc length.

        Parameters
        ----------
        s : ndarray, shape (m,)
            Path coordinates [m], in any order.
        left : bool or ndarray of bool, shape (m,)
            At a join, the values of the piece that ends there.

        Returns
        -------
        JointPath
            Of shape (m, 3) each.

        """
        return self._near(s, left)[0]

    def regularity(self, s: Array) -> Array:
        """
        Return how far from singular the arm is.

        Parameters
        ----------
        s : ndarray, shape (m,)
            Path coordinates [m], in any order.

        Returns
        -------
        ndarray, shape (m, 4)
            As of `joint_path_near`.

        """
        return self._near(s, False)[1]

    def turned(self, turns: Array) -> ArmPath:
        """
        Return the path with whole turns added to the joints.

        Parameters
        ----------
        turns : ndarray, shape (3,)
            Multiples of 2 pi [rad].

        Returns
        -------
        ArmPath
            The same path of the tip.

        """
        return ArmPath(self.model, self.path, self.planes, self.s, self.q + turns, self.rates)

    def _near(self, s: Array, left: bool | BoolArray) -> tuple[JointPath, Array]:
        """Return joint positions near those known, and the regularity."""
        return joint_path_near(
            self.model, self.planes.points(self.path, s, left), self._interpolated(s))

    def _interpolated(self, s: Array) -> Array:
        """Return joint positions by cubic Hermite polynomials between those known."""
        k = np.clip(np.searchsorted(self.s, s, side='right') - 1, 0, len(self.s) - 2)
        h = self.s[k + 1] - self.s[k]
        u = ((s - self.s[k]) / h)[:, np.newaxis]
        change, (leaving, reaching) = self.q[k + 1] - self.q[k], self.rates
        first = h[:, np.newaxis] * leaving[k] - change
        second = change - h[:, np.newaxis] * reaching[k + 1]
        return np.asarray(self.q[k] + u * (change + (1.0 - u) * ((1.0 - u) * first + u * second)))
