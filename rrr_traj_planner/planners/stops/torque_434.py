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
4-3-4 laws for segments that torque makes longer: joins' times and accelerations of least time.

Where gravity helps to start and hinders to stop, or inertia changes on the way, the best law is
not symmetric. A segment's problem has five variables: the logarithm of its duration, of the parts
that lift-off and set-down take, and the accelerations at the joins. Lift-off only speeds up and
set-down only slows down; velocity does not become negative; the peaks keep their limits, and so do
torques at points all along the segment. SciPy's SLSQP solves it from several starts. What it finds
need not be the best, nor even keep the limits: the planner measures every law that it gets from
here, beside the one that it has.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.dynamics.rigid_body import inverse_dynamics
from rrr_traj_planner.core.motion_laws.lin_434 import Law434
from rrr_traj_planner.planners.stops.symmetric_434 import least_time, Loads
from scipy.optimize import minimize

# Starts beside the symmetric law: constant jerk, and either end longer than the other.
STARTS = (Law434(0.25, 0.25, 8.0, -8.0), Law434(0.2, 0.45, 5.0, -0.1),
          Law434(0.45, 0.2, 0.1, -5.0))
POINTS = np.linspace(0.0, 1.0, 9)  # of lift-off, cruise and set-down each, for torque
LEAST_CRUISE = 0.02                # of the duration
PARTS = (np.log(1e-5), np.log(0.97))
MOST_ACCELERATION = 60.0
STEPS = 60
TOLERANCE = 1e-9
BACKWARDS = 1e-10  # velocity that rounding may leave, of displacement / duration

DIFFERENCE = 1e-6
AROUND = np.concatenate((np.zeros((1, 5)), DIFFERENCE * np.eye(5), -DIFFERENCE * np.eye(5)))


class Segment(NamedTuple):
    """A segment, and what limits its motion."""

    model: RobotModel
    limits: JointLimits
    start: Array         # joint positions [rad], shape (3,)
    displacement: Array  # [rad], shape (3,)
    loads: Loads         # of this segment, shape ()


def law_for_torque(segment: Segment, start: Law434, duration: float,
                   floor: float) -> Law434 | None:
    """
    Return where SLSQP comes to from a start.

    Parameters
    ----------
    segment : Segment
        Where and within which limits.
    start : Law434
        Fields of shape ().
    duration : float
        What is to be improved on [s].
    floor : float
        A duration [s] below which none is sought.

    Returns
    -------
    Law434 or None
        Fields of shape (); None where that is no law, or its velocity becomes negative.

    """
    duration = max(duration, float(least_time(start, segment.loads)))
    x0 = np.array([0.0, np.log(start.first), np.log(start.last), start.a1, start.a2])
    x0[1:3] = np.clip(x0[1:3], *PARTS)
    bounds = [(np.log(floor / duration), None), PARTS, PARTS,
              (0.0, MOST_ACCELERATION), (-MOST_ACCELERATION, 0.0)]
    rooms: dict[bytes, tuple[Array, Array]] = {}

    def at(x: Array) -> tuple[Array, Array]:
        key = x.tobytes()
        if key not in rooms:  # values and their gradients are asked for in turn
            around = _rooms(segment, duration, x + AROUND)
            rooms.clear()
            rooms[key] = (around[:, 0],
                          (around[:, 1:6] - around[:, 6:]) / (2.0 * DIFFERENCE))
        return rooms[key]

    gradient = np.eye(5)[0]
    with np.errstate(all='ignore'):  # a step may try a law without a cruise
        x = minimize(
            lambda x: (x[0], gradient), x0, jac=True, method='SLSQP', bounds=bounds,
            constraints={'type': 'ineq', 'fun': lambda x: at(x)[0], 'jac': lambda x: at(x)[1]},
            options={'maxiter': STEPS, 'ftol': TOLERANCE}).x
    if not np.isfinite(x).all():
        return None
    law = Law434(*np.exp(x[1:3]), *x[3:])
    sound = law.cruise >= 0.5 * LEAST_CRUISE and law.velocities().min() >= -BACKWARDS
    return law if sound else None


def _rooms(segment: Segment, duration: float, x: Array) -> Array:
    """Return what is left to each limit, of it, shape (constraints, m); x has shape (m, 5)."""
    T = duration * np.exp(x[:, 0])
    law = Law434(np.exp(x[:, 1]), np.exp(x[:, 2]), x[:, 3], x[:, 4])
    velocity, loads = law.velocities(), segment.loads
    shares = np.concatenate((law.accelerations() * loads.acceleration / T ** 2,
                             law.jerks() * loads.jerk / T ** 3,
                             _torque_shares(segment, law, T)))
    return np.concatenate(([law.cruise - LEAST_CRUISE], velocity,
                           1.0 - velocity * loads.velocity / T, 1.0 - shares, 1.0 + shares))


def _torque_shares(segment: Segment, law: Law434, T: Array) -> Array:
    """Return torques all along a segment, of their limits, shape (points, m)."""
    limited = np.isfinite(segment.limits.max_effort)
    columns = Law434(*(field[:, np.newaxis] for field in law))
    s, sd, sdd = (np.concatenate(each, axis=1)[..., np.newaxis] for each in zip(*(
        piece.at(POINTS)[:3] for piece in columns.pieces(T[:, np.newaxis], 0.0, 1.0))))
    D = segment.displacement
    torque = inverse_dynamics(segment.model, *(v.reshape(-1, 3) for v in (
        segment.start + s * D, sd * D, sdd * D)))
    shares = torque[:, limited] / segment.limits.max_effort[limited]
    return shares.reshape(len(T), -1).T
