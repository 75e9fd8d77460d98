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

"""Figures of a run: peaks with their limits, and distances from the path."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.path.deviation import distance_from_polyline
from rrr_traj_planner.nodes.runs.run import Run
from rrr_traj_planner_interfaces.srv import PlanTrajectory


class Peaks(NamedTuple):
    """Peaks of one quantity, for each joint."""

    name: str
    peak: Array
    limit: Array  # inf: none
    unit: str


def peaks(response: PlanTrajectory.Response, limits: JointLimits) -> list[Peaks]:
    """
    Return the peaks of a plan.

    Parameters
    ----------
    response : PlanTrajectory.Response
        The plan.
    limits : JointLimits
        Those in force.

    Returns
    -------
    list of Peaks
        Velocity, acceleration, jerk and torque.

    """
    r = response
    return [Peaks('velocity', np.array(r.peak_velocity), limits.max_velocity, 'rad/s'),
            Peaks('acceleration', np.array(r.peak_acceleration), limits.max_acceleration,
                  'rad/s^2'),
            Peaks('jerk', np.array(r.peak_jerk), limits.max_jerk, 'rad/s^3'),
            Peaks('torque', np.array(r.peak_effort), limits.max_effort, 'N m')]


def executed_torque(run: Run) -> Array:
    """
    Return the largest recorded torque of each motor.

    Parameters
    ----------
    run : Run
        The run.

    Returns
    -------
    ndarray
        Magnitudes [N m], shape (3,); empty where the arm does not publish them.

    """
    return np.zeros(0) if run.torque is None else np.asarray(np.abs(run.torque).max(axis=0))


def deviations(run: Run) -> tuple[float, float]:
    """
    Return the tip's largest distances from the polyline through the via points.

    Parameters
    ----------
    run : Run
        The run.

    Returns
    -------
    tuple of float
        Of the planned and of the executed motion [m].

    """
    moving = run.recorded.times >= 0.0
    tips = [forward_kinematics(run.config.model, q) for q in (
        run.planned.positions, run.recorded.positions[moving])]
    corners = np.vstack((tips[0][:1], run.tips)) if run.started else run.tips
    planned, executed = (float(distance_from_polyline(corners, tip).max()) for tip in tips)
    return planned, executed
