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
Check of the quintic spline that a controller interpolates between the points of an answer.

joint_trajectory_controller interpolates with the polynomial of fifth degree that meets position,
velocity and acceleration at both points. It approximates the planned motion: between points its
velocity, acceleration and torque may exceed limits that the planned motion satisfies.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array, BoolArray, IntArray
from rrr_traj_planner.core.cancellation import never, ShouldStop
from rrr_traj_planner.core.dynamics.motor_torque import (
    direction_of,
    rest_speed_of,
    smooth_motor_torque,
)
from rrr_traj_planner.core.trajectory.bernstein import bernstein_forms, through_samples
from rrr_traj_planner.core.trajectory.quintic_spline import QuinticSpline
from rrr_traj_planner.core.trajectory.time_scaling import squared_time_scale

# Tolerances promised are 0.1 % of a limit and 1e-6 rad of a range; the dense check may miss the
# difference to these: a fifth of it, chosen.
SPLINE_TOLERANCE = 8e-4  # relative
RANGE_TOLERANCE = 8e-7   # rad

# Steps of an interval in the coarse and in the dense check. An interval is checked densely where a
# limit is below a Bernstein coefficient of position, velocity, acceleration or of the polynomial
# through the coarse samples of torque. Chosen.
COARSE_STEPS, FINE_STEPS = 4, 64
BLOCK, DENSE_BLOCK = 2000, 200  # intervals checked at once: they stay in the cache; chosen


class SplineExcess(NamedTuple):
    """Excess of the quintics over the limits, for each of n - 1 intervals."""

    time_scale: Array  # least factor that satisfies the limits; 1 where they are, (n - 1,)
    outside: Array     # distance beyond a joint's range [rad], 0 within tolerance, (n - 1,)
    place: Array       # fraction of the interval at which the excess is largest, (n - 1,)
    effort: Array      # largest torque over all intervals to 1e-3 [N m], (3,)
    jerk: Array        # largest jerk of each interval [rad/s^3], exact, (n - 1, 3)

    @property
    def slowing(self) -> float:
        """
        Return the time-scaling factor that the whole motion needs, at least 1.

        Where jerk steps, quintics through points h apart differ from the motion by O(h^3): the
        excess over a range falls with the cube of the factor.
        """
        outside = float(self.outside.max(initial=0.0))
        return max(float(self.time_scale.max(initial=1.0)),
                   float(np.cbrt(outside / RANGE_TOLERANCE)))


class CheckedIntervals(NamedTuple):
    """What the checks of the quintics found, for each of n - 1 intervals."""

    coarse_effort: Array  # largest torque of the coarse samples [N m], (n - 1, 3)
    torque_bound: Array   # of the polynomial through these [N m], (n - 1, 3)
    jerk: Array           # as in `SplineExcess`
    doubtful: BoolArray   # whether a bound exceeds a limit other than torque's, (n - 1,)
    dense: BoolArray      # whether the following come from a dense check, (n - 1,)
    time_scale: Array     # as in `SplineExcess`
    outside: Array
    place: Array
    dense_effort: Array   # largest torque [N m], (n - 1, 3)

    def excess(self, limits: JointLimits) -> SplineExcess:
        """
        Return the excess over the limits.

        Parameters
        ----------
        limits : JointLimits
            Those of the checks.

        Returns
        -------
        SplineExcess
            For each interval.

        """
        to_see = self.to_check_densely(limits)
        effort = np.maximum(self.coarse_effort.max(axis=0, initial=0.0),
                            self.dense_effort[to_see].max(axis=0, initial=0.0))
        return SplineExcess(
            np.where(to_see, self.time_scale, 1.0), np.where(to_see, self.outside, 0.0),
            np.where(to_see, self.place, 0.0), effort, self.jerk)

    def to_check_densely(self, limits: JointLimits) -> BoolArray:
        """
        Return where a bound exceeds a limit, or the largest torque of all samples.

        Parameters
        ----------
        limits : JointLimits
            Those of the checks.

        Returns
        -------
        ndarray of bool, shape (n - 1,)
            Whether the coarse check leaves a doubt.

        """
        most = np.minimum(limits.max_effort, self.coarse_effort.max(axis=0, initial=0.0))
        return np.asarray(self.doubtful | _exceeds(self.torque_bound, most))


