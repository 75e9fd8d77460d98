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

"""The parts of a motion: from stop to stop, and what they have in common."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.core.cancellation import ShouldStop
from rrr_traj_planner.core.rounding import TIP_ROUNDING
from rrr_traj_planner.planners.deadline import part_of
from rrr_traj_planner.planners.request import PlanningRequest

# Motions are planned for sample periods up to this, so that a longer sample_period does not slow
# them: the answer has additional points where its quintics need them. The default sample_period;
# half and twice of it change none of 28 random plans by `cycloid`.
LONGEST_SPACING = 0.01  # s


class Span(NamedTuple):
    """The points of a part of the motion, counted from the start state where there is one."""

    first: int
    last: int

    @property
    def points(self) -> slice:
        """Return the indices of its points."""
        return slice(self.first, self.last + 1)

    @property
    def segments(self) -> slice:
        """Return the indices of its segments."""
        return slice(self.first, self.last)


def spans(request: PlanningRequest) -> list[Span]:
    """
    Return the parts into which a motion is divided.

    Parameters
    ----------
    request : PlanningRequest
        Via points, and where the arm rests.

    Returns
    -------
    list of Span
        In order; each begins where the one before ends.

    """
    at = request.rest_points.tolist()
    return [Span(*ends) for ends in zip(at, at[1:])]


def time_share(request: PlanningRequest, span: Span) -> ShouldStop:
    """
    Return the request's cancellation callback for a part of its motion.

    Parameters
    ----------
    request : PlanningRequest
        With a callback for the whole motion.
    span : Span
        The part; its share of the planning time is that of its segments.

    Returns
    -------
    callable
        See `core.cancellation.ShouldStop`.

    """
    n = request.segments
    return part_of(request.should_stop, span.last / n, span.first / n)


def spacing(request: PlanningRequest) -> float:
    """
    Return the sample period for which a motion is planned.

    Parameters
    ----------
    request : PlanningRequest
        With that of the answer.

    Returns
    -------
    float
        [s].

    """
    return min(request.sample_period, LONGEST_SPACING)


def same_tips(tips: Array) -> BoolArray:
    """
    Return at which points the tip is where it was at the one before.

    Parameters
    ----------
    tips : ndarray, shape (n, 3)
        Tip positions [m].

    Returns
    -------
    ndarray of bool, shape (n - 1,)
        Which.

    """
    return np.asarray(np.linalg.norm(np.diff(tips, axis=0), axis=1) <= TIP_ROUNDING)


def without_repeats(points: Array, same: BoolArray) -> Array:
    """
    Return points, each that repeats the one before replaced by it.

    Parameters
    ----------
    points : ndarray, shape (n, 3)
        Points.
    same : ndarray of bool, shape (n - 1,)
        Which of them, from the second on, repeat the one before.

    Returns
    -------
    ndarray, shape (n, 3)
        Of repeated points the first.

    """
    index = np.where(np.concatenate(([False], same)), 0, np.arange(len(points)))
    return points[np.maximum.accumulate(index)]
