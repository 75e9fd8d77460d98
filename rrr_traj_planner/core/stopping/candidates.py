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
Ways to bring the arm to rest, many at once: each joint by itself, or along the motion it is in.

A family of candidates says when each would be at rest and how good that is (`cost`), and tells of
some of them by how much they exceed the limits. The search for the best is in `stop`.
"""

from __future__ import annotations

from math import inf

import numpy as np
from numpy.typing import NDArray
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.dynamics.rigid_body import inverse_dynamics
from rrr_traj_planner.core.stopping.joint_brake import joint_brake, JointBrake
from rrr_traj_planner.core.stopping.task import POSITION_TOLERANCE, StopTask
from rrr_traj_planner.core.trajectory.quintic_spline import hermite
from rrr_traj_planner.core.trajectory.reference_trajectory import ReferenceTrajectory

Indices = NDArray[np.int_]

# Points of a slowing motion are no further apart, and but for the motion's own no nearer [s].
SPACING, LEAST_SPACING = 0.005, 1e-4

# Its clock is inverted by linear interpolation between so many times and so many steps of Newton's
# method with its rate, of at least so much.
INVERSION, NEWTON_STEPS, LEAST_RATE = 2001, 2, 1e-3

# What holds just before and just after a time is looked at so far from it [s].
ASIDE = 1e-7

# A motion of constant jerk, deceleration and jerk again: each jerk's share of the time.
JERK_SHARE = 1.0 / 3.0


class JointBrakes:
    """
    Each joint by itself, after the motion has been followed for a while.

    Parameters
    ----------
    task : StopTask
        The task.
    delays : ndarray, shape (n,)
        How long the motion is followed before [s].
    states : tuple of ndarray, shape (n, 3)
        Positions, velocities and accelerations then.
    decelerations, max_jerk : ndarray, shape (n, 3)
        Of the brakes [rad/s^2], [rad/s^3].
    weight : float
        Cost of a second until the arm rests.

    """

    def __init__(self, task: StopTask, delays: Array, states: tuple[Array, ...],
                 decelerations: Array, max_jerk: Array, weight: float = 1.0) -> None:
        self.task, self.delays = task, delays
        self.q, self.qd, self.qdd = states
        self.brakes = joint_brake(self.qd, self.qdd, decelerations, max_jerk)
        self.durations = self.brakes.duration.max(axis=-1)
        self.cost = weight * (delays + self.durations)

    def excess(self, chosen: Indices, samples: int) -> Array:
        """
        Return the largest share of a limit that candidates take; infinite outside a range.

        Parameters
        ----------
        chosen : ndarray of int, shape (k,)
            Which candidates.
        samples : int
            At how many instants they are looked at.

        Returns
        -------
        ndarray, shape (k,)
            At most 1 where all limits are kept. Where velocity or torque exceed a limit when the
            brake begins, that much is allowed.

        """
        task, q = self.task, self.q[chosen, np.newaxis]
        brakes = JointBrake(self.brakes.velocity[chosen, np.newaxis], *(
            x[:, chosen, np.newaxis] for x in self.brakes[1:]))
        t = self.durations[chosen, np.newaxis, np.newaxis] * np.linspace(
            0.0, 1.0, samples)[:, np.newaxis]
        way, qd, qdd, _ = brakes.at(t)
        at_first = np.abs(inverse_dynamics(task.model, q, qd[:, :1], self.qdd[chosen, np.newaxis]))
        share = np.maximum(
            task.torque_share(q + way, qd, qdd, at_first),
            np.abs(qd) / np.maximum(task.limits.max_velocity, np.abs(qd[:, :1])))
        low, high = task.ranges(q)
        least, greatest = brakes.extremes()
        outside = ((q + least < low - POSITION_TOLERANCE)
                   | (q + greatest > high + POSITION_TOLERANCE)).any(axis=(1, 2))
        worst = np.maximum(share.max(axis=(1, 2)), task.rest_share((q + way)[:, -1]))
        return np.where(outside, inf, worst)

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
            It includes what of the followed motion is still to come, and what has been.

        """
        brakes = JointBrake(self.brakes.velocity[i], *(x[:, i] for x in self.brakes[1:]))
        ends = np.cumsum(brakes.times, axis=0)
        knots = np.unique(np.append(0.0, ends))
        middles = 0.5 * (knots[:-1] + knots[1:])[:, np.newaxis]
        way, qd, qdd, jerk = brakes.at(middles)
        back = knots[:-1, np.newaxis] - middles  # from the middle of an interval to its start
        c = np.zeros((len(middles), 3, 6))
        c[..., 0] = self.q[i] + way + back * (qd + back * (qdd / 2.0 + back * jerk / 6.0))
        c[..., 1] = qd + back * (qdd + back * jerk / 2.0)
        c[..., 2] = (qdd + back * jerk) / 2.0
        c[..., 3] = jerk / 6.0
        final = self.q[i] + brakes.at(brakes.duration)[0]
        return _after(self.task, float(self.delays[i]), knots, c, final)


