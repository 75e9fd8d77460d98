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
`time_optimal`: as fast as velocity, acceleration, jerk and torque allow, jerk continuous.

Jerk is linear in each interval of a mesh and continuous everywhere, also through via points
(`solver.splines`). Node jerks, the states at via points and durations are optimised together
(direct transcription: Betts, Practical Methods for Optimal Control, 2010) by a feasible
interior-point method (`solver.interior_point`), starting from a motion with stops at every via
point. Squared jerk has a small weight in the objective (`solver.limits.SMOOTHNESS`). Between two
rough solutions and the last one the mesh is refined (`solver.refinement`).

From a state of motion from which no motion is found that goes straight on, the arm stops first, as
when it is held: jerk has steps until it rests, and the motion's note says so.
"""

from __future__ import annotations

from dataclasses import replace
from statistics import median

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.kinematics.travel_time import ViaPointBehaviour
from rrr_traj_planner.core.trajectory.trajectory import Trajectory
from rrr_traj_planner.planners.joint_timing.least_time import fastest
from rrr_traj_planner.planners.joint_timing.meshing import first_mesh, least_times
from rrr_traj_planner.planners.joint_timing.passed_at_once import (
    passing,
    times_of_points_passed_at_once,
    without_first_points,
)
from rrr_traj_planner.planners.joint_timing.prescribed import prescribed
from rrr_traj_planner.planners.joint_timing.problem import Solved
from rrr_traj_planner.planners.joint_timing.start import cannot_be_held
from rrr_traj_planner.planners.registration import register
from rrr_traj_planner.planners.sampling_jerk_limit import acceleration_scale, limits_for_sampling
from rrr_traj_planner.planners.solver.convergence import unconverged_note
from rrr_traj_planner.planners.solver.splines import Mesh, uniform_mesh
from rrr_traj_planner.planners.tasks import JointTask

# Numbers of intervals, chosen.
INTERVALS = 24        # in a segment
INTERVALS_ALONE = 40  # in a motion's only segment, with both acceleration and deceleration,
ALONE_BY_TORQUE = 60  # and where torque alone limits them
MOST_INTERVALS = 40   # in a segment where the jerk limit allows short changes of acceleration
SHAPED = 0.1          # acceleration reversal / segment, by duration: INTERVALS suffice above it
SAMPLES = (10.0, 30.0, 100.0)  # of the longest segment, tried where torque would allow fewer
FROM_START = 2.0  # largest acceleration there, over that of a moving start
MEAN_ACCELERATION = 0.9  # of a change of velocity, over its peak: ramps are about a tenth of it


@register('time_optimal', some_durations=True, needs_acceleration_limit=False,
          starts_moving=True, passing=ViaPointBehaviour(mean_acceleration=MEAN_ACCELERATION))
def plan(task: JointTask) -> Trajectory:
    """
    Return the fastest motion, or that of prescribed durations and least peak acceleration.

    Parameters
    ----------
    task : JointTask
        Via points, the arm and its limits; durations that are NaN are free.

    Returns
    -------
    Trajectory
        Within the limits; its note tells if the method ended before it converged, and if the arm
        stops first.

    Raises
    ------
    InvalidInputError
        If a joint has neither an acceleration nor an effort limit.
    TimingError
        If prescribed durations are too short; with feasible ones.
    LimitViolationError
        If no path between two via points is found along which the motors can hold the arm.

    """
    scale = acceleration_scale(task.model, task.limits, task.points)
    limits = limits_for_sampling(task.limits, scale, task.sample_period)
    rise = task.least_jerk_rise
    if np.isinf(task.limits.max_jerk).any():  # else there is no limit to rise to
        rise = min(rise, task.sample_period)
    task = replace(task, limits=limits, least_jerk_rise=rise)
    at_once = np.zeros(0)
    if task.start_rates is not None:
        at_once = times_of_points_passed_at_once(task)
        task = without_first_points(task, len(at_once))
    n = _intervals(task, scale)
    if task.durations is not None:
        found = prescribed(task, uniform_mesh(len(task.points) - 1, n), task.durations)
    else:
        mesh = first_mesh(task, scale, n)
        found = fastest(task, mesh) or _at_a_sampled_pace(task, mesh)
    if found is None:
        raise cannot_be_held(task, n)
    trajectory = passing(found.trajectory, at_once)
    return trajectory.noted('; '.join(filter(None, (
        trajectory.note, unconverged_note(found.gap, found.cost)))))


def _at_a_sampled_pace(task: JointTask, mesh: Mesh) -> Solved | None:
    """
    Return the fastest motion whose longest segment takes at least some sample periods.

    Effort limits out of all proportion to the arm, as those of placeholders in a URDF, would allow
    motions within a sample period or two, which no sampled motion represents. None where they are
    not so large, or no motion is found.
    """
    way = float(np.abs(np.diff(task.points, axis=0)).max())
    scale = acceleration_scale(task.model, task.limits, task.points)
    v, a = task.start_rates or np.zeros((2, 3))
    for samples in SAMPLES:
        shortest = samples * task.sample_period
        most = np.maximum(4.0 * way / shortest ** 2,  # from rest to rest
                          np.maximum(np.abs(v) / shortest, FROM_START * np.abs(a)))
        if (scale <= most).all():
            continue
        found = fastest(replace(task, limits=replace(task.limits, max_acceleration=np.minimum(
            task.limits.max_acceleration, most))), mesh)
        if found is not None:
            return found
    return None


def _intervals(task: JointTask, scale: Array) -> int:
    """
    Return the number of a segment's intervals: more where the jerk limit allows short ones.

    scale: the largest acceleration of each joint, shape (3,) [rad/s^2].
    """
    times = least_times(task, scale).tolist()
    T = median(times)
    swing = float((np.pi * scale / task.limits.max_jerk).max())
    n = INTERVALS
    if len(times) == 1:
        by_torque = np.isinf(task.limits.max_acceleration).any()
        n = ALONE_BY_TORQUE if by_torque else INTERVALS_ALONE
    if swing >= SHAPED * T:
        return n
    return int(np.clip(T / task.sample_period, n, max(n, MOST_INTERVALS)))  # no shorter than it
