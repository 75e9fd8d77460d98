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

"""The frame of joint axis 1 in which the tip's distance from that axis is measured."""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.kinematics.common_normal import common_normal, front_sign

# Part of the arm's size up to which a lateral offset is rounding of a description: with one, the
# tip would leave the plane in which native/joint_path.c keeps it. Chosen.
OFFSET = 1e-9


class AxisFrame(NamedTuple):
    """
    A frame on joint axis 1, which is its z axis.

    Its x axis is the common normal of joint axes 1 and 2, on the side where the tip is with all
    joints at zero (`front_sign`); so an arm whose tip stays in a plane through joint axis 1 is in
    the plane of x and z with joint 1 at zero.
    """

    rotation: Array      # shape (3, 3): x, y and z axis in the base frame, in rows
    origin: Array        # [m], in the base frame
    swings_in_plane: bool  # whether the tip stays in a plane through joint axis 1 (no offset)

    def coordinates(self, points: Array) -> Array:
        """
        Return points of the base frame in this frame.

        Parameters
        ----------
        points : ndarray, shape (..., 3)
            [m].

        Returns
        -------
        ndarray, shape (..., 3)
            [m].

        """
        return np.asarray((points - self.origin) @ self.rotation.T)

    def normal(self, azimuth: float) -> Array:
        """
        Return the normal of a plane through joint axis 1.

        Parameters
        ----------
        azimuth : float
            Of the plane, from the x axis [rad].

        Returns
        -------
        ndarray, shape (3,)
            Unit vector in the base frame, towards growing azimuth.

        """
        return np.asarray(-np.sin(azimuth) * self.rotation[0] + np.cos(azimuth) * self.rotation[1])


@lru_cache(maxsize=16)
def axis_frame(model: RobotModel) -> AxisFrame:
    """
    Return the frame of an arm's joint axis 1.

    Parameters
    ----------
    model : RobotModel
        The arm; a model never changes.

    Returns
    -------
    AxisFrame
        The frame.

    """
    g, front = common_normal(model), front_sign(model)
    x, y, z = front * np.array(g.n), front * np.array(g.m), np.array(g.z)
    # At q1 = 0 the tip's component across the plane is c (v cos q2 + u sin q2) - s k.
    across = np.array((*(g.c * f for f in (*g.u, *g.v)), *(g.s * f for f in g.k)))
    return AxisFrame(np.stack((x, y, z)), model.chain.point[0],
                     bool(np.abs(across).max() <= OFFSET * g.size))
