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

# Part of the arm's size up to which a length is rounding of a description. Chosen.
ROUNDING = 1e-9


class AxisFrame(NamedTuple):
    """
    A frame on joint axis 1, which is its z axis.

    Its x axis is the common normal of joint axes 1 and 2, on the side where the tip is with all
    joints at zero; so an arm whose tip stays in a plane through joint axis 1 is in the plane of x
    and z with joint 1 at zero.
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
    chain = model.chain
    z, x = chain.axis[0], np.cross(chain.axis[0], chain.axis[1])
    x = x / np.linalg.norm(x)
    if (chain.tip - chain.point[0]) @ x < -ROUNDING * chain.size:
        x = -x
    y = np.cross(z, x)
    at_zero = model.tables.tip[:, 0] + model.tables.tip[:, 1]  # of functions of q2 and q3
    across = np.einsum('x,xbc->bc', y, at_zero)
    across[0, 0] -= y @ chain.point[0]
    return AxisFrame(np.stack((x, y, z)), chain.point[0],
                     bool(np.abs(across).max() <= ROUNDING * chain.size))
