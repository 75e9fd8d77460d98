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
`cycloid_approach_c`: lift-off, cruise, set-down in every segment (thesis 4.2, c; after Lin).

Lift-off is a transition from rest and set-down one to rest, both full-period cycloids: the arm
stops at every via point. `cycloid` has the same three parts with free via velocities, `poly_434`
has them with Lin's polynomials.
"""

from __future__ import annotations

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.kinematics.travel_time import ViaPointBehaviour
from rrr_traj_planner.core.motion_laws.cycloid_transitions import CYCLOID
from rrr_traj_planner.core.trajectory.piecewise import PiecewiseTrajectory
from rrr_traj_planner.core.trajectory.trajectory import Trajectory
from rrr_traj_planner.planners.registration import register
from rrr_traj_planner.planners.stops.stops_at_via_points import (
    kinematic_durations,
    stopping_motion,
)
from rrr_traj_planner.planners.tasks import JointTask
from rrr_traj_planner.planners.transitions.segment_motion import (
    Parts,
    quick_parts,
    Segments,
    trajectory,
)
from rrr_traj_planner.planners.transitions.via_problem import via_problem_of


@register('cycloid_approach_c', some_durations=True, passing=ViaPointBehaviour('stop'))
def plan(task: JointTask) -> Trajectory:
    """
    Return the fastest motion of approach (c), or one of prescribed durations.

    Parameters
    ----------
    task : JointTask
        Via points, the arm and its limits; durations that are NaN are free.

    Returns
    -------
    Trajectory
        Within the limits.

    Raises
    ------
    InvalidInputError
        If a joint has no acceleration limit.
    TimingError
        If prescribed durations are too short; with feasible ones.
    LimitViolationError
        If gravity alone exceeds an effort limit between the via points.

    """
    problem = via_problem_of(task, CYCLOID)
    quick = kinematic_durations(task, problem.rest_to_rest_times())
    rest = np.zeros_like(problem.displacements)
    parts = quick_parts(
        problem.law, Segments(rest, rest, quick[:, np.newaxis], problem.displacements))

    def motion(own: slice, durations: Array) -> PiecewiseTrajectory:
        T = durations[:, np.newaxis]
        factor = T / quick[own, np.newaxis]
        slowed = Parts(parts.first[own] * factor, parts.cruise[own] / factor,
                       parts.last[own] * factor)
        points = task.points[own.start:own.stop + 1]
        return trajectory(points, rest[own], rest[own], T, slowed, CYCLOID)

    return stopping_motion(task, quick, motion)
