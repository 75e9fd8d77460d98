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
Trajectory replacement: a new trajectory takes over without a jump in the command.

If its first point lies ahead, one segment leads there from the present command, as in
joint_trajectory_controller (ros2_controllers, Jazzy), if it satisfies the limits. If not, or if
the first point is due or past (where that controller jumps onto it), a quintic joins the command
to the earliest later point that can be met on schedule within ranges and velocity, acceleration
and torque limits. If there is none, the arm goes to the last point as soon as the limits allow, by
one quintic or by a stop and a move; if that point is outside a range, the arm stops.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.core.control.trajectory_limits import outside_ranges
from rrr_traj_planner.core.dynamics.motor_torque import motor_torque
from rrr_traj_planner.core.errors import format_distinct
from rrr_traj_planner.core.nanoseconds import nanoseconds
from rrr_traj_planner.core.rounding import JOINT_ROUNDING
from rrr_traj_planner.core.states import Desired
from rrr_traj_planner.core.stopping.joint_brake import LEAST_TIME
from rrr_traj_planner.core.stopping.point_to_point import extended_by_move
from rrr_traj_planner.core.stopping.stop import Stop, stop
from rrr_traj_planner.core.stopping.task import from_state
from rrr_traj_planner.core.trajectory.bernstein import bernstein_forms, leaves
from rrr_traj_planner.core.trajectory.limit_check import TOLERANCE
from rrr_traj_planner.core.trajectory.quintic_spline import hermite, polynomial
from rrr_traj_planner.core.trajectory.reference_trajectory import (
    reference_through,
    ReferenceTrajectory,
)
from rrr_traj_planner.core.trajectory.trajectory_points import (
    segment_orders,
    TrajectoryPoints,
    with_start_state,
)

# Velocity [rad/s] up to which a command counts as on a trajectory; chosen: far above rounding, and
# below any velocity that a joint is commanded.
VELOCITY_TOLERANCE = 1e-6

BATCH = 256        # points that are tried at once; chosen: 2.5 s of points at 100 Hz

