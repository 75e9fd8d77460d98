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

"""A motion sampled for drawing, on both sides of every knot; torque and use of the limits."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.dynamics.motor_torque import motor_torque, rest_speed_of
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.kinematics.link_positions import link_positions
from rrr_traj_planner.core.path.path_trajectory import PathTrajectory
from rrr_traj_planner.core.trajectory.trajectory import times_within, Trajectory

STEPS_PER_MOTION = 500  # least number of samples
STEPS_PER_PIECE = 4     # least number of samples in a piece
SHORTEST = 1e-5  # of the motion's duration; shorter pieces are not drawn: they look like spikes
BEFORE = 1e-9    # s before a knot, where quantities that step at it have their left-hand limit


class Samples(NamedTuple):
    """A motion at increasing times, shape (n, 3) each."""

    t: Array         # [s], shape (n,)
    q: Array         # [rad]
    qd: Array        # [rad/s]
    qdd: Array       # [rad/s^2]
    qddd: Array      # [rad/s^3]
    torque: Array    # [N m]
    tip: Array       # [m]


def sampled(model: RobotModel, trajectory: Trajectory) -> Samples:
    """
    Return the samples of a motion for drawing.

    Parameters
    ----------
    model : RobotModel
        The arm.
    trajectory : Trajectory
        The motion.

    Returns
    -------
    Samples
        Two samples at every knot, so that steps are drawn as steps; the last one is just before
        the end.

    """
    t = drawing_times(trajectory)
    q, qd, qdd, qddd = trajectory(t)
    return Samples(t, q, qd, qdd, qddd, motor_torque(model, q, qd, qdd, rest_speed_of(qd)),
                   forward_kinematics(model, q))


def drawing_times(trajectory: Trajectory) -> Array:
    """
    Return the times at which a motion is drawn.

    Parameters
    ----------
    trajectory : Trajectory
        The motion.

    Returns
    -------
    ndarray
        Increasing times [s], on both sides of every knot; none in pieces shorter than `SHORTEST`.

    """
    knots = trajectory.knots
    grid = times_within(trajectory, STEPS_PER_PIECE, trajectory.duration / STEPS_PER_MOTION)
    t = np.unique(np.concatenate((grid[:-1], knots[1:] - BEFORE)))
    lasting = np.diff(knots) > SHORTEST * trajectory.duration
    return np.asarray(t[lasting[np.searchsorted(knots[1:-1], t, side='right')]])


def limit_use(samples: Samples, limits: JointLimits) -> dict[str, Array]:
    """
    Return a motion's use of every limit.

    Parameters
    ----------
    samples : Samples
        The motion.
    limits : JointLimits
        Its limits.

    Returns
    -------
    dict of str to ndarray, shape (n, 3)
        Magnitude / limit by the quantity's name; 0 if there is no limit.

    """
    return {
        'velocity': np.abs(samples.qd) / limits.max_velocity,
        'acceleration': np.abs(samples.qdd) / limits.max_acceleration,
        'jerk': np.abs(samples.qddd) / limits.max_jerk,
        'torque': np.abs(samples.torque) / limits.max_effort}


def tightest(use: dict[str, Array]) -> Array:
    """
    Return the largest use of any limit of any joint at each time.

    Parameters
    ----------
    use : dict
        From `limit_use`.

    Returns
    -------
    ndarray, shape (n,)
        Magnitude / limit.

    """
    return np.asarray(np.stack(list(use.values())).max(axis=(0, 2)))


def path_lengths(trajectory: PathTrajectory, t: Array) -> Array:
    """
    Return the path coordinate s at given times.

    Parameters
    ----------
    trajectory : PathTrajectory
        A motion along a path of the tip.
    t : ndarray, shape (n,)
        Times [s].

    Returns
    -------
    ndarray, shape (n,)
        Length along the path [m].

    """
    return np.asarray(trajectory.progress(t)[0])


def arm_points(model: RobotModel, q: Array) -> Array:
    """
    Return the positions of the arm's base, joints and tip.

    Parameters
    ----------
    model : RobotModel
        The arm.
    q : ndarray, shape (n, 3)
        Joint positions [rad].

    Returns
    -------
    ndarray, shape (n, m, 3)
        The m points of `link_positions` [m].

    """
    return np.array([link_positions(model, one) for one in q.tolist()])
