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

"""Lines in the page's scene: paths and the grid."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from rrr_traj_planner.core.arrays import Array
import viser


def grid(count: int) -> NDArray[np.float32]:
    """
    Return a grid in the plane x, y, with cells of 1.

    Parameters
    ----------
    count : int
        Of cells, from the middle to each side.

    Returns
    -------
    ndarray, shape (n, 2, 3)
        Ends of its lines.

    """
    at = np.arange(-count, count + 1, dtype=np.float32)
    lines = np.zeros((len(at), 2, 3), np.float32)
    lines[:, :, 0], lines[:, :, 1] = at[:, None], (-count, count)
    return np.concatenate((lines, lines[:, :, (1, 0, 2)]))


def spread(path: Array, step: float) -> NDArray[np.intp]:
    """
    Return which points of a path to draw, so that no segment is much shorter than a step.

    Parameters
    ----------
    path : ndarray, shape (n, 3)
        Points along it [m].
    step : float
        [m].

    Returns
    -------
    ndarray of int
        Their indices, ends included.

    """
    steps = np.linalg.norm(np.diff(path, axis=0), axis=1).cumsum() // step
    return np.union1d((0, len(path) - 1), 1 + np.flatnonzero(np.diff(steps, prepend=0.0)))


class Path:
    """
    A path, drawn by one object that is changed: the browser need not make another one.

    Parameters
    ----------
    scene : viser.SceneApi
        Where to draw.
    name : str
        In the scene.
    width : float
        Of its line [pixels].

    """

    def __init__(self, scene: viser.SceneApi, name: str, width: float) -> None:
        self._lines = scene.add_line_segments(
            name, np.zeros((1, 2, 3), np.float32), (0, 0, 0), thickness=width,
            thickness_units='screen')

    def show(self, path: Array, colours: Any) -> None:
        """
        Draw it elsewhere.

        Parameters
        ----------
        path : ndarray, shape (n, 3)
            Points along it [m].
        colours : array_like, shape (3,) or (n - 1, 2, 3)
            One, or those of its segments' ends: red, green and blue, 0 to 255.

        """
        ends = np.stack((path[:-1], path[1:]), axis=1)
        if not len(ends):
            ends, colours = np.zeros((1, 2, 3)), (0, 0, 0)  # a line without length: not to be seen
        self._lines.points = ends.astype(np.float32)
        self._lines.colors = np.broadcast_to(_linear(np.asarray(colours)), ends.shape)


def _linear(colours: Array) -> NDArray[np.uint8]:
    """Return colours as viser's lines have them: proportional to light (IEC 61966-2-1)."""
    share = colours / 255.0
    light = np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)
    return (255.0 * light).round().astype(np.uint8)
