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
How a new trajectory takes over from the running one without a jump in what is commanded.

Where its first point lies ahead, one segment leads there from the present command, as in
joint_trajectory_controller. Where its first point is due or past, that controller jumps onto the
trajectory; here, and here alone, we are gentler: the command joins it by a quintic at the
earliest later point that can be met on schedule within the joints' velocity and acceleration
limits. Where none can, the arm stops and goes to the last point as fast as its limits allow.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.control import Desired
from rrr_traj_planner.core.desired_motion import DesiredMotion, through
from rrr_traj_planner.core.interpolation import hermite
from rrr_traj_planner.core.limits import JointLimits
from rrr_traj_planner.core.model import RobotModel
from rrr_traj_planner.core.motion_points import MotionPoints, segment_orders
from rrr_traj_planner.core.stopping import LEAST_TIME, stopping

# A command this near to a trajectory is on it [rad], [rad/s].
POSITION_TOLERANCE, VELOCITY_TOLERANCE = 1e-9, 1e-6

# Limits are kept on this many steps of a join, to this relative tolerance.
STEPS, LIMIT_TOLERANCE = 32, 1e-6

# Points that are tried at once.
BATCH = 256

# Peaks of the quintic from rest to rest over distance d and time T: 1.875 d/T, 5.7735 d/T^2.
PEAK_VELOCITY, PEAK_ACCELERATION = 15.0 / 8.0, 10.0 / 3.0 ** 0.5


@dataclass(frozen=True, eq=False)
class Takeover:
    """
    The instant at which a new trajectory takes over.

    Parameters
    ----------
    now : float
        [s].
    command : tuple of 9 floats
        Positions [rad], velocities [rad/s], accelerations [rad/s^2] commanded now.
    limits : JointLimits
        Kept where a trajectory has to be joined.
    model : RobotModel
        The arm.

    """

    now: float
    command: Desired
    limits: JointLimits
    model: RobotModel

    @property
    def states(self) -> tuple[Array, Array, Array]:
        """Position, velocity and acceleration of the command, shape (3,) each."""
        q, qd, qdd = np.reshape(self.command, (3, 3))
        return q, qd, qdd


def replacement(takeover: Takeover, points: MotionPoints, origin_ns: int,
                least_lead: float) -> DesiredMotion:
    """
    Return what the arm follows from now on.

    Parameters
    ----------
    takeover : Takeover
        The present.
    points : MotionPoints
        The new trajectory.
    origin_ns : int
        What the points' times are counted from [ns].
    least_lead : float
        A first point no further ahead than this is due now [s].

    Returns
    -------
    DesiredMotion
        Starting from the command, or already under way where the command is on it.

    """
    motion = through(points, origin_ns)
    if motion.start > takeover.now + least_lead:
        return through(_led_in(takeover, points, takeover.now - motion.origin), origin_ns)
    if _is_on(takeover, motion, points):
        return motion
    i = _first_in_reach(takeover, motion)
    return _joined(takeover, motion, i) if i >= 0 else _gone_to(takeover, motion.final)


def _led_in(takeover: Takeover, points: MotionPoints, time: float) -> MotionPoints:
    """Return the command followed by the points."""
    q, qd, qdd = takeover.states
    return MotionPoints(
        np.append(time, points.times), np.vstack((q, points.positions)),
        np.vstack((qd, points.velocities)), np.vstack((qdd, points.accelerations)),
        np.append(True, points.has_velocity), np.append(True, points.has_acceleration))


def _is_on(takeover: Takeover, motion: DesiredMotion, points: MotionPoints) -> bool:
    """Return whether the command is on the motion now; on a line, its velocity may differ."""
    gap = np.abs(np.subtract(motion(takeover.now), takeover.command))
    if gap[:3].max() > POSITION_TOLERANCE:
        return False
    i = int(np.searchsorted(points.times, takeover.now - motion.origin, side='right')) - 1
    orders = segment_orders(points)
    linear = 0 <= i < len(orders) and orders[i] == 1
    return linear or bool(gap[3:6].max() <= VELOCITY_TOLERANCE)


def _first_in_reach(takeover: Takeover, motion: DesiredMotion) -> int:
    """Return the index of the earliest later knot that can be met on schedule, or -1."""
    time = takeover.now - motion.origin
    states = motion.states()
    for first in range(int(np.searchsorted(motion.knots, time, side='right')),
                       len(motion.knots), BATCH):
        batch = slice(first, first + BATCH)
        met = _within_limits(takeover, motion.knots[batch] - time,
                             tuple(s[batch] for s in states))
        if met.any():
            return first + int(np.argmax(met))
    return -1


def _within_limits(takeover: Takeover, T: Array, ends: tuple[Array, ...]) -> Array:
    """
    Return which ends can be met after times T (n,), by quintics within the limits.

    Where the command or an end itself exceeds a limit, that much is allowed.
    """
    limits, starts = takeover.limits, takeover.states
    bounds = (limits.max_velocity, limits.max_acceleration)
    upper = [np.maximum(limits.max_position, np.maximum(starts[0], ends[0]))]
    lower = [np.minimum(limits.min_position, np.minimum(starts[0], ends[0]))]
    for n, bound in enumerate(bounds, start=1):
        upper.append(np.maximum(bound, np.maximum(np.abs(starts[n]), np.abs(ends[n])))
                     * (1.0 + LIMIT_TOLERANCE))
        lower.append(-upper[-1])
    x = (np.linspace(0.0, 1.0, STEPS + 1) * T[:, np.newaxis])[..., np.newaxis]
    c = np.stack(np.broadcast_arrays(*hermite(T[:, np.newaxis], starts, ends)))
    met = np.ones(len(T), dtype=bool)
    for low, high in zip(lower, upper):
        value = np.zeros((len(T), STEPS + 1, 3))
        for coefficient in c[::-1]:
            value = value * x + coefficient[:, np.newaxis]
        room = LIMIT_TOLERANCE
        met &= ((value >= low[:, np.newaxis] - room)
                & (value <= high[:, np.newaxis] + room)).all(axis=(1, 2))
        c = c[1:] * np.arange(1, len(c))[:, np.newaxis, np.newaxis]  # the next derivative
    return met


def _joined(takeover: Takeover, motion: DesiredMotion, i: int) -> DesiredMotion:
    """Return a quintic from the command to knot i, and the motion from there."""
    time = takeover.now - motion.origin
    join = hermite(float(motion.knots[i]) - time, takeover.states,
                   tuple(s[i] for s in motion.states()))
    return DesiredMotion(
        np.append(time, motion.knots[i:]),
        np.concatenate((np.stack(join, axis=-1)[np.newaxis], motion.coefficients[i:])),
        motion.final, motion.origin_ns)


def _gone_to(takeover: Takeover, target: Array) -> DesiredMotion:
    """Return a stop, then a quintic to rest at the target, as fast as the limits allow."""
    stop = stopping(takeover.command, takeover.now, takeover.limits, takeover.model)
    distance = np.abs(target - stop.final)
    T = float(np.maximum(
        PEAK_VELOCITY * distance / takeover.limits.max_velocity,
        np.sqrt(PEAK_ACCELERATION * distance / takeover.limits.max_acceleration)).max())
    if not distance.any():
        return stop
    T = max(T, LEAST_TIME)
    zero = np.zeros(3)
    move = np.stack(hermite(T, (stop.final, zero, zero), (target, zero, zero)), axis=-1)
    return DesiredMotion(np.append(stop.knots, stop.knots[-1] + T),
                         np.concatenate((stop.coefficients, move[np.newaxis])),
                         target, stop.origin_ns)
