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

"""The constraints of a timing problem as arrays: limits on states, constraints on durations."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arm.compiled_arm import CompiledArm
from rrr_traj_planner.core.arrays import Array, BoolArray

FAR = 1e6  # stands for no bound, in SI units and rad: never active; chosen


class Limits(NamedTuple):
    """
    Limits as arrays; P = 2 n + 1 points of a segment, at each E general constraints.

    The general constraints are on the joints' torques where `arm` is given, and on the joints'
    velocities, accelerations, jerks and torques along a path where `table` is given. Where neither
    is, there are none.
    """

    lower: Array            # (N, P, 4 J), of position, velocity, acceleration and jerk
    upper: Array
    bounded: BoolArray      # (P, 4 J), which of these are limited
    general_lower: Array    # (N, P, E)
    general_upper: Array
    general: BoolArray      # (P, E), which of these are limited
    least_T: Array | None = None    # (N,), least durations [s]
    arm: CompiledArm | None = None
    table: Array | None = None    # (N, 4, intervals, 18), cubic coefficients of a path's terms
    overshoot: Array | None = None  # (N, 2, 3), added to ddq and to c at its segments' ends
    viscous: Array | None = None    # (3,), friction along it [N m s/rad]; as table

    @property
    def bounds_alone(self) -> bool:
        """Return whether there are no general constraints."""
        return self.arm is None and self.table is None


class DurationConstraints(NamedTuple):
    """
    Which durations are free, fixed or in fixed proportions; which via velocities are fixed.

    A duration that is not free changes by its proportion times a common unknown.
    """

    free: BoolArray     # (N,)
    proportions: Array  # (N,), 0 where free or fixed
    weights: Array      # (N,), in the objective
    fixed_velocities: BoolArray  # (N - 1, J), whether a joint's via velocity does not change

    @classmethod
    def all_free(cls, segments: int, joints: int) -> DurationConstraints:
        """
        Return free durations and via velocities, with the sum of durations as the objective.

        Parameters
        ----------
        segments, joints : int
            Their numbers.

        Returns
        -------
        DurationConstraints
            No constraint at all.

        """
        return cls(np.ones(segments, bool), np.zeros(segments), np.ones(segments),
                   np.zeros((segments - 1, joints), bool))

    def cost(self, T: Array) -> float:
        """
        Return the objective.

        Parameters
        ----------
        T : ndarray, shape (N,)
            Durations [s].

        Returns
        -------
        float
            Their weighted sum.

        """
        return float(self.weights @ T)