def spline_excess(model: RobotModel, limits: JointLimits, spline: QuinticSpline,
                  should_stop: ShouldStop = never) -> SplineExcess:
    """
    Return the excess of quintics through points over velocity, acceleration, torque and range.

    Parameters
    ----------
    model : RobotModel
        The arm.
    limits : JointLimits
        Its limits.
    spline : QuinticSpline
        The quintics.
    should_stop : callable
        Called now and then for the exceptions it may raise; its result is ignored.

    Returns
    -------
    SplineExcess
        For each interval.

    """
    return checked_intervals(model, limits, spline, should_stop).excess(limits)


def checked_intervals(model: RobotModel, limits: JointLimits, spline: QuinticSpline,
                      should_stop: ShouldStop = never) -> CheckedIntervals:
    """
    Return what the checks of quintics through points found.

    Parameters
    ----------
    model, limits, spline, should_stop
        As in `spline_excess`.

    Returns
    -------
    CheckedIntervals
        Of all intervals.

    """
    blocks = [slice(i, i + BLOCK) for i in range(0, max(len(spline.coefficients), 1), BLOCK)]
    found = _coarse_check(model, limits, spline, blocks, should_stop)
    return _checked_densely(model, limits, spline, found, should_stop)


def checked_where_divided(model: RobotModel, limits: JointLimits, spline: QuinticSpline,
                          before: CheckedIntervals, divided: IntArray,
                          should_stop: ShouldStop = never) -> CheckedIntervals:
    """
    Return what the checks found after some intervals were divided: only their parts are checked.

    Parameters
    ----------
    model, limits, should_stop
        As in `spline_excess`.
    spline : QuinticSpline
        The quintics after the division.
    before : CheckedIntervals
        Of the intervals before it.
    divided : ndarray of int
        Increasing indices of those that were divided, each in two.

    Returns
    -------
    CheckedIntervals
        As of `checked_intervals`, from which it differs by rounding.

    """
    copies = 1 + np.isin(np.arange(len(before.dense)), divided)
    found = CheckedIntervals._make(values.repeat(copies, axis=0) for values in before)
    parts = np.add.outer(divided + np.arange(len(divided)), (0, 1)).ravel()
    coarse = _coarse_check(model, limits, spline, [parts], should_stop)
    for all_of_them, some in zip(found, coarse):
        all_of_them[parts] = some
    return _checked_densely(model, limits, spline, found, should_stop)


def _coarse_check(model: RobotModel, limits: JointLimits, spline: QuinticSpline,
                  blocks: Sequence[IntArray | slice], should_stop: ShouldStop) -> CheckedIntervals:
    """Return what samples and Bernstein coefficients tell of some intervals of a motion."""
    rest_speed, found = rest_speed_of(spline.velocities), []
    for index in blocks:
        should_stop()
        found.append(_coarse_check_of(model, limits, spline, index, rest_speed))
    return CheckedIntervals._make(map(np.concatenate, zip(*found)))


def _coarse_check_of(model: RobotModel, limits: JointLimits, spline: QuinticSpline,
                     index: IntArray | slice, rest_speed: float) -> CheckedIntervals:
    """Return the same of a few intervals."""
    q, qd, qdd = spline.within(np.linspace(0.0, 1.0, COARSE_STEPS + 1), index)
    tau, push = _torque_and_push(model, q, qd, qdd, rest_speed)
    forms = bernstein_forms(spline.coefficients[index], spline.widths(index))
    doubtful = _exceeds(np.abs(forms[1]).max(axis=2), limits.max_velocity)
    doubtful |= _exceeds(np.abs(forms[2]).max(axis=2), limits.max_acceleration)
    doubtful |= (forms[0].max(axis=2) > limits.max_position + RANGE_TOLERANCE).any(axis=1)
    doubtful |= (forms[0].min(axis=2) < limits.min_position - RANGE_TOLERANCE).any(axis=1)
    none = np.zeros(len(doubtful))
    return CheckedIntervals(
        np.abs(tau + push).max(axis=0),
        np.abs(through_samples(tau)).max(axis=0) + model.friction.coulomb,
        spline.peak_jerks(index), doubtful, none > 0.0, none + 1.0, none, none,
        np.zeros((len(none), 3)))


