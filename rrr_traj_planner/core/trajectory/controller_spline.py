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
Whether the quintics that a controller lays through an answer's points keep the limits.

joint_trajectory_controller follows, from a point to the next, the polynomial of fifth order that
meets position, velocity and acceleration of both. It is near the planned motion, not the same:
between points its velocity, acceleration and torque may be beyond what the motion keeps.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array, IntArray
from rrr_traj_planner.core.cancellation import never, ShouldStop
from rrr_traj_planner.core.dynamics.rigid_body import inverse_dynamics
from rrr_traj_planner.core.trajectory.interpolation import Interpolant
from rrr_traj_planner.core.trajectory.torque import squared_time_scale

# Limits are kept to this part, 0.1 %, less what the finest look may miss.
SPLINE_TOLERANCE = 8e-4
RANGE_TOLERANCE = 8e-7   # rad beyond the end of a range, of 1e-6, likewise

# Every interval is looked at in so many steps. Between them a smooth quantity rises by an eighth
# of its second difference; where twice that could be too much, the steps are finer.
STEPS, FINE_STEPS = 4, 64
RISE = 0.25


class SplineExcess(NamedTuple):
    """Where quintics through points exceed limits; n - 1 intervals."""

    stretch: Array  # by what factor each asks the motion to be slowed; 1: not at all, (n - 1,)
    outside: Array  # how far it leaves a joint's range [rad], 0 within the tolerance, (n - 1,)
    place: Array    # where it exceeds most, as a share of the interval, (n - 1,)
    effort: Array   # largest torque of all [N m], (3,)
    jerk: Array     # largest jerk of each interval [rad/s^3], exactly, (n - 1, 3)

    @property
    def slowing(self) -> float:
        """
        Return by what factor the motion as a whole would have to be slowed, at least 1.

        Where jerk steps, quintics through points h apart differ from the motion by O(h^3): the
        same points of a slower motion leave a range by the cube of the factor less.
        """
        outside = float(self.outside.max(initial=0.0))
        return max(float(self.stretch.max(initial=1.0)), float(np.cbrt(outside / RANGE_TOLERANCE)))


def spline_excess(model: RobotModel, limits: JointLimits, spline: Interpolant,
                  should_stop: ShouldStop = never) -> SplineExcess:
    """
    Return by how much quintics through points exceed velocity, acceleration, torque and range.

    Parameters
    ----------
    model : RobotModel
        The arm.
    limits : JointLimits
        Its limits.
    spline : Interpolant
        The quintics.
    should_stop : callable
        Asked now and then; its answer does not matter, but what it raises ends the work.

    Returns
    -------
    SplineExcess
        For each interval.

    """
    shares = np.linspace(0.0, 1.0, STEPS + 1)
    q, qd, qdd = spline.within(shares)
    should_stop()
    tau = inverse_dynamics(model, q, qd, qdd)
    effort = np.abs(tau).max(axis=(0, 1))
    should_stop()
    doubtful = np.zeros(q.shape[1], dtype=bool)
    for values, limit in ((qd, limits.max_velocity), (qdd, limits.max_acceleration),
                          (tau, limits.max_effort)):
        doubtful |= (_most(np.abs(values), values) > limit * (1.0 + SPLINE_TOLERANCE)).any(axis=1)
    doubtful |= (_most(np.abs(tau), tau) > effort * (1.0 + SPLINE_TOLERANCE)).any(axis=1)
    doubtful |= (_most(q, q) > limits.max_position + RANGE_TOLERANCE).any(axis=1)
    doubtful |= (_most(-q, q) > -limits.min_position + RANGE_TOLERANCE).any(axis=1)
    should_stop()
    none = np.zeros(q.shape[1])
    found = SplineExcess(none + 1.0, none, none.copy(), effort, spline.peak_jerks())
    index = np.flatnonzero(doubtful)
    if len(index):
        *fine, most = _looked_at(model, limits, spline, index)
        for all_of_them, some in zip(found, fine):
            all_of_them[index] = some
        found = found._replace(effort=np.maximum(effort, most))
    return found


def _most(values: Array, smooth: Array) -> Array:
    """Return what values may reach in each interval, those of a smooth quantity, (k, 3)."""
    bends = np.abs(smooth[2:] - 2.0 * smooth[1:-1] + smooth[:-2]).max(axis=0)
    return np.asarray(values.max(axis=0) + RISE * bends)


def _looked_at(model: RobotModel, limits: JointLimits, spline: Interpolant,
               index: IntArray) -> tuple[Array, Array, Array, Array]:
    """Return stretch, outside, place and effort of some intervals, looked at finely."""
    shares = np.linspace(0.0, 1.0, FINE_STEPS + 1)
    q, qd, qdd = spline.within(shares, index)
    tau = inverse_dynamics(model, q, qd, qdd)
    ratios = np.stack([
        np.abs(qd) / limits.max_velocity, np.abs(qdd) / limits.max_acceleration,
        np.abs(tau) / limits.max_effort])
    factors = np.stack([ratios[0], np.sqrt(ratios[1]), np.sqrt(
        squared_time_scale(model, limits, q, qd, qdd))])
    peaks = ratios + _between(ratios)
    factors = np.where(ratios > 1.0 + SPLINE_TOLERANCE, factors, np.where(
        peaks > 1.0 + SPLINE_TOLERANCE, np.sqrt(peaks), 1.0)).max(axis=(0, 3))
    q = _turning(q, qd, qdd, np.diff(spline.points.times)[index] / FINE_STEPS)
    outside = np.maximum(limits.min_position - q, q - limits.max_position).max(axis=(0, 2))
    return (factors.max(axis=0), np.where(outside > RANGE_TOLERANCE, outside, 0.0),
            shares[factors.argmax(axis=0)], np.abs(tau).max(axis=(0, 1)))


def _turning(q: Array, qd: Array, qdd: Array, step: Array) -> Array:
    """Return positions, where a joint turns back within half a step those at the turn."""
    with np.errstate(divide='ignore', invalid='ignore'):
        dt = -qd / qdd
    dt[~(np.abs(dt) <= 0.5 * step[:, np.newaxis])] = 0.0
    return np.asarray(q + dt * (qd + 0.5 * qdd * dt))


def _between(values: Array) -> Array:
    """Return by how much a parabola through three samples may rise above, (m, steps, k, 3)."""
    rise = np.zeros_like(values)
    rise[:, 1:-1] = np.abs(values[:, 2:] - 2.0 * values[:, 1:-1] + values[:, :-2]) / 8.0
    return rise
