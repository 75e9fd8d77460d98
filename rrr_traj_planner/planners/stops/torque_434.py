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
4-3-4 laws of least time for segments whose torque limits are active.

Where gravity's torque or the inertia changes along a segment, the law of least time is not
symmetric. A segment's problem has five variables: the logarithms of its duration and of the parts
of lift-off and set-down, and the accelerations at the joins. Lift-off only accelerates, set-down
only decelerates, velocity is not negative; peaks are within their limits, and so are torques at
sampled points. SciPy's SLSQP (sequential quadratic programming: Nocedal & Wright, Numerical
Optimization, chapter 18) solves it from several starts. Its result need not be the optimum, nor
feasible between the samples: the planner computes the exact duration of every law, and keeps the
shortest.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.dynamics.motor_torque import smooth_motor_torque
from rrr_traj_planner.core.motion_laws.lin_434 import Lin434
from rrr_traj_planner.planners.stops.symmetric_434 import DisplacementRatios, least_time
from scipy.optimize import minimize

# Starts beside the symmetric law: constant jerk, and either end longer than the other.
STARTS = (Lin434(0.25, 0.25, 8.0, -8.0), Lin434(0.2, 0.45, 5.0, -0.1),
          Lin434(0.45, 0.2, 0.1, -5.0))
# Chosen values, without unit: half and twice of LEAST_CRUISE and MOST_ACCELERATION, 5 and 17
# points change none of 10 random plans.
POINTS = np.linspace(0.0, 1.0, 9)  # samples of torque in lift-off, cruise and set-down each
LEAST_CRUISE = 0.02                # part of the duration
PARTS = (np.log(1e-5), np.log(0.97))  # bounds on the logarithm of lift-off's and set-down's part
MOST_ACCELERATION = 60.0   # bound, over displacement / duration^2; the symmetric law's peak is 6

DIFFERENCE = 1e-6          # step of the central differences in all variables: near eps^(1/3)


class Segment(NamedTuple):
    """A segment and its limits."""

    model: RobotModel
    limits: JointLimits
    start: Array         # joint positions [rad], shape (3,)
    displacement: Array  # [rad], shape (3,)
    ratios: DisplacementRatios         # of this segment, shape ()


def law_for_torque(segment: Segment, start: Lin434, duration: float,
                   least_T: float) -> Lin434 | None:
    """
    Return the result of SLSQP from a start.

    Parameters
    ----------
    segment : Segment
        The segment and its limits.
    start : Lin434
        Fields of shape ().
    duration : float
        The shortest duration so far [s].
    least_T : float
        Lower bound on the duration [s].

    Returns
    -------
    Lin434 or None
        Fields of shape (); None where it is not a valid law, or its velocity becomes negative.

    """
    duration = max(duration, float(least_time(start, segment.ratios)))
    x0 = np.array([0.0, np.log(start.first), np.log(start.last), start.a1, start.a2])
    x0[1:3] = np.clip(x0[1:3], *PARTS)
    bounds = [(np.log(least_T / duration), None), PARTS, PARTS,
              (0.0, MOST_ACCELERATION), (-MOST_ACCELERATION, 0.0)]
    steps = DIFFERENCE * np.concatenate((np.zeros((1, 5)), np.eye(5), -np.eye(5)))
    cache: dict[bytes, tuple[Array, Array]] = {}

    def at(x: Array) -> tuple[Array, Array]:
        key = x.tobytes()
        if key not in cache:  # SLSQP calls for values and gradients one after the other
            around = _margins(segment, duration, x + steps)
            cache.clear()
            cache[key] = (around[:, 0],
                          (around[:, 1:6] - around[:, 6:]) / (2.0 * DIFFERENCE))
        return cache[key]

    gradient = np.eye(5)[0]
    with np.errstate(all='ignore'):  # a step may try a law without a cruise
        x = minimize(
            lambda x: (x[0], gradient), x0, jac=True, method='SLSQP', bounds=bounds,
            constraints={'type': 'ineq', 'fun': lambda x: at(x)[0], 'jac': lambda x: at(x)[1]},
            options={'maxiter': 60, 'ftol': 1e-9}).x
    if not np.isfinite(x).all():
        return None
    law = Lin434(*np.exp(x[1:3]), *x[3:])
    # Less below zero, over displacement / duration, is rounding.
    sound = law.cruise >= 0.5 * LEAST_CRUISE and law.velocities().min() >= -1e-10
    return law if sound else None


def _margins(segment: Segment, duration: float, x: Array) -> Array:
    """Return the relative margin of each limit, shape (constraints, m); x has shape (m, 5)."""
    T = duration * np.exp(x[:, 0])
    law = Lin434(np.exp(x[:, 1]), np.exp(x[:, 2]), x[:, 3], x[:, 4])
    velocity, ratios = law.velocities(), segment.ratios
    limit_ratios = np.concatenate((law.accelerations() * ratios.acceleration / T ** 2,
                                   law.jerks() * ratios.jerk / T ** 3,
                                   _torque_ratios(segment, law, T)))
    return np.concatenate((
        [law.cruise - LEAST_CRUISE], velocity, 1.0 - velocity * ratios.velocity / T,
        1.0 - limit_ratios, 1.0 + limit_ratios))


def _torque_ratios(segment: Segment, law: Lin434, T: Array) -> Array:
    """Return sampled torques over their limits, shape (points, m)."""
    limited = np.isfinite(segment.limits.max_effort)
    columns = Lin434(*(field[:, np.newaxis] for field in law))
    s, sd, sdd = (np.concatenate(each, axis=1)[..., np.newaxis] for each in zip(*(
        piece.at(POINTS)[:3] for piece in columns.pieces(T[:, np.newaxis], 0.0, 1.0))))
    D = segment.displacement
    q, qd, qdd = (v.reshape(-1, 3) for v in (segment.start + s * D, sd * D, sdd * D))
    exists = np.isfinite(q + qd + qdd).all(axis=1)  # not so for a law without a cruise
    torque = np.full(q.shape, np.nan)
    torque[exists] = smooth_motor_torque(segment.model, q[exists], qd[exists], qdd[exists])
    torque += segment.model.friction.coulomb * np.sign(D)
    limit_ratios = torque[:, limited] / segment.limits.max_effort[limited]
    return limit_ratios.reshape(len(T), -1).T