# Factors on the time left until the last point, tried in order if it cannot be met on schedule;
# chosen.
LATER = 1.15 ** np.arange(64.0)


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
        Limits of joining motions.
    model : RobotModel
        The arm.
    running : ReferenceTrajectory, optional
        What would be braked now (`motion_to_brake`); None: only the command is known.

    """

    now: float
    command: Desired
    limits: JointLimits
    model: RobotModel
    running: ReferenceTrajectory | None = None

    @property
    def states(self) -> tuple[Array, Array, Array]:
        """Position, velocity and acceleration of the command, shape (3,) each."""
        q, qd, qdd = np.reshape(self.command, (3, 3))
        return q, qd, qdd


class Replacement(NamedTuple):
    """
    The reference trajectory from now on.

    Attributes
    ----------
    motion : ReferenceTrajectory
        From the command on, or the new trajectory itself if the command is on it.
    warnings : tuple of str
        Limits that a stop on the way violates.
    holds : bool
        Whether the arm stops because the trajectory cannot be joined.

    """

    motion: ReferenceTrajectory
    warnings: tuple[str, ...] = ()
    holds: bool = False


def replacement(takeover: Takeover, points: TrajectoryPoints, origin_ns: int,
                least_lead: float) -> Replacement:
    """
    Return the reference trajectory from now on.

    Parameters
    ----------
    takeover : Takeover
        The present state.
    points : TrajectoryPoints
        The new trajectory.
    origin_ns : int
        Origin of the points' times [ns].
    least_lead : float
        A first point no further ahead than this is due now [s].

    Returns
    -------
    Replacement
        The motion, and warnings.

    """
    motion = reference_through(points, origin_ns)
    if motion.start > takeover.now + least_lead:
        whole = with_start_state(points, takeover.now - motion.origin, takeover.states)
        if _lead_keeps_limits(takeover, whole):
            return Replacement(reference_through(whole, origin_ns))
    elif _is_on(takeover, motion, points):
        return Replacement(motion)
    i = _first_in_reach(takeover, motion)
    return Replacement(_joined(takeover, motion, i)) if i >= 0 else _gone_to(takeover, motion)


def _lead_keeps_limits(takeover: Takeover, whole: TrajectoryPoints) -> bool:
    """
    Return whether the segment from the command to the first point satisfies the limits.

    The velocity of lines steps, with a stream of single points continually, which is allowed. For
    several points the step may not exceed the acceleration limit times the segment's time.
    """
    T = np.diff(whole.times[:2])
    known = int(segment_orders(whole)[0] + 1) // 2
    if known == 1 and len(whole.times) > 2:
        step = np.abs((whole.positions[1] - whole.positions[0]) / T - whole.velocities[0])
        if (step > takeover.limits.max_acceleration * T).any():
            return False
    ends = (whole.positions, whole.velocities, whole.accelerations)[:known]
    return bool(_within_limits(takeover, T, tuple(x[1:2] for x in ends))[0])


def _is_on(takeover: Takeover, motion: ReferenceTrajectory, points: TrajectoryPoints) -> bool:
    """Return whether the command is on the motion now; on a line its velocity may differ."""
    state = motion.end_state if motion.end <= takeover.now else motion(takeover.now)
    gap = np.abs(np.subtract(state, takeover.command))
    if gap[:3].max() > JOINT_ROUNDING:
        return False
    i = int(np.searchsorted(points.times, takeover.now - motion.origin, side='right')) - 1
    orders = segment_orders(points)
    linear = 0 <= i < len(orders) and orders[i] == 1
    return linear or bool(gap[3:6].max() <= VELOCITY_TOLERANCE)


def _first_in_reach(takeover: Takeover, motion: ReferenceTrajectory) -> int:
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


def _within_limits(takeover: Takeover, T: Array, ends: tuple[Array, ...]) -> BoolArray:
    """
    Return which end states can be met after times T (n,) within the limits.

    By quintics, or by cubics or lines if the ends have fewer derivatives. Limits are extended to
    the values of the command and of the end itself.
    """
    starts = takeover.states[:len(ends)]
    c = np.stack(np.broadcast_arrays(*hermite(T[:, np.newaxis], starts, ends)), axis=-1)
    c = np.pad(c, ((0, 0), (0, 0), (0, 6 - c.shape[-1])))
    met = np.ones(len(T), dtype=bool)
    for form, (low, high) in zip(bernstein_forms(c, T), _bounds(takeover, ends)):
        met &= ~leaves(form, low - TOLERANCE, high + TOLERANCE).any(axis=1)
    i = np.flatnonzero(met)
    # Torque is checked at 32 steps of time; chosen.
    times = np.linspace(0.0, 1.0, 33)[:, np.newaxis, np.newaxis] * T[i, np.newaxis]
    q, qd, qdd = (polynomial(np.moveaxis(c[i], -1, 0), times, order) for order in range(3))
    torque = np.abs(motor_torque(takeover.model, q, qd, qdd))
    allowed = np.maximum(torque[:1], torque[-1:])
    met[i] = (torque <= np.maximum(takeover.limits.max_effort, allowed)
              * (1.0 + TOLERANCE)).all(axis=(0, 2))
    return met


def _bounds(takeover: Takeover, ends: tuple[Array, ...]) -> list[tuple[Array, Array]]:
    """Return bounds on position, velocity and acceleration, (n, 3) each."""
    limits, starts = takeover.limits, takeover.states
    bounds = [(np.minimum(limits.min_position, np.minimum(starts[0], ends[0])),
               np.maximum(limits.max_position, np.maximum(starts[0], ends[0])))]
    for n, limit in enumerate((limits.max_velocity, limits.max_acceleration), start=1):
        end = np.abs(ends[n]) if n < len(ends) else np.zeros_like(ends[0])
        most = np.maximum(limit, np.maximum(np.abs(starts[n]), end)) * (1.0 + TOLERANCE)
        bounds.append((-most, most))
    return bounds


def _joined(takeover: Takeover, motion: ReferenceTrajectory, i: int) -> ReferenceTrajectory:
    """Return a quintic from the command to knot i, and the motion from there."""
    time = takeover.now - motion.origin
    join = hermite(float(motion.knots[i]) - time, takeover.states,
                   tuple(s[i] for s in motion.states()))
    return ReferenceTrajectory(
        np.append(time, motion.knots[i:]),
        np.concatenate((np.stack(join, axis=-1)[np.newaxis], motion.coefficients[i:])),
        motion.final, motion.origin_ns, motion.final_velocity, motion.final_acceleration)


def _gone_to(takeover: Takeover, motion: ReferenceTrajectory) -> Replacement:
    """
    Return a quintic to the motion's end, later than on schedule, or a stop and a move there.

    If the motion has a velocity at its end, the quintic leads to the position extrapolated with
    that velocity, if the arm can stop inside its ranges from there. If the move would exceed a
    torque limit, or the end is outside a range, the arm holds the position where it stopped.
    """
    if outside := _ends_outside(takeover, motion):
        stopped, warnings = _stopped(takeover)
        return Replacement(stopped, warnings + outside, holds=True)
    due = motion.end - takeover.now
    T = max(due, LEAST_TIME) * LATER
    q, qd, qdd = np.reshape(motion.end_state, (3, 3))
    q = q + qd * (T - due)[:, np.newaxis]
    met = _within_limits(takeover, T, (q, np.tile(qd, (len(T), 1)), np.tile(qdd, (len(T), 1))))
    rest = q + 0.5 * qd * np.abs(qd) / takeover.limits.max_acceleration
    met &= ~outside_ranges(np.stack((q, rest)), takeover.limits).any(axis=(0, 2))
    if met.any():
        i = int(np.argmax(met))
        late = ReferenceTrajectory(T[i:i + 1], np.zeros((0, 3, 6)), q[i],
                                   nanoseconds(takeover.now), qd, qdd)
        return Replacement(_joined(takeover, late, 0))
    stopped, warnings = _stopped(takeover)
    moved, torque = extended_by_move(stopped, motion.final, takeover.limits, takeover.model)
    unmet = tuple(
        f'moving to the last point requires {torque[i]:.1f} N m at {name}, limit '
        f'{takeover.limits.max_effort[i]:.1f} N m: holding position'
        for i, name in enumerate(takeover.model.joint_names)
        if torque[i] > takeover.limits.max_effort[i] * (1.0 + TOLERANCE))
    return Replacement(stopped if unmet else moved, warnings + unmet, bool(unmet))


def _stopped(takeover: Takeover) -> Stop:
    """Return a stop from the present."""
    moving = takeover.running or from_state(takeover.command, nanoseconds(takeover.now))
    return stop(moving, takeover.now, takeover.limits, takeover.model)


def _ends_outside(takeover: Takeover, motion: ReferenceTrajectory) -> tuple[str, ...]:
    """Return a sentence for each joint that a motion leaves outside its range."""
    q, limits = motion.final, takeover.limits
    return tuple(
        'the trajectory would end with {} at {} rad, range [{}, {}] rad: holding position'.format(
            name, *format_distinct(*map(float, bounds)))
        for name, beyond, *bounds in zip(
            takeover.model.joint_names, outside_ranges(q, limits), q, limits.min_position,
            limits.max_position) if beyond)