def _exceeds(most: Array, limit: Array) -> BoolArray:
    """Return in which intervals a bound, (n, 3), exceeds a limit by more than the tolerance."""
    return np.asarray((most > limit * (1.0 + SPLINE_TOLERANCE)).any(axis=1))


def _checked_densely(model: RobotModel, limits: JointLimits, spline: QuinticSpline,
                     found: CheckedIntervals, should_stop: ShouldStop) -> CheckedIntervals:
    """Return the findings with those of the dense check wherever it is needed."""
    to_see = np.flatnonzero(found.to_check_densely(limits) & ~found.dense)
    rest_speed, fields = rest_speed_of(spline.velocities), found[-4:]
    for i in range(0, len(to_see), DENSE_BLOCK):
        should_stop()
        index = to_see[i:i + DENSE_BLOCK]
        for values, some in zip(fields, _dense_check(model, limits, spline, index, rest_speed)):
            values[index] = some
    found.dense[to_see] = True
    return found


def _dense_check(model: RobotModel, limits: JointLimits, spline: QuinticSpline,
                 index: IntArray, rest_speed: float) -> tuple[Array, Array, Array, Array]:
    """Return time scale, distance outside, place and effort of some intervals, checked densely."""
    fractions = np.linspace(0.0, 1.0, FINE_STEPS + 1)
    q, qd, qdd = spline.within(fractions, index)
    tau, push = _torque_and_push(model, q, qd, qdd, rest_speed)
    ratios = np.stack([
        np.abs(qd) / limits.max_velocity, np.abs(qdd) / limits.max_acceleration,
        np.abs(tau + push) / limits.max_effort])
    factors = np.stack([ratios[0], np.sqrt(ratios[1]), np.sqrt(
        squared_time_scale(model, limits, q, qd, qdd, rest_speed))])
    # Friction steps between samples where a joint turns: peaks are those of the smooth torque.
    effort = np.maximum(_between(tau) + push, _between(-tau) - push)
    peaks = np.concatenate((_between(ratios[:2]), effort[np.newaxis] / limits.max_effort))
    factors = np.where(ratios > 1.0 + SPLINE_TOLERANCE, factors, np.where(
        peaks > 1.0 + SPLINE_TOLERANCE, np.sqrt(peaks), 1.0)).max(axis=(0, 3))
    q = _at_reversals(q, qd, qdd, spline.widths(index) / FINE_STEPS)
    outside = np.maximum(limits.min_position - q, q - limits.max_position).max(axis=(0, 2))
    return (factors.max(axis=0), np.where(outside > RANGE_TOLERANCE, outside, 0.0),
            fractions[factors.argmax(axis=0)], effort.max(axis=0))


def _torque_and_push(model: RobotModel, q: Array, qd: Array, qdd: Array,
                     rest_speed: float) -> tuple[Array, Array | float]:
    """Return the motors' torques without Coulomb friction, and for Coulomb friction [N m]."""
    coulomb = model.friction.coulomb
    push = coulomb * direction_of(qd, rest_speed) if coulomb.any() else 0.0
    return smooth_motor_torque(model, q, qd, qdd), push


def _at_reversals(q: Array, qd: Array, qdd: Array, step: Array) -> Array:
    """Return positions; where a joint reverses within half a step, those at the reversal."""
    with np.errstate(divide='ignore', invalid='ignore'):
        dt = -qd / qdd
    dt[~(np.abs(dt) <= 0.5 * step[:, np.newaxis])] = 0.0
    return np.asarray(q + dt * (qd + 0.5 * qdd * dt))


def _between(values: Array) -> Array:
    """Return samples, (..., m, n, 3); beside a peak, that of the parabola through three."""
    peaks = values.copy()
    left, middle, right = (values[..., k:values.shape[-3] - 2 + k, :, :] for k in range(3))
    curvature, slope = 2.0 * middle - left - right, 0.5 * (right - left)
    peak = (curvature > 0.0) & (np.abs(slope) <= curvature)
    peaks[..., 1:-1, :, :][peak] += 0.5 * slope[peak] ** 2 / curvature[peak]
    return peaks
