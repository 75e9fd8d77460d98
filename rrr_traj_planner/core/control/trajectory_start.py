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
Where a new trajectory begins: whether the command is on it, or can be led to its first point.

A goal of the arm's action must be followed from its first point on, as
joint_trajectory_controller (ros2_controllers, Jazzy) does, unless it was under way already when
it arrived: `unmet_start` says what stands in the way.
"""

from __future__ import annotations

import numpy as np
from rrr_traj_planner.core.arm.degrees import explained_by_degrees, HINT
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.control.takeover import Segment, Takeover
from rrr_traj_planner.core.control.trajectory_limits import furthest, outside_ranges
from rrr_traj_planner.core.errors import format_distinct
from rrr_traj_planner.core.rounding import JOINT_ROUNDING
from rrr_traj_planner.core.trajectory.limit_check import TOLERANCE
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

# Distance of the command from the first point of a goal that begins now [rad], [rad/s]: a start
# that was measured differs from the command. MoveIt's default allowed_start_tolerance.
START_TOLERANCE = 0.01

UNITS = ('rad', 'rad/s', 'rad/s^2')
REACHES = '{} reaches {} {unit}, limit {} {unit}'
GOES = '{} goes to {} {unit}, range [{}, {}] {unit}'
NEEDS = '{} needs {} N m, limit {} N m'
STEP = '{} needs {} rad/s^2 for its step of velocity, limit {} rad/s^2'
ENDS_OUTSIDE = 'the trajectory would end with {} at {} rad, range [{}, {}] rad{}'
UNMET = 'The first point cannot be reached in time, it is due in {:.3f} s: {}'
AWAY = '{} is commanded {} {unit}, the first point, which is due now, has {} {unit}'
AWAY_END = ' (they may differ by {:g} {unit}; a point that is due later is moved to)'


def is_ahead(takeover: Takeover, motion: ReferenceTrajectory, least_lead: float) -> bool:
    """
    Return whether a motion begins later than now.

    Parameters
    ----------
    takeover : Takeover
        The present.
    motion : ReferenceTrajectory
        The motion.
    least_lead : float
        A first point no further ahead than this is due now [s].

    Returns
    -------
    bool
        Whether its first point is further ahead.

    """
    return motion.start > takeover.now + least_lead


def led_into(takeover: Takeover, points: TrajectoryPoints, origin: float) -> TrajectoryPoints:
    """
    Return points preceded by the command.

    Parameters
    ----------
    takeover : Takeover
        The present.
    points : TrajectoryPoints
        The new trajectory, which begins later.
    origin : float
        Origin of its times [s].

    Returns
    -------
    TrajectoryPoints
        With the lead-in segment, as joint_trajectory_controller has it.

    """
    return with_start_state(points, takeover.now - origin, takeover.states)


def lead_keeps_limits(takeover: Takeover, whole: TrajectoryPoints) -> bool:
    """
    Return whether the segment from the command to the first point is within the limits.

    The velocity of lines steps, with a stream of single points continually, which is allowed. For
    several points the step may not exceed the acceleration limit times the segment's time.

    Parameters
    ----------
    takeover : Takeover
        The present.
    whole : TrajectoryPoints
        From `led_into`.

    Returns
    -------
    bool
        Whether it is.

    """
    needed = _step_accelerations(takeover, whole)
    return bool((needed <= takeover.limits.max_acceleration * (1.0 + TOLERANCE)).all()
                and _lead(takeover, whole).are_within_limits()[0])


def is_on(takeover: Takeover, motion: ReferenceTrajectory, points: TrajectoryPoints) -> bool:
    """
    Return whether the command is on a motion now; on a line its velocity may differ.

    Parameters
    ----------
    takeover : Takeover
        The present.
    motion : ReferenceTrajectory
        The motion.
    points : TrajectoryPoints
        Of the motion.

    Returns
    -------
    bool
        To rounding.

    """
    state = motion.end_state if motion.end <= takeover.now else motion(takeover.now)
    gap = np.abs(np.subtract(state, takeover.command))
    if gap[:3].max() > JOINT_ROUNDING:
        return False
    return (_is_line(points, takeover.now - motion.origin)
            or bool(gap[3:6].max() <= VELOCITY_TOLERANCE))


def unmet_start(takeover: Takeover, points: TrajectoryPoints, origin_ns: int,
                least_lead: float) -> str:
    """
    Return why a trajectory cannot be followed from its first point on.

    Parameters
    ----------
    takeover : Takeover
        The present.
    points : TrajectoryPoints
        The trajectory.
    origin_ns : int
        Origin of its times [ns].
    least_lead : float
        A first point no further ahead than this is due now [s].

    Returns
    -------
    str
        A sentence: which joint exceeds what by how much, at the start or at the end. Empty if the
        trajectory can be followed, or if its first point has passed.

    """
    motion = reference_through(points, origin_ns)
    if outside := ends_outside(takeover, motion):
        return '; '.join(outside)
    if motion.start < takeover.now:
        return ''
    if not is_ahead(takeover, motion, least_lead):
        return '' if is_on(takeover, motion, points) else _away(takeover, motion, points)
    whole = led_into(takeover, points, motion.origin)
    if lead_keeps_limits(takeover, whole):
        return ''
    return UNMET.format(motion.start - takeover.now, '; '.join(_lead_excesses(takeover, whole)))


def ends_outside(takeover: Takeover, motion: ReferenceTrajectory) -> tuple[str, ...]:
    """
    Return which joints a motion leaves outside their ranges.

    Parameters
    ----------
    takeover : Takeover
        The present.
    motion : ReferenceTrajectory
        The motion.

    Returns
    -------
    tuple of str
        A sentence for each.

    """
    q, limits = motion.final, takeover.limits
    return tuple(
        ENDS_OUTSIDE.format(
            name, *format_distinct(*map(float, bounds)),
            HINT if explained_by_degrees(sent, *bounds[1:]) else '')
        for name, beyond, sent, *bounds in zip(
            takeover.model.joint_names, outside_ranges(q, limits), motion.states()[0].T, q,
            limits.min_position, limits.max_position) if beyond)


def _lead(takeover: Takeover, whole: TrajectoryPoints) -> Segment:
    """Return the segment that leads to the first point, by what that point carries."""
    known = int(segment_orders(whole)[0] + 1) // 2
    ends = (whole.positions, whole.velocities, whole.accelerations)[:known]
    return Segment(takeover, np.diff(whole.times[:2]), tuple(x[1:2] for x in ends))


def _step_accelerations(takeover: Takeover, whole: TrajectoryPoints) -> Array:
    """Return the accelerations (3,) that stand for the step of velocity at a line's beginning."""
    if segment_orders(whole)[0] > 1 or len(whole.times) == 2:
        return np.zeros(3)
    T = float(whole.times[1] - whole.times[0])
    return np.asarray(np.abs(
        (whole.positions[1] - whole.positions[0]) / T - whole.velocities[0]) / T)


