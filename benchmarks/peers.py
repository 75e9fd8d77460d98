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

"""The same tasks given to TOPP-RA and to Ruckig."""

from __future__ import annotations

import math

import numpy as np
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.dynamics.arm_dynamics import ArmDynamics, torques
from rrr_traj_planner.planners.tasks import JointTask
import ruckig
import toppra
from toppra import algorithm, constraint

GRID_POINTS = 200

toppra.setup_logging('ERROR')


def toppra_duration(task: JointTask) -> float:
    """
    Return how long TOPP-RA takes along the natural cubic spline through the via points [s].

    The spline's parameter is the way in joint space. Velocity is kept, and acceleration and torque
    where they are limited; jerk and viscous friction are not known.
    """
    points, limits = task.points, task.limits
    way = np.concatenate(([0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))))
    path = toppra.SplineInterpolator(way / way[-1], points, 'natural')
    wanted = [constraint.JointVelocityConstraint(both(limits.max_velocity))]
    if np.isfinite(limits.max_acceleration).all():
        wanted.append(constraint.JointAccelerationConstraint(both(limits.max_acceleration)))
    if np.isfinite(limits.max_effort).all():
        wanted.append(constraint.JointTorqueConstraint(
            torque_of(task.model), both(limits.max_effort), task.model.friction.coulomb))
    solver = algorithm.TOPPRA(wanted, path, gridpoints=np.linspace(0.0, 1.0, GRID_POINTS + 1),
                              solver_wrapper='seidel')
    trajectory = solver.compute_trajectory(0.0, 0.0)
    return math.nan if trajectory is None else float(trajectory.duration)


def ruckig_duration(task: JointTask) -> float:
    """Return how long Ruckig's motion from the first via point to the last takes [s]."""
    limits, requested = task.limits, ruckig.InputParameter(3)
    if task.start_rates is not None:
        requested.current_velocity = task.start_rates.velocity.tolist()
        requested.current_acceleration = task.start_rates.acceleration.tolist()
    requested.current_position, requested.target_position = task.points[0].tolist(), task.points[
        -1].tolist()
    requested.max_velocity = limits.max_velocity.tolist()
    requested.max_acceleration = limits.max_acceleration.tolist()
    requested.max_jerk = limits.max_jerk.tolist()
    trajectory = ruckig.Trajectory(3)
    ruckig.Ruckig(3).calculate(requested, trajectory)
    return float(trajectory.duration)


def both(bound: np.ndarray) -> np.ndarray:
    """Return a bound on a magnitude as TOPP-RA takes it, shape (3, 2)."""
    return np.stack((-bound, bound), axis=1)


def torque_of(model: RobotModel):
    """Return an arm's inverse dynamics of one state, in floats: the fastest there is here."""
    dynamics = ArmDynamics(model)

    def torque(q, qd, qdd):
        return np.array(torques(dynamics((*q.tolist(), *qd.tolist())), *qdd.tolist()))

    return torque
