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

from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array, IntArray
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
    fractions = np.linspace(0.0, 1.0, COARSE_STEPS + 1)
    q, qd, qdd = spline.within(fractions)
    should_stop()
    rest_speed = rest_speed_of(qd)
    tau, push = _torque_and_push(model, q, qd, qdd, rest_speed)
    effort = np.abs(tau + push).max(axis=(0, 1))
    should_stop()
    forms = bernstein_forms(spline.coefficients, np.diff(spline.knots))
    bounds = [np.abs(form).max(axis=2) for form in forms[1:]]
    bounds.append(np.abs(through_samples(tau)).max(axis=0) + model.friction.coulomb)
    doubtful = np.zeros(q.shape[1], dtype=bool)
    for most, limit in zip(bounds, (
            limits.max_velocity, limits.max_acceleration, np.minimum(limits.max_effort, effort))):
        doubtful |= (most > limit * (1.0 + SPLINE_TOLERANCE)).any(axis=1)
    doubtful |= (forms[0].max(axis=2) > limits.max_position + RANGE_TOLERANCE).any(axis=1)
    doubtful |= (forms[0].min(axis=2) < limits.min_position - RANGE_TOLERANCE).any(axis=1)
    should_stop()
    none = np.zeros(q.shape[1])
    found = SplineExcess(none + 1.0, none, none.copy(), effort, spline.peak_jerks())
    index = np.flatnonzero(doubtful)
    if len(index):
        *fine, most = _dense_check(model, limits, spline, index, rest_speed)
        for all_of_them, some in zip(found, fine):
            all_of_them[index] = some
        found = found._replace(effort=np.maximum(effort, most))
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
    q = _at_reversals(q, qd, qdd, np.diff(spline.knots)[index] / FINE_STEPS)
    outside = np.maximum(limits.min_position - q, q - limits.max_position).max(axis=(0, 2))
    return (factors.max(axis=0), np.where(outside > RANGE_TOLERANCE, outside, 0.0),
            fractions[factors.argmax(axis=0)], effort.max(axis=(0, 1)))


def _torque_and_push(model: RobotModel, q: Array, qd: Array, qdd: Array,
                     rest_speed: float) -> tuple[Array, Array]:
    """Return the motors' torques without Coulomb friction, and for Coulomb friction [N m]."""
    return (smooth_motor_torque(model, q, qd, qdd),
            model.friction.coulomb * direction_of(qd, rest_speed))


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