def _lead_excesses(takeover: Takeover, whole: TrajectoryPoints) -> list[str]:
    """Return a sentence for each excess of the segment that leads to the first point."""
    names, limits, found = takeover.model.joint_names, takeover.limits, []
    lead = _lead(takeover, whole)
    for unit, form, (lows, highs) in zip(UNITS, lead.forms, lead.bounds):
        for j, name in enumerate(names):
            low, high = float(lows[0, j]), float(highs[0, j])
            value = furthest(form[:, j], low - TOLERANCE, high + TOLERANCE)
            if value is not None and unit == 'rad':
                found.append(GOES.format(name, *format_distinct(value, low, high), unit=unit))
            elif value is not None:
                found.append(REACHES.format(
                    name, *format_distinct(abs(value), high), unit=unit))
    steps = _step_accelerations(takeover, whole)
    torques, allowed = (x[:, 0] for x in lead.torques(np.array([0])))
    return found + [
        text.format(name, *format_distinct(float(value), float(limit)))
        for text, values, most in ((STEP, steps, limits.max_acceleration),
                                   (NEEDS, torques.max(axis=0), allowed[0]))
        for name, value, limit in zip(names, values, most) if value > limit * (1.0 + TOLERANCE)]


def _away(takeover: Takeover, motion: ReferenceTrajectory, points: TrajectoryPoints) -> str:
    """Return how far the command is from a motion that begins now; empty if it is near."""
    ends = motion(motion.start) if len(motion.coefficients) else motion.end_state
    found = []
    only_q = not points.has_velocity[0] or _is_line(points, float(points.times[0]))
    for n in range(1 if only_q else 2):
        for name, has, wanted in zip(
                takeover.model.joint_names, takeover.command[3 * n:], ends[3 * n:3 * n + 3]):
            if abs(has - wanted) > START_TOLERANCE:
                found.append(AWAY.format(name, *format_distinct(has, wanted), unit=UNITS[n])
                             + AWAY_END.format(START_TOLERANCE, unit=UNITS[n]))
    return '; '.join(found)


def _is_line(points: TrajectoryPoints, time: float) -> bool:
    """Return whether a trajectory is on a line at a time on its own clock."""
    i = int(np.searchsorted(points.times, time, side='right')) - 1
    orders = segment_orders(points)
    return 0 <= i < len(orders) and bool(orders[i] == 1)
