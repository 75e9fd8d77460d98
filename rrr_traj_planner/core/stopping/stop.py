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
Bringing the arm to rest from the motion it is in: inside its ranges, as fast as its limits allow.

Candidates are brakes of each joint by itself and the motion itself ever more slowly, either at
once or after the motion has been followed for a while, down to its own end. Whatever the state of
a motion that ends at rest inside the ranges, one of them keeps ranges and limits; of those that
do, the quickest is taken. From other states each joint brakes as hard as its range asks, at once
where it is at its end or beyond, and what that breaks is told.
"""

from __future__ import annotations

from math import inf
from typing import NamedTuple, Protocol

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.stopping.candidates import Indices, JointBrakes, Slowdowns
from rrr_traj_planner.core.stopping.joint_brake import greatest_deceleration
from rrr_traj_planner.core.stopping.point_to_point import moved_on, quickest
from rrr_traj_planner.core.stopping.stop_warnings import harder, outside, torques_beyond
from rrr_traj_planner.core.stopping.task import POSITION_TOLERANCE, StopTask, time_inside
from rrr_traj_planner.core.trajectory.reference_trajectory import ReferenceTrajectory

# Slower than this a joint is at rest where a motion ends [rad/s].
REST = 1e-6

# How long a motion is followed before the brake: from the first of these times on, each so much
# longer than the one before [s].
FIRST_DELAY, DELAY_RATIO = 0.005, 1.5

# Candidates brake with these parts of the greatest deceleration, where torque asks for less.
RATES = 1.3 ** -np.arange(22.0)

# Times that a motion takes to slow down [s].
SLOWDOWNS = 0.01 * 1.3 ** np.arange(30.0)

# Where keeping the jerk limit would take so many times as long as jerk itself asks for, jerk is
# allowed to be so many times its limit, and a second then costs so much more.
PATIENCE = 2.5
JERK_FACTORS = ((4.0, 1.5), (inf, 2.5))

# Candidates are looked at in groups, at so many instants each, and at more before one is taken.
GROUP, COARSE, FINE = 48, 25, 241
LIMIT_TOLERANCE = 1e-4

# A joint that is to stop in less time than this stands at once [s].
INSTANT = 1e-3


class Stop(NamedTuple):
    """
    A motion to rest.

    Attributes
    ----------
    motion : ReferenceTrajectory
        Starting now from the state, or already under way; at rest inside every range at last.
    warnings : tuple of str
        What could not be kept, a sentence for each joint; empty where all is well.

    """

    motion: ReferenceTrajectory
    warnings: tuple[str, ...] = ()


# A motion to rest, and what it costs.
Found = tuple[ReferenceTrajectory, float]


class Family(Protocol):
    """Candidates of one kind."""

    cost: Array

    def excess(self, chosen: Indices, samples: int) -> Array:
        """
        Return the largest share of a limit that candidates take.

        Parameters
        ----------
        chosen : ndarray of int, shape (k,)
            Which candidates.
        samples : int
            At how many instants they are looked at.

        Returns
        -------
        ndarray, shape (k,)
            At most 1 where all limits are kept.

        """

    def motion(self, i: int) -> ReferenceTrajectory:
        """
        Return a candidate.

        Parameters
        ----------
        i : int
            Which.

        Returns
        -------
        ReferenceTrajectory
            A motion to rest.

        """


def stop(motion: ReferenceTrajectory, now: float, limits: JointLimits, model: RobotModel) -> Stop:
    """
    Return the quickest way to rest that keeps every range and limit.

    Position and velocity go on from the motion's without a jump, acceleration too where jerk is
    limited, unless a joint has to stop at once. A joint outside its range stops and then goes back
    to its end.

    Parameters
    ----------
    motion : ReferenceTrajectory
        What the arm follows; of a state alone, `from_state`.
    now : float
        When the stop begins [s].
    limits : JointLimits
        The limits. Where the motion itself exceeds velocity, acceleration or torque, that much
        is allowed.
    model : RobotModel
        The arm, for its torques.

    Returns
    -------
    Stop
        The motion, and what had to be broken where the state left no other way.

    """
    task = StopTask(motion, now, limits, model)
    found, told = _within_limits(task), outside(task, motion.at(now)[0])
    if found is None:
        found, more = _as_hard_as_needed(task)
        told += more
    target = np.clip(found.final, limits.min_position, limits.max_position)
    if np.abs(target - found.final).max() > POSITION_TOLERANCE:
        found = moved_on(found, target, limits, model).motion
    found = ReferenceTrajectory(found.knots, found.coefficients, target, found.origin_ns)
    return Stop(found, tuple(told))


def _within_limits(task: StopTask) -> ReferenceTrajectory | None:
    """Return the cheapest candidate that keeps ranges and limits, if there is one."""
    delays, states = _delays(task)
    brakes = _joint_brakes(task, delays, states)
    patience = PATIENCE * float(brakes.cost[0])  # the quickest at once, were there jerk alone
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
        for i in group[family.excess(group, COARSE) <= 1.0 + LIMIT_TOLERANCE]:
            if family.excess(np.array([i]), FINE)[0] <= 1.0 + LIMIT_TOLERANCE:
                return family.motion(int(i)), float(family.cost[i])
    return best


def _joint_brakes(task: StopTask, delays: Array, states: tuple[Array, Array, Array],
                  factor: float = 1.0, weight: float = 1.0) -> JointBrakes:
    """Return the brakes of every joint by itself: at every rate after every delay."""
    limits = task.limits
    max_jerk = factor * limits.max_jerk
    greatest = greatest_deceleration(*states[1:], limits.max_acceleration, max_jerk)
    decelerations = (greatest[:, np.newaxis] * RATES[:, np.newaxis]).reshape(-1, 3)
    return JointBrakes(task, np.repeat(delays, len(RATES)),
                       tuple(np.repeat(x, len(RATES), axis=0) for x in states),
                       decelerations, max_jerk, weight)


def _slowdowns(task: StopTask, delays: Array) -> Slowdowns:
    """Return the motion slowed in every time after every delay, where it lasts that long."""
    delay, duration = (x.ravel() for x in np.meshgrid(delays, SLOWDOWNS))
    lasts = delay + 0.5 * duration <= delays[-1]
    return Slowdowns(task, delay[lasts], duration[lasts])


def _delays(task: StopTask) -> tuple[Array, tuple[Array, Array, Array]]:
    """Return how long the motion may be followed, inside the ranges, and its states then."""
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
    """Return the state at a motion's end, at which its last polynomial has a velocity."""
    if motion.ends_moving:
        return motion.final, motion.final_velocity, motion.final_acceleration
    rests = now >= motion.end or bool(np.abs(qd).max() <= REST)
    return (motion.final, np.zeros(3), np.zeros(3)) if rests else (motion.final, qd, qdd)


def _as_hard_as_needed(task: StopTask) -> tuple[ReferenceTrajectory, list[str]]:
    """Return a brake that ends inside the ranges, whatever it takes, and what that is."""
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
    share = brakes.excess(np.arange(n), FINE)
    found = brakes.motion(quickest(share))
    needed[at_once] = inf
    return found, (harder(task, q, qd, np.where(needed > np.abs(a), needed, 0.0))
                   + torques_beyond(task, found))
