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

"""How the user changes what is wanted: the chosen via point, single changes, undo and redo."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from time import monotonic

import numpy as np
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.kinematics.link_positions import Point
from rrr_traj_planner.nodes.studio.edits import exchanged, inserted, removed
from rrr_traj_planner.nodes.studio.history import History
from rrr_traj_planner.nodes.studio.wanted import Wanted


class Editor:
    """
    What is wanted, and how it changes.

    Parameters
    ----------
    wanted : Wanted
        At the beginning.
    model : RobotModel
        The arm.
    changed : callable
        Called after every change.

    Attributes
    ----------
    chosen : int
        Index of the via point that is changed.

    """

    def __init__(self, wanted: Wanted, model: RobotModel, changed: Callable[[], None]) -> None:
        self._history, self._model, self._changed = History(wanted), model, changed
        self._is_drag = False
        self.chosen = 0

    @property
    def wanted(self) -> Wanted:
        """Return what is wanted now."""
        return self._history.present

    @property
    def can_undo(self) -> bool:
        """Return whether there is a step to undo."""
        return self._history.can_undo

    @property
    def can_redo(self) -> bool:
        """Return whether there is a step to do again."""
        return self._history.can_redo

    def change(self, wanted: Wanted, source: str = '') -> None:
        """
        Want something else.

        Parameters
        ----------
        wanted : Wanted
            What is wanted; nothing happens where it is the present object.
        source : str
            What has made it; quick changes by one source are one step. Empty: a step of its own.

        """
        if wanted is not self.wanted:
            self._history.add(wanted.completed(self._model, self.wanted), source, monotonic(),
                              self._is_drag)
            self._show()

    def choose(self, index: int) -> None:
        """
        Choose a via point.

        Parameters
        ----------
        index : int
            Which one.

        """
        if index != self.chosen:
            self.chosen = index
            self._show()

    def drag(self, index: int, begins: bool) -> None:
        """
        Begin or end the dragging of a via point, which is one step.

        Parameters
        ----------
        index : int
            Which one; it is chosen.
        begins : bool
            Whether it begins.

        """
        self._is_drag = begins
        self._history.end_step()
        self.choose(index)

    def move(self, index: int, position: Point) -> None:
        """
        Have one via point elsewhere.

        Parameters
        ----------
        index : int
            Which one; nothing happens where it is no longer there, or there already.
        position : tuple of 3 floats
            Where it is now [m].

        """
        wanted = self.wanted
        if index < len(wanted.points) and tuple(wanted.points[index].tolist()) != position:
            self.change(wanted.moved(index, position), f'position of {index}')

    def keep_joints(self, joints: Array | None) -> None:
        """
        Go through joint positions in place of positions of the tip, or not.

        Parameters
        ----------
        joints : ndarray, shape (n, 3), optional
            Near which joint positions [rad]; None: the tip's positions are gone through.

        """
        wanted = replace(self.wanted, joints=joints)
        if joints is not None:
            unknown = replace(wanted, joints=np.full(joints.shape, np.nan), elbow='', shoulder='')
            wanted = unknown.completed(self._model, wanted)
        self.change(wanted)

    def insert(self) -> None:
        """Insert a via point after the chosen one, and choose it."""
        wanted = inserted(self.wanted, self.chosen)
        self.chosen += 1
        self.change(wanted)

    def remove(self) -> None:
        """Remove the chosen via point, and choose the one in its place."""
        self.change(removed(self.wanted, self.chosen))

    def shift(self, step: int) -> None:
        """
        Exchange the chosen via point with one near it, and keep it chosen.

        Parameters
        ----------
        step : int
            1: with the next; -1: with the one before.

        """
        wanted = exchanged(self.wanted, self.chosen, self.chosen + step)
        if wanted is not self.wanted:
            self.chosen += step
            self.change(wanted)

    def undo(self) -> None:
        """Undo the last step."""
        if self.can_undo:
            self._history.undo()
            self._show()

    def redo(self) -> None:
        """Do again what was undone last."""
        if self.can_redo:
            self._history.redo()
            self._show()

    def _show(self) -> None:
        self.chosen = min(max(self.chosen, 0), len(self.wanted.points) - 1)
        self._changed()
