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

"""What a via-point file says."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.core.errors import InvalidInputError, quoted

# Returns joint positions (n, 3) in the order of joint names; raises an InvalidInputError where a
# joint is missing.
JointPositions = Callable[[Sequence[str]], Array]


@dataclass(frozen=True, eq=False)
class Task:
    """
    A via-point file.

    Attributes
    ----------
    name : str
        The file's name without its suffix.
    via_points : ndarray, shape (n, 3)
        Tip positions [m]; empty where joint positions are given.
    arm : Path
        The parameter file of the arm.
    planner_id : str
        Empty: the planner node's default.
    segment_durations : ndarray
        Time for each segment [s]; empty: as fast as the limits allow.
    joint_positions : callable, optional
        Via points as joint positions, by the names of an arm's joints; None: `via_points` are
        given.
    stop_at : ndarray of bool
        Whether the arm stops at each via point; empty: at the last.
    dwell : ndarray
        Rest at each via point [s]; empty: none.
    frame : str
        Frame of the via points; empty: the base frame.

    """

    name: str
    via_points: Array
    arm: Path
    planner_id: str = ''
    segment_durations: Array = field(default_factory=lambda: np.zeros(0))
    joint_positions: JointPositions | None = None
    stop_at: BoolArray = field(default_factory=lambda: np.zeros(0, dtype=bool))
    dwell: Array = field(default_factory=lambda: np.zeros(0))
    frame: str = ''

    def joint_via_points(self, joint_names: Sequence[str]) -> Array | None:
        """
        Return the via points as joint positions.

        Parameters
        ----------
        joint_names : sequence of str
            The arm's joints.

        Returns
        -------
        ndarray, shape (n, 3), or None
            In the order of the joints [rad]; None where positions of the tip are given.

        Raises
        ------
        InvalidInputError
            If the file has no position of a joint; with file and line.

        """
        return None if self.joint_positions is None else self.joint_positions(joint_names)

    def check_frame(self, base_frame: str) -> None:
        """
        Refuse via points in another frame than the base frame, for who has no transforms.

        Parameters
        ----------
        base_frame : str
            The base frame.

        Raises
        ------
        InvalidInputError
            If they are in another; with both.

        """
        if self.frame not in ('', base_frame):
            raise InvalidInputError(
                f'{self.name}: the via points are in frame {quoted(self.frame)}, must be in '
                f"'{base_frame}': only the service plan_trajectory transforms them")


def given(values: NDArray[Any]) -> NDArray[Any] | None:
    """
    Return one of a task's arrays as an argument of the library.

    Parameters
    ----------
    values : ndarray
        The array.

    Returns
    -------
    ndarray or None
        None where it is empty.

    """
    return values if len(values) else None
