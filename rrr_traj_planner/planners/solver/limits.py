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

    lower: Array            # (N, P, 4 J), of position, velocity, acceleration and jerk;
    upper: Array            # (1, P, 4 J) if those of all segments are alike
    bounded: BoolArray      # (P, 4 J), which of these are limited
    general_lower: Array    # (N, P, E)
    general_upper: Array
    general: BoolArray      # (P, E), which of these are limited
    least_T: Array | None = None    # (N,), least durations [s]
    arm: CompiledArm | None = None
    table: Array | None = None    # (N, 4, intervals, 18), cubic coefficients of a path's terms
    overshoot: Array | None = None  # (N, 2, 3), added to ddq and to c at its segments' ends
    viscous: Array | None = None    # (3,), friction along it [N m s/rad]; as table

    def widened(self, part: float) -> Limits:
        """
        Return wider limits.

        Parameters
        ----------
        part : float
            Of half the distance between a lower and an upper limit, by which both are moved out.

        Returns
        -------
        Limits
            On the same quantities.

        """
        more, more_general = (0.5 * part * (high - low) for low, high in (
            (self.lower, self.upper), (self.general_lower, self.general_upper)))
        return self._replace(lower=self.lower - more, upper=self.upper + more,
                             general_lower=self.general_lower - more_general,
                             general_upper=self.general_upper + more_general)

    @property
    def bounds_alone(self) -> bool:
        """Return whether there are no general constraints."""
        return self.arm is None and self.table is None


def fixed_ends(segments: int, joints: int) -> BoolArray:
    """
    Return that velocities, accelerations and jerks do not change at both ends of a motion.

    Parameters
    ----------
    segments, joints : int
        Their numbers.

    Returns
    -------
    ndarray of bool, shape (segments + 1, 3, joints)
        See `DurationConstraints`.

    """
    fixed = np.zeros((segments + 1, 3, joints), bool)
    fixed[[0, -1]] = True
    return fixed


# Weight in the objective of the mean square of jerk over its limit, chosen: at its limits of
# velocity and acceleration a motion gains next to nothing by jerks that alternate. With half of it
# motions are 0.01 % faster in the mean, but where there are two points alone, in 1 of 80 random
# tasks, a jerk limited to 10 rad/s^3 varies by up to 103 in all, where 80 would do. With twice of
# it they are 0.03 % slower.
SMOOTHNESS = 2e-2


class DurationConstraints(NamedTuple):
    """
    The objective; which durations are free, fixed or in fixed proportions; what via points fix.

    A duration that is not free changes by its proportion times a common unknown.
    """

    free: BoolArray     # (N,)
    proportions: Array  # (N,), 0 where free or fixed
    weights: Array      # (N,), in the objective
    fixed: BoolArray    # (N + 1, 3, J), which velocities, accelerations and jerks do not change
    from_rest: bool = True  # whether the motion begins at rest; else it cannot be scaled in time
    max_jerk: Array | None = None  # (J,), infinite: none; None: jerk is not in the objective

    @classmethod
    def all_free(cls, segments: int, joints: int) -> DurationConstraints:
        """
        Return free durations, with their sum as the objective, and fixed ends of the motion.

        Parameters
        ----------
        segments, joints : int
            Their numbers.

        Returns
        -------
        DurationConstraints
            Free states at the via points between the ends.

        """
        return cls(np.ones(segments, bool), np.zeros(segments), np.ones(segments),
                   fixed_ends(segments, joints))

    def from_motion(self) -> DurationConstraints:
        """
        Return the same for a motion that begins with given velocities and accelerations.

        Returns
        -------
        DurationConstraints
            With free jerk at the start.

        """
        fixed = self.fixed.copy()
        fixed[0, 2] = False
        return self._replace(fixed=fixed, from_rest=False)

    @property
    def may_scale(self) -> bool:
        """Return whether a motion may be slowed: it begins at rest, and no duration is fixed."""
        return self.from_rest and bool((self.free | (self.proportions > 0.0)).all())

    def jerk_weights(self, shares: Array, T: Array) -> Array:
        """
        Return the weights of squared jerks in the objective.

        Parameters
        ----------
        shares : ndarray, shape (N, n + 1)
            Of the nodes in their segments, 1 in sum.
        T : ndarray, shape (N,)
            Durations, roughly [s].

        Returns
        -------
        ndarray, shape (N, n + 1, J)
            0 where jerk has no limit.

        """
        assert self.max_jerk is not None
        by_segment = SMOOTHNESS * (self.weights * T)[:, np.newaxis] * shares
        return by_segment[..., np.newaxis] / self.max_jerk ** 2

    def cost(self, T: Array) -> float:
        """
        Return the objective but for jerk.

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
