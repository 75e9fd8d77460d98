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
How many coefficients a motion is made of, as the thesis counts them (6.5 a).

A transition of the thesis's function has a, b, c, d and e (3.4-3.7), and so has a ramp: when its
jerk cruises is the same for all ramps of a motion. One of seventh order has eight (C.1), one of
fourth order five (6.1), Gauss's function mu, sigma and C0 to C2 (appendix A, closed form); a piece
at constant velocity two (4.11), the cubic cruise of a 4-3-4 four. Of a motion along a path of the
tip, the pieces of its progress are counted, not the geometry.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import BoolArray
from rrr_traj_planner.core.motion_laws.cycloid import CycloidPiece
from rrr_traj_planner.core.motion_laws.polynomial_piece import PolynomialPiece
from rrr_traj_planner.core.motion_laws.ramps import Ramps
from rrr_traj_planner.core.motion_laws.transition_shape import ShapedPiece
from rrr_traj_planner.core.path.path_trajectory import PathTrajectory
from rrr_traj_planner.core.trajectory.pieces import Pieces
from rrr_traj_planner.core.trajectory.piecewise import JointProfile, PiecewiseTrajectory
from rrr_traj_planner.core.trajectory.trajectory import Trajectory

CRUISE = 2
CUBIC_CRUISE = 4
PER_TRANSITION = {'cycloid': 5, 'gauss': 5, 'quartic': 5, 'septic': 8}


class Coefficients(NamedTuple):
    """Numbers of pieces and of what they are made of."""

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
    Return how many coefficients a motion has.

    Parameters
    ----------
    trajectory : Trajectory
        The motion.

    Returns
    -------
    Coefficients
        Its pieces' number and theirs.

    """
    profiles = profiles_of(trajectory)
    moving = np.concatenate([is_transition(p.pieces) for p in profiles])
    return Coefficients(int(moving.sum()), int((~moving).sum()),
                        PER_TRANSITION[_function(profiles[0].pieces)],
                        _per_cruise(profiles[0].pieces))


def profiles_of(trajectory: Trajectory) -> tuple[JointProfile, ...]:
    """
    Return what a motion's pieces are pieces of.

    Parameters
    ----------
    trajectory : Trajectory
        The motion.

    Returns
    -------
    tuple of JointProfile
        Of each joint, or of the progress along a path alone.

    Raises
    ------
    TypeError
        If the motion is not made of pieces.

    """
    if isinstance(trajectory, PiecewiseTrajectory):
        return trajectory.profiles
    if isinstance(trajectory, PathTrajectory):
        return (trajectory.progress,)
    raise TypeError(f'a {type(trajectory).__name__} has no pieces')


def is_transition(pieces: Pieces) -> BoolArray:
    """
    Return which pieces are no cruises.

    Parameters
    ----------
    pieces : Pieces
        Values of shape (n,).

    Returns
    -------
    ndarray of bool, shape (n,)
        Whether velocity changes there; of a 4-3-4, whether it is a quartic.

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
    if isinstance(pieces, (CycloidPiece, Ramps)):
        return 'cycloid'
    if isinstance(pieces, ShapedPiece) and pieces.shape.name in PER_TRANSITION:
        return pieces.shape.name
    raise TypeError(f'pieces of an unknown function: {type(pieces).__name__}')
