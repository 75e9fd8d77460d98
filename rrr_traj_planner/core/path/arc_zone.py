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

"""The arc of a circle as the curved zone of a path: thesis section 5.4.2."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from rrr_traj_planner.core.arrays import Array, finite_array, IntArray
from rrr_traj_planner.core.read_only import ReadOnlyArrays


class ArcZones(ReadOnlyArrays):
    """
    Arcs of unit radius, each in a plane of its own.

    The origin of each plane is the via point, x the tangent of the path there, y the normal.

    Parameters
    ----------
    before, after : array_like, shape (k,)
        Angles by which each arc turns before and after its via point [rad].

    Raises
    ------
    InvalidInputError
        If an angle is not finite.

    """

    def __init__(self, before: ArrayLike, after: ArrayLike) -> None:
        self.before = finite_array('before', before, (-1,))
        self.after = finite_array('after', after, (-1,))

    @staticmethod
    def ends(angle: Array) -> tuple[Array, Array]:
        """
        Return the tangent point of an arc and the line after it.

        Parameters
        ----------
        angle : ndarray
            Half the angle by which the path turns [rad].

        Returns
        -------
        tuple of ndarray
            x and y, in radii.

        """
        return np.sin(angle), 2.0 * np.sin(0.5 * angle) ** 2

    def outline(self, zone: IntArray, part: Array) -> tuple[Array, Array]:
        """
        Return points of arcs, see `cartesian_path.Zones`.

        Parameters
        ----------
        zone : ndarray of int, shape (m,)
            Indices of the arcs.
        part : ndarray, shape (m,)
            Of the arc before the via point, negative, or after it.

        Returns
        -------
        tuple of ndarray, shape (m,)
            x and y, in radii.

        """
        angle = np.where(part < 0.0, self.before[zone], self.after[zone]) * part
        return np.sin(angle), 2.0 * np.sin(0.5 * angle) ** 2

    def at(self, zone: IntArray, sigma: Array) -> Array:
        """
        Return points of arcs and their derivatives.

        Parameters
        ----------
        zone : ndarray of int, shape (m,)
            Indices of the arcs.
        sigma : ndarray, shape (m,)
            Length from the via point, in radii.

        Returns
        -------
        ndarray, shape (4, 2, m)
            x and y, and their first to third derivatives by sigma.

        """
        s, c = np.sin(sigma), np.cos(sigma)
        return np.array([[s, 2.0 * np.sin(0.5 * sigma) ** 2], [c, s], [-s, c], [-c, -s]])
