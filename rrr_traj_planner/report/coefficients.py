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
Number of coefficients of a motion, as the thesis counts them (6.5 a).

A transition of the thesis's function has five: a, b, c, d and e (3.4-3.7). So has an interval of a
quartic spline. A seventh-order transition has eight (C.1), a fourth-order one five (6.1), Gauss's
function five: mu, sigma and C0 to C2 (appendix A, closed form). A piece at constant velocity has
two (4.11), the cubic cruise of a 4-3-4 four. For a motion along a path of the tip, the pieces of
the path coordinate s(t) are counted, not the geometry.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import BoolArray
from rrr_traj_planner.core.motion_laws.cycloid import CycloidPiece
from rrr_traj_planner.core.motion_laws.polynomial_piece import PolynomialPiece
from rrr_traj_planner.core.motion_laws.transition_shape import ShapedPiece
from rrr_traj_planner.core.path.path_trajectory import PathTrajectory
from rrr_traj_planner.core.trajectory.joint_profile import JointProfile
from rrr_traj_planner.core.trajectory.paused import motions_of
from rrr_traj_planner.core.trajectory.pieces import Pieces
from rrr_traj_planner.core.trajectory.piecewise import PiecewiseTrajectory
from rrr_traj_planner.core.trajectory.trajectory import Trajectory

CRUISE = 2        # coefficients of a piece at constant velocity
CUBIC_CRUISE = 4  # of the cubic cruise of a 4-3-4
PER_TRANSITION = {'cycloid': 5, 'gauss': 5, 'quartic': 5, 'septic': 8}


class Coefficients(NamedTuple):
    """Numbers of pieces, and of coefficients for each."""

    transitions: int     # over all joints
    cruises: int
    per_transition: int
    per_cruise: int = CRUISE

    @property
    def total(self) -> int:
        """Return the number of coefficients of the whole motion."""
        return self.transitions * self.per_transition + self.cruises * self.per_cruise


def coefficients(trajectory: Trajectory) -> Coefficients:
    """
    Return the number of a motion's coefficients.

    Parameters
    ----------
    trajectory : Trajectory
        The motion.

    Returns
    -------
    Coefficients
        Numbers of pieces, and of coefficients for each.

    """
    profiles = [p for motion in motions_of(trajectory) for p in _profiles_of(motion)]
    moving = np.concatenate([is_transition(p.pieces) for p in profiles])
    return Coefficients(int(moving.sum()), int((~moving).sum()),
                        PER_TRANSITION[_function(profiles[0].pieces)],
                        _per_cruise(profiles[0].pieces))


def _profiles_of(trajectory: Trajectory) -> tuple[JointProfile, ...]:
    """
    Return the piecewise functions that describe a motion.

    Parameters
    ----------
    trajectory : Trajectory
        The motion.

    Returns
    -------
    tuple of JointProfile
        One for each joint, or one for the path coordinate s(t).

    Raises
    ------
    TypeError
        If the motion is not piecewise.

    """
    if isinstance(trajectory, PiecewiseTrajectory):
        return trajectory.profiles
    if isinstance(trajectory, PathTrajectory):
        return (trajectory.progress,)
    raise TypeError(f'a {type(trajectory).__name__} has no pieces')


def is_transition(pieces: Pieces) -> BoolArray:
    """
    Return which pieces are transitions, not cruises.

    Parameters
    ----------
    pieces : Pieces
        Values of shape (n,).

    Returns
    -------
    ndarray of bool, shape (n,)
        Whether the velocity changes in the piece; for polynomials, whether it is a quartic.

    """
    if isinstance(pieces, PolynomialPiece):
        return np.asarray(pieces.snap != 0.0)
    acceleration, _ = pieces.peaks()
    return np.asarray(acceleration > 0.0)


def _per_cruise(pieces: Any) -> int:
    return CUBIC_CRUISE if isinstance(pieces, PolynomialPiece) else CRUISE


def _function(pieces: Any) -> str:
    if isinstance(pieces, PolynomialPiece):
        return 'quartic'
    if isinstance(pieces, CycloidPiece):
        return 'cycloid'
    if isinstance(pieces, ShapedPiece) and pieces.shape.name in PER_TRANSITION:
        return pieces.shape.name
    raise TypeError(f'pieces of an unknown function: {type(pieces).__name__}')
