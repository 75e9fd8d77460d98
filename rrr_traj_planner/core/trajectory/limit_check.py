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

"""Check of a motion's extremes against its limits."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.errors import format_distinct
from rrr_traj_planner.core.rounding import JOINT_ROUNDING
from rrr_traj_planner.core.trajectory.trajectory import Peaks

# Relative; every motion that the package returns satisfies its limits to this tolerance. Chosen:
# more than planners allow themselves.
TOLERANCE = 1e-6


class Violation(NamedTuple):
    """A limit that a motion violates."""

    joint: int
    quantity: str
    value: float
    limit: float
    unit: str

    def text(self, joint_names: Sequence[str]) -> str:
        """
        Return the violation as a sentence.

        Parameters
        ----------
        joint_names : sequence of str
            The joints' names.

        Returns
        -------
        str
            Joint, quantity, value, limit and unit.

        """
        value, limit = format_distinct(self.value, self.limit)
        return (f'{joint_names[self.joint]} {self.quantity} reaches {value} {self.unit}, '
                f'limit {limit} {self.unit}')


def violations(limits: JointLimits, peaks: Peaks, effort: Array) -> list[Violation]:
    """
    Return every limit that a motion violates.

    Parameters
    ----------
    limits : JointLimits
        The limits.
    peaks : Peaks
        Extremes of the motion.
    effort : ndarray, shape (3,)
        Peak torques [N m].

    Returns
    -------
    list of Violation
        Empty if there is none.

    """
    found = []
    for quantity, value, limit, unit in (
            ('velocity', peaks.velocity, limits.max_velocity, 'rad/s'),
            ('acceleration', peaks.acceleration, limits.max_acceleration, 'rad/s^2'),
            ('jerk', peaks.jerk, limits.max_jerk, 'rad/s^3'),
            ('effort', effort, limits.max_effort, 'N m')):
        found += [Violation(int(j), quantity, float(value[j]), float(limit[j]), unit)
                  for j in np.flatnonzero(~(value <= limit * (1.0 + TOLERANCE)))]
    found += [Violation(int(j), 'position', float(peaks.min_position[j]),
                        float(limits.min_position[j]), 'rad')
              for j in np.flatnonzero(
                  peaks.min_position < limits.min_position - JOINT_ROUNDING)]
    found += [Violation(int(j), 'position', float(peaks.max_position[j]),
                        float(limits.max_position[j]), 'rad')
              for j in np.flatnonzero(
                  peaks.max_position > limits.max_position + JOINT_ROUNDING)]
    return found
