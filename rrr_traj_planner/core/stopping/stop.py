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
Stopping motions.

Candidates: independent jerk-limited braking of each joint, or time scaling of the current motion
to rest (Bobrow, Dubowsky and Gibson 1985), each after an optional delay. The fastest one within
ranges and limits is chosen; the search is our own. If the current motion ends at rest within its
ranges, one exists. If none exists, each joint decelerates as required to stop within its range,
instantaneously at the range's end, and warnings list the limits violated.
"""

from __future__ import annotations

from math import inf
from typing import NamedTuple, Protocol

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.rounding import JOINT_ROUNDING
from rrr_traj_planner.core.stopping.candidates import Indices, JointBrakes, Slowdowns
from rrr_traj_planner.core.stopping.joint_brake import greatest_deceleration
from rrr_traj_planner.core.stopping.point_to_point import extended_by_move, quickest
from rrr_traj_planner.core.stopping.stop_warnings import (
    deceleration_warnings,
    range_warnings,
    torque_warnings,
)
from rrr_traj_planner.core.stopping.task import (
    FINE,
    LIMIT_TOLERANCE,
    StopTask,
    time_inside,
)
from rrr_traj_planner.core.trajectory.reference_trajectory import ReferenceTrajectory

# Candidate delays before braking: geometric sequence from FIRST_DELAY [s] with ratio DELAY_RATIO.
# This and the next two sequences are chosen.
FIRST_DELAY, DELAY_RATIO = 0.005, 1.5

# Decelerations of the candidates, over the largest: for torques that do not allow the largest.
RATES = 1.3 ** -np.arange(22.0)

# Candidate durations of a slow-down by time scaling [s].
SLOWDOWNS = 0.01 * 1.3 ** np.arange(30.0)

# If the best stop takes over PATIENCE times the bound from jerk alone, the jerk limit is relaxed
# by the first of each pair; the second weights the duration. Chosen.
PATIENCE = 2.5
JERK_FACTORS = ((4.0, 1.5), (inf, 2.5))

# Candidates that are checked at once, and time samples of the coarse check, which rules out most
# of them before the fine one; chosen.
GROUP, COARSE = 48, 25

# A joint that would have to stop in less time than this is stopped instantaneously (velocity
# step) [s]; chosen: one period of a controller at 1 kHz, which could not follow a ramp within it.
INSTANT = 1e-3


class Stop(NamedTuple):
    """
    A motion to rest.

    Attributes
    ----------
    motion : ReferenceTrajectory
        Starting now from the state, or already under way; at rest within every range at its end.
    warnings : tuple of str
        A sentence for each limit violated by a joint; empty if there is none.

    """

    motion: ReferenceTrajectory
    warnings: tuple[str, ...] = ()


# A motion to rest, and its cost.
Found = tuple[ReferenceTrajectory, float]


class Family(Protocol):
    """Candidate stops of one form, of which each has a cost: its weighted time to rest."""

    cost: Array

    def limit_ratio(self, chosen: Indices, samples: int) -> Array:
        """
        Return candidates' largest ratio of a quantity to its limit.

        Parameters
        ----------
        chosen : ndarray of int, shape (k,)
            Indices of the candidates.
        samples : int
            Number of time samples.

        Returns
        -------
        ndarray, shape (k,)
            At most 1 where all limits are satisfied.

        """

    def motion(self, i: int) -> ReferenceTrajectory:
        """
        Return candidate i: the original trajectory up to the delay, then the stop.

        Parameters
        ----------
        i : int
            Index of the candidate.

        Returns
        -------
        ReferenceTrajectory
            At rest at the end.

        """


def stop(motion: ReferenceTrajectory, now: float, limits: JointLimits, model: RobotModel) -> Stop:
    """
    Return the fastest stop within ranges and limits, and warnings for limits violated.

    Position and velocity are continuous, acceleration too where jerk is limited, unless a joint
    has to stop instantaneously. A joint outside its range stops and then returns to its end.

    Parameters
    ----------
    motion : ReferenceTrajectory
        The current motion; for a single state, `from_state`.
    now : float
        When the stop begins [s].
    limits : JointLimits
        The limits. A velocity, acceleration or torque of the motion itself that exceeds its limit
        takes the place of the limit.
    model : RobotModel
        The arm, for its torques.

    Returns
    -------
    Stop
        The motion, and warnings for limits that cannot be satisfied.

    """
    task = StopTask(motion, now, limits, model)
    found, warnings = _within_limits(task), range_warnings(task, motion.at(now)[0])
    if found is None:
        found, more = _within_ranges(task)
        warnings += more
    target = np.clip(found.final, limits.min_position, limits.max_position)
    if np.abs(target - found.final).max() > JOINT_ROUNDING:
        found = extended_by_move(found, target, limits, model).motion
    found = ReferenceTrajectory(found.knots, found.coefficients, target, found.origin_ns)
    return Stop(found, tuple(warnings))


def stop_of_state(motion: ReferenceTrajectory, limits: JointLimits,
                  model: RobotModel) -> ReferenceTrajectory | None:
    """
    Return the fastest stop of a single state within ranges and limits, that of jerk too.

    Parameters
    ----------
    motion : ReferenceTrajectory
        The state, as of `from_state`.
    limits : JointLimits
        Jerk is limited.
    model : RobotModel
        The arm, for its torques.

    Returns
    -------
    ReferenceTrajectory or None
        Its pieces have constant jerk. None where none of the candidates is within the limits.

    """
    task = StopTask(motion, 0.0, limits, model)
    best = _cheapest(_joint_brakes(task, *_delays(task)), None)
    return None if best is None else best[0]


def _within_limits(task: StopTask) -> ReferenceTrajectory | None:
    """Return the cheapest candidate within ranges and limits, if there is one."""
    delays, states = _delays(task)
    brakes = _joint_brakes(task, delays, states)
    patience = PATIENCE * float(brakes.cost[0])  # first: no delay, largest deceleration
    best = _cheapest(brakes, None)
    if best is None or best[1] > brakes.cost[0]:
        best = _cheapest(_slowdowns(task, delays), best)
    if (best is None or best[1] > patience) and np.isfinite(task.limits.max_jerk).any():
        for factor, weight in JERK_FACTORS:
            best = _cheapest(_joint_brakes(task, delays, states, factor, weight), best)
    return None if best is None else best[0]


def _cheapest(family: Family, best: Found | None) -> Found | None:
    """Return the cheapest candidate within the limits, or the best so far if that is cheaper."""
    order = np.argsort(family.cost, kind='stable')
    if best is not None:
        order = order[family.cost[order] < best[1]]
    for first in range(0, len(order), GROUP):
        group = order[first:first + GROUP]
        for i in group[family.limit_ratio(group, COARSE) <= 1.0 + LIMIT_TOLERANCE]:
            if family.limit_ratio(np.array([i]), FINE)[0] <= 1.0 + LIMIT_TOLERANCE:
                return family.motion(int(i)), float(family.cost[i])
    return best


def _joint_brakes(task: StopTask, delays: Array, states: tuple[Array, Array, Array],
                  factor: float = 1.0, weight: float = 1.0) -> JointBrakes:
    """Return independent brakes of the joints: with every deceleration after every delay."""
    limits = task.limits
    max_jerk = factor * limits.max_jerk
    greatest = greatest_deceleration(*states[1:], limits.max_acceleration, max_jerk)
    decelerations = (greatest[:, np.newaxis] * RATES[:, np.newaxis]).reshape(-1, 3)
    return JointBrakes(task, np.repeat(delays, len(RATES)),
                       tuple(np.repeat(x, len(RATES), axis=0) for x in states),
                       decelerations, max_jerk, weight)


def _slowdowns(task: StopTask, delays: Array) -> Slowdowns:
    """Return slow-downs of every duration after every delay, where the motion lasts that long."""
    delay, duration = (x.ravel() for x in np.meshgrid(delays, SLOWDOWNS))
    lasts = delay + 0.5 * duration <= delays[-1]
    return Slowdowns(task, delay[lasts], duration[lasts])


def _delays(task: StopTask) -> tuple[Array, tuple[Array, Array, Array]]:
    """Return the delays for which the motion stays within the ranges, and its states then."""
    motion, now = task.motion, task.now
    left = max(time_inside(motion, now, task.limits) - now, 0.0)
    n = int(np.log(max(left / FIRST_DELAY, 1.0)) / np.log(DELAY_RATIO))
    delays = np.unique(np.concatenate((
        [0.0, left], FIRST_DELAY * DELAY_RATIO ** np.arange(n))))
    q, qd, qdd, _ = motion.at(now + delays)
    if now + left >= motion.end:
        q[-1], qd[-1], qdd[-1] = _end(motion, now, qd[-1], qdd[-1])
    return delays, (q, qd, qdd)


def _end(motion: ReferenceTrajectory, now: float, qd: Array,
         qdd: Array) -> tuple[Array, Array, Array]:
    """Return the state at a motion's end, from which a stop there starts."""
    if motion.ends_moving:
        return motion.final, motion.final_velocity, motion.final_acceleration
    # Up to 1e-6 rad/s counts as rest: it is 1e-9 rad in a controller's period of 1 ms; chosen.
    rests = now >= motion.end or bool(np.abs(qd).max() <= 1e-6)
    return (motion.final, np.zeros(3), np.zeros(3)) if rests else (motion.final, qd, qdd)


