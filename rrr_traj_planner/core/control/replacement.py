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

from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.control.takeover import Segment, Takeover
from rrr_traj_planner.core.control.trajectory_limits import outside_ranges
from rrr_traj_planner.core.control.trajectory_start import (
    ends_outside,
    is_ahead,
    is_on,
    lead_keeps_limits,
    led_into,
)
from rrr_traj_planner.core.errors import counted
from rrr_traj_planner.core.nanoseconds import nanoseconds
from rrr_traj_planner.core.stopping.joint_brake import LEAST_TIME
from rrr_traj_planner.core.stopping.point_to_point import extended_by_move
from rrr_traj_planner.core.stopping.stop import Stop, stop
from rrr_traj_planner.core.stopping.task import from_state
from rrr_traj_planner.core.trajectory.limit_check import TOLERANCE
from rrr_traj_planner.core.trajectory.quintic_spline import hermite
from rrr_traj_planner.core.trajectory.reference_trajectory import (
    reference_through,
    ReferenceTrajectory,
)
from rrr_traj_planner.core.trajectory.trajectory_points import TrajectoryPoints

BATCH = 256        # points that are tried at once; chosen: 2.5 s of points at 100 Hz

# Factors on the time left until the last point, tried in order if it cannot be met on schedule;
# chosen.
LATER = 1.15 ** np.arange(64.0)


class Missed(NamedTuple):
    """
    What a motion does not reach in time.

    Attributes
    ----------
    points : int
        Number of points that are passed by, so without a last one that is reached late.
    text : str
        Says so; empty if all points are reached in time.

    """

    points: int = 0
    text: str = ''


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
    missed : Missed
        Which points the arm does not reach in time.

    """

    motion: ReferenceTrajectory
    warnings: tuple[str, ...] = ()
    holds: bool = False
    missed: Missed = Missed()


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
    if is_ahead(takeover, motion, least_lead):
        whole = led_into(takeover, points, motion.origin)
        if lead_keeps_limits(takeover, whole):
            return Replacement(reference_through(whole, origin_ns))
    elif is_on(takeover, motion, points):
        return Replacement(motion)
    i = _first_in_reach(takeover, motion)
    found = (Replacement(_joined(takeover, motion, i)) if i >= 0
             else _gone_to(takeover, motion))
    return found if found.holds else found._replace(missed=_missed(takeover, found, motion, i))


def _missed(takeover: Takeover, found: Replacement, motion: ReferenceTrajectory, i: int) -> Missed:
    """Return how many points are missed by joining a motion at knot i, or after its end (-1)."""
    n = len(motion.knots)
    ahead = int(np.searchsorted(motion.knots, takeover.now - motion.origin))
    count = max((i if i >= 0 else n - 1) - ahead, 0)
    if count == 0 and i >= 0:
        return Missed()
    missed = counted(count, 'point') + (' is' if count == 1 else ' are') + ' missed'
    if i >= 0:
        return Missed(
            count, f'{missed}: point {i + 1} of {n} is the first that can be reached in time')
    late = f'the last point is reached {found.motion.end - motion.end:.3f} s late'
    return Missed(count, f'{missed}, {late}' if count else late)


def _first_in_reach(takeover: Takeover, motion: ReferenceTrajectory) -> int:
    """Return the index of the earliest later knot that can be met on schedule, or -1."""
    time = takeover.now - motion.origin
    states = motion.states()
    for first in range(int(np.searchsorted(motion.knots, time, side='right')),
                       len(motion.knots), BATCH):
        batch = slice(first, first + BATCH)
        met = Segment(takeover, motion.knots[batch] - time,
                      tuple(s[batch] for s in states)).are_within_limits()
        if met.any():
            return first + int(np.argmax(met))
    return -1


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
    outside = tuple(f'{text}: holding position' for text in ends_outside(takeover, motion))
    if outside:
        stopped, warnings = _stopped(takeover)
        return Replacement(stopped, warnings + outside, holds=True)
    due = motion.end - takeover.now
    T = max(due, LEAST_TIME) * LATER
    q, qd, qdd = np.reshape(motion.end_state, (3, 3))
    q = q + qd * (T - due)[:, np.newaxis]
    met = Segment(takeover, T, (q, np.tile(qd, (len(T), 1)), np.tile(qdd, (len(T), 1)))
                  ).are_within_limits()
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
