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
Candidate stopping motions, evaluated in batches.

A family gives each candidate's cost (weighted time to rest) and, on request, its largest ratio of
a quantity to its limit. The search for the cheapest feasible one (our own) is in `stop`. Time
scaling on a given path: Bobrow, Dubowsky and Gibson, Int. J. Robotics Research 4(3), 1985.
"""

from __future__ import annotations

from math import inf

import numpy as np
from numpy.typing import NDArray
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.dynamics.motor_torque import motor_torque
from rrr_traj_planner.core.rounding import JOINT_ROUNDING
from rrr_traj_planner.core.stopping.joint_brake import joint_brake, JointBrake
from rrr_traj_planner.core.stopping.task import StopTask
from rrr_traj_planner.core.trajectory.quintic_spline import hermite
from rrr_traj_planner.core.trajectory.reference_trajectory import ReferenceTrajectory

Indices = NDArray[np.int_]

# Largest and least spacing of the knots of a time-scaled stop [s], chosen; the knots of the
# original motion are retained.
SPACING, LEAST_SPACING = 0.005, 1e-4

# Offset for one-sided limits at a knot [s]; chosen: above the rounding of times, below any piece.
BESIDE_KNOT = 1e-7


class JointBrakes:
    """
    Independent braking of each joint, after a delay in which the motion is followed.

    Parameters
    ----------
    task : StopTask
        The task.
    delays : ndarray, shape (n,)
        Times for which the motion is followed first [s].
    states : tuple of ndarray, shape (n, 3)
        Positions, velocities and accelerations after the delays.
    decelerations, max_jerk : ndarray, shape (n, 3)
        Of the brakes [rad/s^2], [rad/s^3].
    weight : float
        Cost of a second until rest.

    """

    def __init__(self, task: StopTask, delays: Array, states: tuple[Array, ...],
                 decelerations: Array, max_jerk: Array, weight: float = 1.0) -> None:
        self.task, self.delays = task, delays
        self.q, self.qd, self.qdd = states
        self.brakes = joint_brake(self.qd, self.qdd, decelerations, max_jerk)
        self.durations = self.brakes.duration.max(axis=-1)
        self.cost = weight * (delays + self.durations)

    def limit_ratio(self, chosen: Indices, samples: int) -> Array:
        """
        Return candidates' largest ratio of a quantity to its limit; infinite outside a range.

        Parameters
        ----------
        chosen : ndarray of int, shape (k,)
            Indices of the candidates.
        samples : int
            Number of time samples.

        Returns
        -------
        ndarray, shape (k,)
            At most 1 where all limits are satisfied. A velocity or torque that exceeds its limit
            at the beginning of the brake takes the place of the limit.

        """
        task, q = self.task, self.q[chosen, np.newaxis]
        brakes = JointBrake(self.brakes.velocity[chosen, np.newaxis], *(
            x[:, chosen, np.newaxis] for x in self.brakes[1:]))
        ends = np.cumsum(self.brakes.times[:, chosen], axis=0)  # of phases: acceleration bends
        t = np.concatenate((self.durations[chosen, np.newaxis] * np.linspace(0.0, 1.0, samples),
                            *ends), axis=1)[..., np.newaxis]
        displacement, qd, qdd, _ = brakes.at(t)
        moved = q + displacement
        at_first = np.abs(motor_torque(task.model, q, qd[:, :1], self.qdd[chosen, np.newaxis]))
        ratio = np.maximum(
            task.torque_ratio(moved, qd, qdd, at_first),
            np.abs(qd) / np.maximum(task.limits.max_velocity, np.abs(qd[:, :1])))
        low, high = task.ranges(q)
        least, greatest = brakes.extremes()
        outside = ((q + least < low - JOINT_ROUNDING)
                   | (q + greatest > high + JOINT_ROUNDING)).any(axis=(1, 2))
        worst = np.maximum(ratio.max(axis=(1, 2)), task.holding_torque_ratio(moved[:, -1]))
        return np.where(outside, inf, worst)

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
        brakes = JointBrake(self.brakes.velocity[i], *(x[:, i] for x in self.brakes[1:]))
        ends = np.cumsum(brakes.times, axis=0)
        knots = np.unique(np.append(0.0, ends))
        middles = 0.5 * (knots[:-1] + knots[1:])[:, np.newaxis]
        displacement, qd, qdd, jerk = brakes.at(middles)
        back = knots[:-1, np.newaxis] - middles  # from the middle of an interval to its start
        c = np.zeros((len(middles), 3, 6))
        c[..., 0] = self.q[i] + displacement + back * (qd + back * (qdd / 2.0 + back * jerk / 6.0))
        c[..., 1] = qd + back * (qdd + back * jerk / 2.0)
        c[..., 2] = (qdd + back * jerk) / 2.0
        c[..., 3] = jerk / 6.0
        final = self.q[i] + brakes.at(brakes.duration)[0]
        return _after(self.task, float(self.delays[i]), knots, c, final)


class Slowdowns:
    """
    Time scaling of the current trajectory: nominal rate during the delay, then down to rest.

    The path is the same; s(t) is the time on the trajectory, and its rate ds/dt falls from 1 to 0.
    With ' for the trajectory's derivatives: qd = q' sd, qdd = q'' sd^2 + q' sdd, and torque is
    linear in sd^2 and sdd.

    Parameters
    ----------
    task : StopTask
        The task.
    delays, durations : ndarray, shape (n,)
        Times at the nominal rate, and of the slow-down after it [s].

    """

    def __init__(self, task: StopTask, delays: Array, durations: Array) -> None:
        self.task, self.delays, self.durations = task, delays, durations
        # Part of the slow-down that each of its two phases of constant jerk takes; chosen.
        fraction = 1.0 / 3.0 if np.isfinite(task.limits.max_jerk).any() else 0.0
        peak = 1.0 / ((1.0 - fraction) * durations)
        jerk = peak / (fraction * durations) if fraction else np.full(len(durations), inf)
        self.clock = joint_brake(np.ones(len(durations)), np.zeros(len(durations)), peak, jerk)
        self.cost = delays + durations

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
            At most 1 where all limits are satisfied. A value that exceeds its limit on the
            original trajectory, at the same position, takes the place of the limit.

        """
        limits = self.task.limits
        t = self.durations[chosen, np.newaxis] * np.linspace(0.0, 1.0, samples)
        (q, p, pp, ppp), (qd, qdd, qddd) = self._states(chosen, t)
        at_pace = np.abs(motor_torque(self.task.model, q, p, pp))
        ratios = [self.task.torque_ratio(q, qd, qdd, at_pace),
                  np.abs(qdd) / np.maximum(limits.max_acceleration, np.abs(pp)),
                  np.abs(qddd) / limits.max_jerk]
        worst = np.stack(ratios).max(axis=(0, 2, 3))
        return np.asarray(np.maximum(worst, self.task.holding_torque_ratio(q[:, -1])))

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
        t, chosen = self._knots(i), np.array([i])
        q = self._states(chosen, t[np.newaxis])[0][0][0]
        # At the original knots, velocity and acceleration may step.
        starts, ends = ([x[0] for x in self._states(chosen, times[np.newaxis])[1][:2]]
                        for times in (np.append(0.0, t[1:-1] + BESIDE_KNOT), np.append(
                            t[1:-1] - BESIDE_KNOT, t[-1])))
        ends[0][-1] = 0.0
        c = hermite(np.diff(t)[:, np.newaxis], (q[:-1], *starts), (q[1:], *ends))
        return _after(self.task, float(self.delays[i]), t, np.stack(c, axis=-1), q[-1])

    def _knots(self, i: int) -> Array:
        """Return the knots' times: closely spaced, and where the original knots are passed."""
        T, motion, rates = float(self.durations[i]), self.task.motion, self._rates(np.array([i]))
        t = np.linspace(0.0, T, 2001)
        begin = self.task.now + self.delays[i] - motion.origin
        own = motion.knots - begin
        s = rates.at(t[np.newaxis])[0][0]
        own = own[(own > 0.0) & (own < s[-1])]
        # s(t) inverted: linear interpolation, two Newton steps. ds/dt, 1 at first, vanishes at the
        # stop: the bound, chosen, only keeps the step finite there.
        passed = np.interp(own, s, t)
        for _ in range(2):
            s, sd = (x[0] for x in rates.at(passed[np.newaxis])[:2])
            passed = passed - (s - own) / np.maximum(sd, 1e-3)
        passed = passed[(passed > LEAST_SPACING) & (passed < T - LEAST_SPACING)]
        grid = np.linspace(0.0, T, 2 + int(T / SPACING))
        near = np.abs(grid[1:-1, np.newaxis] - passed).min(axis=1, initial=T) < LEAST_SPACING
        return np.concatenate((
            grid[:1], np.unique(np.concatenate((grid[1:-1][~near], passed))), grid[-1:]))

    def _rates(self, chosen: Indices) -> JointBrake:
        """Return s(t) of candidates, shape (k, 1)."""
        return JointBrake(self.clock.velocity[chosen, np.newaxis], *(
            x[:, chosen, np.newaxis] for x in self.clock[1:]))

    def _states(self, chosen: Indices, t: Array) -> tuple[tuple[Array, ...], tuple[Array, ...]]:
        """Return the original states at s(t), for times (k, n), and those of candidates."""
        task = self.task
        s, *derivatives = self._rates(chosen).at(t)
        sd, sdd, sddd = (x[..., np.newaxis] for x in derivatives)
        q, p, pp, ppp = task.motion.at(task.now + self.delays[chosen, np.newaxis] + s)
        # Sampled plans may exceed the jerk limit; clipped so that it does not count against stops.
        J = task.limits.max_jerk
        own = np.clip(ppp, -J, J)
        return (q, p, pp, ppp), (
            p * sd, pp * sd ** 2 + p * sdd, own * sd ** 3 + 3.0 * pp * sd * sdd + p * sddd)


def _after(task: StopTask, delay: float, knots: Array, coefficients: Array,
           final: Array) -> ReferenceTrajectory:
    """Return the original trajectory up to the delay, then polynomials between further knots."""
    motion = task.motion
    begin = task.now + delay - motion.origin
    n = int(np.searchsorted(motion.knots, begin)) if delay else 0
    before = motion.knots[:n]
    return ReferenceTrajectory(
        np.concatenate((before, begin + knots)),
        np.concatenate((motion.coefficients[:n], coefficients)), final, motion.origin_ns)
