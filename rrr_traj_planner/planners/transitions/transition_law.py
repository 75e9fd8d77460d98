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
The least duration of a transition between two velocities, by acceleration and jerk limits (4.10).

A transition that changes velocity by u lasts at least t(u) = max(slope u, root sqrt(u)): the first
by the acceleration limit, the second by the jerk limit. Its acceleration is symmetric in time, so
its displacement is (v0 + v1) t / 2. Whatever the transition function, these two properties
determine a segment.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.kernels import addresses
from rrr_traj_planner.planners.solver.library import KERNELS


class TransitionLaw(NamedTuple):
    """
    Coefficients of the least duration of a change of velocity, for each joint.

    For a function with peak acceleration A u / t and peak jerk B u / t^2, the slope is
    A / max_acceleration and the root is sqrt(B / max_jerk), 0 without a jerk limit.
    """

    slope: Array  # [s^2/rad], (3,)
    root: Array   # [s sqrt(s/rad)], (3,)

    def least_time(self, change: Array) -> Array:
        """
        Return the least duration of a change of velocity.

        Parameters
        ----------
        change : ndarray
            Change of velocity, of either sign [rad/s].

        Returns
        -------
        ndarray
            [s].

        """
        return self._by(KERNELS.least_transition_times, change)

    def largest_change(self, duration: Array) -> Array:
        """
        Return the largest change of velocity within a duration.

        Parameters
        ----------
        duration : ndarray
            [s].

        Returns
        -------
        ndarray
            Its magnitude [rad/s].

        """
        return self._by(KERNELS.largest_velocity_changes, duration)

    def _by(self, kernel: Callable[..., None], values: Array) -> Array:
        """Return a kernel's results for values of shapes that broadcast to (..., 3)."""
        law = np.array(self)
        at = np.empty((2, *np.broadcast_shapes(np.shape(values), self.slope.shape)))
        at[0] = values
        kernel(at[0].size // 3, *addresses(law), *addresses(at))
        return np.asarray(at[1])


class SegmentLimits(NamedTuple):
    """The limits of a segment's motion between given velocities."""

    law: TransitionLaw
    max_velocity: Array  # [rad/s], (3,)