class Slowdowns:
    """
    Along the motion, which is followed ever more slowly, after a while at its own pace.

    The way on the motion's own clock is s(t), its rate 1 at first and 0 at last. With ' for the
    motion's derivatives: qd = q' sd, qdd = q'' sd^2 + q' sdd, and torque is linear in sd^2 and
    sdd (Bobrow, Dubowsky and Gibson, Int. J. Robotics Research 4(3), 1985).

    Parameters
    ----------
    task : StopTask
        The task.
    delays, durations : ndarray, shape (n,)
        How long the motion is followed at its own pace, and then slowed [s].

    """

    def __init__(self, task: StopTask, delays: Array, durations: Array) -> None:
        self.task, self.delays, self.durations = task, delays, durations
        share = JERK_SHARE if np.isfinite(task.limits.max_jerk).any() else 0.0
        peak = 1.0 / ((1.0 - share) * durations)
        jerk = peak / (share * durations) if share else np.full(len(durations), inf)
        self.clock = joint_brake(np.ones(len(durations)), np.zeros(len(durations)), peak, jerk)
        self.cost = delays + durations

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
            At most 1 where all limits are kept. What the motion itself asks for at the same
            place is allowed.

        """
        limits = self.task.limits
        t = self.durations[chosen, np.newaxis] * np.linspace(0.0, 1.0, samples)
        (q, p, pp, ppp), (qd, qdd, qddd) = self._states(chosen, t)
        at_pace = np.abs(inverse_dynamics(self.task.model, q, p, pp))
        shares = [self.task.torque_share(q, qd, qdd, at_pace),
                  np.abs(qdd) / np.maximum(limits.max_acceleration, np.abs(pp)),
                  np.abs(qddd) / limits.max_jerk]
        worst = np.stack(shares).max(axis=(0, 2, 3))
        return np.asarray(np.maximum(worst, self.task.rest_share(q[:, -1])))

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
            It includes what of the followed motion is still to come, and what has been.

        """
        t, chosen = self._knots(i), np.array([i])
        q = self._states(chosen, t[np.newaxis])[0][0][0]
        # Where the motion's own polynomials meet, velocity and acceleration may step.
        starts, ends = ([x[0] for x in self._states(chosen, times[np.newaxis])[1][:2]]
                        for times in (np.append(0.0, t[1:-1] + ASIDE), np.append(
                            t[1:-1] - ASIDE, t[-1])))
        ends[0][-1] = 0.0
        c = hermite(np.diff(t)[:, np.newaxis], (q[:-1], *starts), (q[1:], *ends))
        return _after(self.task, float(self.delays[i]), t, np.stack(c, axis=-1), q[-1])

    def _knots(self, i: int) -> Array:
        """Return times that are not far apart, and when the motion's own knots are passed."""
        T, motion, rates = float(self.durations[i]), self.task.motion, self._rates(np.array([i]))
        t = np.linspace(0.0, T, INVERSION)
        begin = self.task.now + self.delays[i] - motion.origin
        own = motion.knots - begin
        s = rates.at(t[np.newaxis])[0][0]
        own = own[(own > 0.0) & (own < s[-1])]
        passed = np.interp(own, s, t)
        for _ in range(NEWTON_STEPS):
            s, sd = (x[0] for x in rates.at(passed[np.newaxis])[:2])
            passed = passed - (s - own) / np.maximum(sd, LEAST_RATE)
        passed = passed[(passed > LEAST_SPACING) & (passed < T - LEAST_SPACING)]
        grid = np.linspace(0.0, T, 2 + int(T / SPACING))
        near = np.abs(grid[1:-1, np.newaxis] - passed).min(axis=1, initial=T) < LEAST_SPACING
        return np.concatenate((
            grid[:1], np.unique(np.concatenate((grid[1:-1][~near], passed))), grid[-1:]))

    def _rates(self, chosen: Indices) -> JointBrake:
        """Return how the motion's clock slows down, shape (k, 1)."""
        return JointBrake(self.clock.velocity[chosen, np.newaxis], *(
            x[:, chosen, np.newaxis] for x in self.clock[1:]))

    def _states(self, chosen: Indices, t: Array) -> tuple[tuple[Array, ...], tuple[Array, ...]]:
        """Return the motion's own states where candidates are at times (k, n), and theirs."""
        task = self.task
        s, *derivatives = self._rates(chosen).at(t)
        sd, sdd, sddd = (x[..., np.newaxis] for x in derivatives)
        q, p, pp, ppp = task.motion.at(task.now + self.delays[chosen, np.newaxis] + s)
        J = task.limits.max_jerk  # points of a plan have more now and then: not the stop's fault
        own = np.clip(ppp, -J, J)
        return (q, p, pp, ppp), (
            p * sd, pp * sd ** 2 + p * sdd, own * sd ** 3 + 3.0 * pp * sd * sdd + p * sddd)


def _after(task: StopTask, delay: float, knots: Array, coefficients: Array,
           final: Array) -> ReferenceTrajectory:
    """Return the motion that is followed for a while, then others."""
    motion = task.motion
    begin = task.now + delay - motion.origin
    n = int(np.searchsorted(motion.knots, begin)) if delay else 0
    before = motion.knots[:n]
    return ReferenceTrajectory(
        np.concatenate((before, begin + knots)),
        np.concatenate((motion.coefficients[:n], coefficients)), final, motion.origin_ns)
