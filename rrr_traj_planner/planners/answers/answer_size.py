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

"""A lower bound on a motion's duration, to reject requests whose answer has too many points."""

from __future__ import annotations

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.trajectory.sampling import check_size
from rrr_traj_planner.planners.request import PlanningRequest


def check_answer_size(limits: JointLimits, request: PlanningRequest, q: Array) -> None:
    """
    Reject a request whose answer has too many points even at the lower bound of its duration.

    Parameters
    ----------
    limits : JointLimits
        Scaled as requested.
    request : PlanningRequest
        For the time between points, and how many there may be.
    q : ndarray, shape (n, 3)
        Joint positions in the order in which they are passed [rad].

    Raises
    ------
    InvalidInputError
        If there would be more points than allowed.

    """
    at = request.rest_points
    least = sum(least_time(limits, q[a:b + 1]) for a, b in zip(at, at[1:]))
    check_size(least + float(request.rests.dwell.sum()), request.sample_period,
               request.max_points)


def least_time(limits: JointLimits, q: Array) -> float:
    """
    Return a lower bound on the time in which a motion passes points in turn, from rest to rest.

    With a velocity limit V a segment takes at least |dq| / V. With an acceleration limit A a joint
    that covers L in all takes at least 2 sqrt(L / A): its speed is below a triangle of slope A.

    Parameters
    ----------
    limits : JointLimits
        Velocity and acceleration limits.
    q : ndarray, shape (n, 3)
        Joint positions [rad].

    Returns
    -------
    float
        [s].

    """
    D = np.abs(np.diff(q, axis=0))
    with np.errstate(over='ignore'):  # infinity is a valid bound
        by_velocity = (D / limits.max_velocity).max(axis=1, initial=0.0).sum()
        by_acceleration = 2.0 * np.sqrt((D.sum(axis=0) / limits.max_acceleration).max())
    return float(max(by_velocity, by_acceleration))
