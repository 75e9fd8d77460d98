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
The largest displacement of a transition, a cruise and a transition in a given time (thesis 4.2.3).

Of all motions of a segment between given velocities, the one with the largest displacement has
shortest transitions and the fastest cruise that these allow.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.kernels import addresses
from rrr_traj_planner.planners.solver.library import KERNELS
from rrr_traj_planner.planners.transitions.transition_law import SegmentLimits


class Derivatives(NamedTuple):
    """The largest displacement, and its derivatives by v0, v1 and T."""

    distance: Array  # shape (..., 3) [rad]
    gradient: Array  # (..., 3, 3): of each joint
    hessian: Array   # (..., 3, 3, 3)


def largest_cruise(limits: SegmentLimits, v0: Array, v1: Array, T: Array) -> Array:
    """
    Return the cruise velocity of largest displacement in a given time between given velocities.

    Parameters
    ----------
    limits : SegmentLimits
        Transitions' least durations and the largest velocity.
    v0, v1 : ndarray, shape (..., 3)
        Velocities at the ends [rad/s], not above the maximum.
    T : ndarray
        Duration [s], at least `law.least_time(v1 - v0)`.

    Returns
    -------
    ndarray, shape (..., 3)
        [rad/s]; shapes broadcast.

    """
    return _evaluated(limits, v0, v1, T, derivatives=False)[0]


def largest_displacement(limits: SegmentLimits, v0: Array, v1: Array, T: Array) -> Array:
    """
    Return the largest displacement in a given time between given velocities.

    The least one is minus the largest between the opposite velocities.

    Parameters
    ----------
    limits, v0, v1, T
        As in `largest_cruise`.

    Returns
    -------
    ndarray, shape (..., 3)
        [rad]; shapes broadcast.

    """
    return _evaluated(limits, v0, v1, T, derivatives=False)[1]


def derivatives(limits: SegmentLimits, v0: Array, v1: Array, T: Array) -> Derivatives:
    """
    Return the largest displacement and its derivatives.

    The displacement is that of the cruise in the whole time, cruise T, less u t / 2 at each end:
    there a transition changes the velocity by u = cruise - v0 or cruise - v1, in its least time
    t(u). The kernel differentiates this by the chain rule; the cruise follows from t(u0) + t(u1)
    = T, or is the velocity limit.

    Parameters
    ----------
    limits, v0, v1, T
        As in `largest_cruise`; velocities below the maximum.

    Returns
    -------
    Derivatives
        One-sided where the active limit changes.

    """
    return Derivatives(*_evaluated(limits, v0, v1, T, derivatives=True)[1:])


def _evaluated(limits: SegmentLimits, v0: Array, v1: Array, T: Array,
               derivatives: bool) -> tuple[Array, Array, Array, Array]:
    """Return cruise velocity and distance, and the distance's derivatives if requested."""
    shape = np.broadcast_shapes(np.shape(v0), np.shape(v1), np.shape(T), (3,))
    law, at = np.array((*limits.law, limits.max_velocity)), np.empty((5, *shape))
    at[0], at[1], at[2] = v0, v1, T
    gradient, hessian = (np.empty((*(shape if derivatives else (0,)), *(3,) * k)) for k in (1, 2))
    KERNELS.largest_displacement_at(at[0].size // 3, *addresses(law), *addresses(at), *(
        x.ctypes.data if derivatives else None for x in (gradient, hessian)))
    return at[3], at[4], gradient, hessian
