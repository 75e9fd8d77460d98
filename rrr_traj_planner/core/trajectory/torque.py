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

"""Motor torques along a motion: their peaks, and the time scaling that satisfies their limits."""

from __future__ import annotations

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.dynamics.rigid_body import gravity_torque
from rrr_traj_planner.core.trajectory.maximum import Extreme, maximum_over_time
from rrr_traj_planner.core.trajectory.torque_sweep import torque_grid, torque_sweep
from rrr_traj_planner.core.trajectory.trajectory import Trajectory

UNLIMITED = JointLimits(max_effort=np.full(3, np.inf))


def peak_torque(model: RobotModel, trajectory: Trajectory,
                limits: JointLimits | None = None) -> Extreme:
    """
    Return the largest magnitude of each motor's torque over the continuous motion.

    Torque of the motion (5.39) and friction, on either side of turning points.

    Parameters
    ----------
    model : RobotModel
        The arm.
    trajectory : Trajectory
        The motion.
    limits : JointLimits, optional
        Limits for which `time_scale_for_torque` is needed too: both are found together.

    Returns
    -------
    Extreme
        Torques [N m] and their times.

    """
    return torque_sweep(model, trajectory).peaks(limits or UNLIMITED, trajectory).effort


def peak_holding_torque(model: RobotModel, trajectory: Trajectory) -> Extreme:
    """
    Return the largest gravity torque of each joint along a path, which needs no friction.

    Parameters
    ----------
    model : RobotModel
        The arm.
    trajectory : Trajectory
        The motion.

    Returns
    -------
    Extreme
        Torques [N m] and their times.

    """
    return maximum_over_time(lambda t: np.abs(gravity_torque(model, trajectory(t)[0])),
                             torque_grid(trajectory))


def time_scale_for_torque(model: RobotModel, limits: JointLimits,
                          trajectory: Trajectory) -> Extreme:
    """
    Return the time-scaling factor that each joint's torque limit requires of a motion.

    Parameters
    ----------
    model : RobotModel
        The arm.
    limits : JointLimits
        Effort limits, infinite where there is none.
    trajectory : Trajectory
        The motion.

    Returns
    -------
    Extreme
        Least factors at which each joint's torque is within its limit, below 1 where there is a
        margin; and the times at which they bind.

    """
    if not np.isfinite(limits.max_effort).any():
        return Extreme(np.zeros(3), np.zeros(3))
    return torque_sweep(model, trajectory).peaks(limits, trajectory).scaling
