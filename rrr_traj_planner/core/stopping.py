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

"""Bringing the arm to rest from any commanded state, within its limits."""

from __future__ import annotations

from math import inf

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.control import Desired
from rrr_traj_planner.core.desired_motion import DesiredMotion, through
from rrr_traj_planner.core.dynamics import inverse_dynamics
from rrr_traj_planner.core.limits import JointLimits
from rrr_traj_planner.core.model import RobotModel
from rrr_traj_planner.core.motion_points import MotionPoints
from rrr_traj_planner.core.nanoseconds import nanoseconds

# No stop is quicker than this, however wide the limits [s].
LEAST_TIME = 0.01

# Nothing takes longer, not even where numbers have overflowed [s].
LONGEST_TIME = 1e18

# Slower than this is rest [rad/s], [rad/s^2].
REST = 1e-12

# A stop that asks too much torque is slowed by this factor, at most so often (to 1/65 of the
# rate). Where no stop fits, the quickest is taken that asks hardly more than the gentlest.
SLOWING, SLOWINGS = 1.15, 30
HARDLY_MORE = 1.1

BISECTIONS = 30


def stopping(command: Desired, now: float, limits: JointLimits,
             model: RobotModel) -> DesiredMotion:
    """
    Return the quickest motion of its kind that brings the arm to rest.

    Each joint by itself: its velocity is the cubic that starts with the commanded velocity and
    acceleration and ends with neither, as short as its acceleration, jerk and torque limits
    allow. Where the command itself exceeds a limit, that much is allowed.

    Parameters
    ----------
    command : tuple of 9 floats
        Positions [rad], velocities [rad/s], accelerations [rad/s^2] commanded now.
    now : float
        When the stop begins [s].
    limits : JointLimits
        The limits.
    model : RobotModel
        The arm, for its torques.

    Returns
    -------
    DesiredMotion
        Starting now from the command.

    """
    q, qd, qdd = np.reshape(command, (3, 3))
    times = np.array([
        stopping_time(*x) for x in zip(qd.tolist(), qdd.tolist(), limits.max_acceleration.tolist(),
                                       limits.max_jerk.tolist())])
    stops, excesses = [], []
    for _ in range(SLOWINGS):
        stops.append(_stop(q, qd, qdd, times, now))
        excesses.append(_torque_excess(stops[-1], limits, model))
        if excesses[-1] <= 1.0 or not times.any():
            return stops[-1]
        times *= SLOWING
    least = min(excesses)
    return next(s for s, excess in zip(stops, excesses) if excess <= HARDLY_MORE * least)


def stopping_time(velocity: float, acceleration: float, max_acceleration: float,
                  max_jerk: float) -> float:
    """
    Return how long one joint takes to stop.

    Parameters
    ----------
    velocity, acceleration : float
        With which the stop begins [rad/s], [rad/s^2].
    max_acceleration, max_jerk : float
        Bounds on the magnitude [rad/s^2], [rad/s^3]; may be infinite.

    Returns
    -------
    float
        [s]; 0.0 for a joint at rest.

    """
    if abs(velocity) <= REST and abs(acceleration) <= REST:
        return 0.0
    bound = max(max_acceleration, abs(acceleration)) * (1.0 + 1e-9)

    def fits(T: float) -> bool:
        # with s = t / T: a(s) = a0 + (-6 v0/T - 4 a0) s + (6 v0/T + 3 a0) s^2
        slope, bend = -6.0 * velocity / T - 4.0 * acceleration, (
            6.0 * velocity / T + 3.0 * acceleration)
        jerk = max(abs(slope), abs(slope + 2.0 * bend)) / T
        s = -0.5 * slope / bend if bend else inf
        peak = acceleration + 0.5 * slope * s if 0.0 < s < 1.0 else acceleration
        return abs(peak) <= bound and jerk <= max_jerk

    long = LEAST_TIME
    if fits(long):
        return long
    while not fits(long) and long < LONGEST_TIME:
        long *= 2.0
    short = 0.5 * long
    for _ in range(BISECTIONS):
        middle = 0.5 * (short + long)
        short, long = (short, middle) if fits(middle) else (middle, long)
    return long


def _stop(q: Array, qd: Array, qdd: Array, times: Array, now: float) -> DesiredMotion:
    """Return the stop of all joints, each in its own time; quintics hold these quartics."""
    moving = times > 0.0
    T = np.where(moving, times, 1.0)
    qd, qdd = qd * moving, qdd * moving
    knots = np.unique(np.append(0.0, times))
    s = np.minimum(knots[:, np.newaxis] / T, 1.0)  # (n, 3)
    known = np.ones(len(knots), dtype=bool)
    points = MotionPoints(
        knots,
        q + T * (qd * (s - s ** 3 + s ** 4 / 2.0)
                 + qdd * T * (s ** 2 / 2.0 - 2.0 / 3.0 * s ** 3 + s ** 4 / 4.0)),
        qd * (1.0 - 3.0 * s ** 2 + 2.0 * s ** 3) + qdd * T * (s - 2.0 * s ** 2 + s ** 3),
        6.0 * qd / T * (s ** 2 - s) + qdd * (1.0 - 4.0 * s + 3.0 * s ** 2), known, known)
    return through(points, nanoseconds(now))


def _torque_excess(motion: DesiredMotion, limits: JointLimits, model: RobotModel) -> float:
    """Return the largest torque over its limit, or over the command's where that is larger."""
    states = np.array([
        motion(motion.origin + t) for t in np.linspace(0.0, float(motion.knots[-1]), 41)])
    torque = np.abs(inverse_dynamics(model, states[:, :3], states[:, 3:6], states[:, 6:]))
    bound = np.maximum(limits.max_effort, torque[0])
    return float((torque / bound).max())