def _within_ranges(task: StopTask) -> tuple[ReferenceTrajectory, list[str]]:
    """Return a stop within ranges that may exceed limits, and warnings for those violated."""
    q, qd, qdd = (x[0] for x in _delays(task)[1])
    low, high = task.ranges(q)
    distance = np.maximum(np.where(qd > 0.0, high - q, q - low), 0.0)
    at_once = 2.0 * distance < np.abs(qd) * INSTANT
    v, a = np.where(at_once, 0.0, qd), np.where(at_once, 0.0, qdd)
    needed = np.divide(0.5 * v ** 2, distance, out=np.zeros(3), where=v != 0.0)
    unlimited, n = np.full(3, inf), len(RATES)
    greatest = greatest_deceleration(v, a, task.limits.max_acceleration, unlimited)
    brakes = JointBrakes(task, np.zeros(n), tuple(np.tile(x, (n, 1)) for x in (q, v, a)),
                         np.maximum(greatest * RATES[:, np.newaxis], needed), unlimited)
    ratio = brakes.limit_ratio(np.arange(n), FINE)
    found = brakes.motion(quickest(ratio))
    needed[at_once] = inf
    return found, (deceleration_warnings(task, q, qd, np.where(needed > np.abs(a), needed, 0.0))
                   + torque_warnings(task, found))
