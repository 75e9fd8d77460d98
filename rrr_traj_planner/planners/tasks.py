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

"""The tasks of joint-space and Cartesian planners."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array, IntArray
from rrr_traj_planner.core.cancellation import never, ShouldStop
from rrr_traj_planner.core.read_only import ReadOnlyArrays

T_ACC = 0.5  # s, half the length of a transition of 4-1-4 (table 6.2)
LEAST_JERK_RISE = 0.02  # s, in which jerk may go from zero to its limit; chosen: two samples


class StartRates(NamedTuple):
    """How the joints move where a motion starts."""

    velocity: Array      # [rad/s], (3,)
    acceleration: Array  # [rad/s^2], (3,)


@dataclass(frozen=True, eq=False)
class JointTask(ReadOnlyArrays):
    """
    The task of a joint-space planner.

    Consecutive points differ, except where the arm is to dwell at a point for a prescribed time.

    Parameters
    ----------
    model : RobotModel
        The arm.
    limits : JointLimits
        Scaled as requested.
    points : ndarray, shape (n + 1, 3)
        Joint positions [rad], within the ranges, at which the motors can hold the arm.
    durations : ndarray, shape (n,), optional
        Prescribed durations of the segments [s]; NaN where one is free.
    sample_period : float
        [s].
    segment_numbers : ndarray of int, shape (n,), optional
        The segments' numbers in the request, which may have more of them; None: 0, 1, 2, ...
    should_stop : callable
        As in `PlanningRequest`.
    half_transition : float
        Half the length of the transitions of 4-1-4, as in `PlanningRequest` [s].
    least_jerk_rise : float
        As in `PlanningRequest` [s].
    start_rates : StartRates, optional
        Of a motion that starts moving; None: at rest.

    """

    model: RobotModel
    limits: JointLimits
    points: Array
    durations: Array | None
    sample_period: float
    segment_numbers: IntArray | None = None
    should_stop: ShouldStop = never
    half_transition: float = T_ACC
    least_jerk_rise: float = LEAST_JERK_RISE
    start_rates: StartRates | None = None

    @property
    def rates_at_start(self) -> StartRates:
        """Return how the joints move at the start, which is not at rest."""
        assert self.start_rates is not None
        return self.start_rates

    def segment_number(self, segment: int) -> int:
        """
        Return a segment's number in the request.

        Parameters
        ----------
        segment : int
            Its index in the task.

        Returns
        -------
        int
            Its index in the request.

        """
        return segment if self.segment_numbers is None else int(self.segment_numbers[segment])


@dataclass(frozen=True, eq=False)
class CartesianTask(ReadOnlyArrays):
    """
    The task of a planner of Cartesian paths: consecutive points that differ.

    Parameters
    ----------
    model : RobotModel
        The arm.
    limits : JointLimits
        Scaled as requested.
    tips : ndarray, shape (n + 1, 3)
        Tip positions [m]; the start's is the first.
    first : ndarray, shape (3,)
        Joint positions [rad] at the first of them, up to whole turns: the arm follows the path on
        their branch of the inverse kinematics.
    start : ndarray, shape (3,), optional
        The same where the motion begins with their whole turns; None: with any.
    max_deviation : float
        Largest distance of the path from the polyline [m].
    max_tip_speed : float
        [m/s], infinite: none.
    steady_zones : bool
        Whether the tip keeps its speed on curved zones.
    sample_period : float
        [s].
    should_stop : callable
        As in `PlanningRequest`.

    """

    model: RobotModel
    limits: JointLimits
    tips: Array
    first: Array
    start: Array | None
    max_deviation: float
    max_tip_speed: float
    steady_zones: bool
    sample_period: float
    should_stop: ShouldStop = never
