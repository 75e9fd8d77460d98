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
The joints' and the tip's limits as constraints on the motion along a path, for the solver.

Time scaling: Hollerbach, Dynamic scaling of manipulator trajectories, 1984.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits, kinematic_time_scale
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.core.kernels import contiguous
from rrr_traj_planner.core.trajectory.time_scaling import (
    squared_scaling,
    squared_scaling_any_slower,
    TorqueParts,
)
from rrr_traj_planner.planners.path_timing.table import PathTable
from rrr_traj_planner.planners.solver.library import KERNELS
from rrr_traj_planner.planners.solver.limits import FAR, Limits
from rrr_traj_planner.planners.solver.splines import Mesh
from rrr_traj_planner.planners.solver.timing_problem import TimingProblem
from rrr_traj_planner.planners.solver.workspace import Workspace

QUANTITIES = 14  # three each of velocity, acceleration, jerk and torque, then:
VELOCITY, ACCELERATION, JERK, TORQUE = (slice(3 * k, 3 * k + 3) for k in range(4))
SPEED, ALONG = 12, 13  # the tip's speed, and its acceleration along the path

# Bound on the tip's acceleration along pieces of constant speed [m/s^2]: a barrier method needs an
# interior. Chosen: half and twice of it change 26 random motions by 0.07 % in the mean, at most by
# 0.3 %.
STEADY = 1e-3


def all_bounds(limits: JointLimits, max_tip_speed: float) -> Array:
    """
    Return bounds on the magnitudes of all limited quantities.

    Parameters
    ----------
    limits : JointLimits
        Infinite where there is none.
    max_tip_speed : float
        [m/s], infinite where there is none.

    Returns
    -------
    ndarray, shape (QUANTITIES,)
        Infinite where there is none.

    """
    return np.concatenate((limits.max_velocity, limits.max_acceleration, limits.max_jerk,
                           limits.max_effort, [max_tip_speed, np.inf]))


class PathConstraints:
    """
    Limits on velocity, acceleration, jerk and torque of the joints, and on the tip's speed.

    Parameters
    ----------
    table : PathTable
        The path's derivatives and dynamics.
    limits : JointLimits
        Infinite where there is none.
    max_tip_speed : float
        [m/s], infinite where there is none.
    mesh : Mesh
        Its n intervals in each piece.
    margins : ndarray, shape (N, 2 n + 1, QUANTITIES)
        Subtracted from each quantity's limit.
    steady : ndarray of bool, shape (N,)
        Pieces on which the tip keeps its speed.
    workspace : Workspace, optional
        Memory shared by problems that are solved one after the other.

    Attributes
    ----------
    points : ndarray, shape (N + 1, 1)
        Path lengths where the pieces meet [m].
    margins
        As given.

    """

    def __init__(self, table: PathTable, limits: JointLimits, max_tip_speed: float, mesh: Mesh,
                 margins: Array, steady: BoolArray, workspace: Workspace | None = None) -> None:
        self.table, self.mesh, self.points = table, mesh, table.ends[:, np.newaxis]
        self.margins, self._workspace = margins, workspace
        bounds = all_bounds(limits, max_tip_speed)
        upper = np.minimum(bounds, FAR) - margins
        upper[..., TORQUE] -= table.reserve
        upper[steady, :, ALONG] = STEADY
        lower = -upper
        lower[..., SPEED] = 0.0  # the tip moves forward; it rests at the start and the end
        lower[0, 0, SPEED] = lower[-1, mesh.n, SPEED] = -FAR
        is_limited = np.isfinite(bounds)
        is_limited[SPEED], is_limited[ALONG] = True, steady.any()
        self._lower, self._upper, self._limited = lower, upper, is_limited

    @cached_property
    def problem(self) -> TimingProblem:
        """Return the problem that the solver works on."""
        N, P, _ = self._upper.shape
        lower, upper, bounded = np.zeros((N, P, 4)), np.zeros((N, P, 4)), np.zeros((P, 4), bool)
        along = slice(1, 3)  # the states' columns of the tip's speed and acceleration
        lower[..., along], upper[..., along] = self._lower[..., SPEED:], self._upper[..., SPEED:]
        bounded[:, along] = self._limited[SPEED:]
        return TimingProblem(self.mesh, self.points, Limits(
            lower, upper, bounded, self._lower[..., :SPEED], self._upper[..., :SPEED],
            np.tile(self._limited[:SPEED], (P, 1)), table=self.table.coefficients,
            overshoot=self.table.overshoot, viscous=self.table.friction.viscous),
            self._workspace)


def limited_quantities(problem: TimingProblem, z: Array, at_points: bool) -> tuple[Array, Array]:
    """
    Return the limited quantities of a motion along a path.

    Torques are those of Bobrow, Dubowsky & Gibson (1985), m sdd + c sd^2 + g, and of viscous
    friction.

    Parameters
    ----------
    problem : TimingProblem
        Of the path.
    z : ndarray, shape (N, p, 4)
        Position [m], speed, acceleration and jerk along it; row k is on piece k.
    at_points : bool
        Whether these are the problem's points, in the last two intervals of which, on each piece,
        a quintic's overshoot is added.

    Returns
    -------
    tuple of ndarray
        Velocity, acceleration, jerk, torque of each joint, the tip's speed and acceleration,
        (N, p, QUANTITIES), and the torque of gravity and Coulomb friction, (N, p, 3); without the
        friction that the table leaves as a reserve.

    """
    z = contiguous(z)
    x, gravity = np.empty((*z.shape[:2], QUANTITIES)), np.empty((*z.shape[:2], 3))
    KERNELS.path_quantities(problem.address, z.shape[1], at_points, z.ctypes.data, x.ctypes.data,
                            gravity.ctypes.data)
    return x, gravity


def least_time_scale(x: Array, gravity: Array, viscous: Array, bounds: Array) -> float:
    """
    Return the least factor on all times with which limits hold at given points.

    Torques may exceed their limits again at larger factors.

    Parameters
    ----------
    x, gravity : ndarray
        As returned by `limited_quantities`.
    viscous : ndarray, shape (3,)
        Friction of the joints [N m s/rad].
    bounds : ndarray, shape (..., QUANTITIES)
        On magnitudes, infinite where there is none; that on acceleration along the path is left
        out.

    Returns
    -------
    float
        At most 1 where they hold as it is; infinite where no factor helps.

    """
    by_torque = squared_scaling(bounds[..., TORQUE], _torque_parts(x, gravity, viscous))
    return max(_kinematic_scale(x, bounds), float(np.sqrt(by_torque.max())))


def time_scale_any_slower(x: Array, gravity: Array, viscous: Array, bounds: Array) -> float:
    """
    Return the factor on all times with which, and with every larger one, limits hold.

    Parameters
    ----------
    x, gravity, viscous, bounds
        As of `least_time_scale`.

    Returns
    -------
    float
        Infinite where the torque of gravity and Coulomb friction exceeds its limit.

    """
    by_torque = squared_scaling_any_slower(bounds[..., TORQUE], _torque_parts(x, gravity, viscous))
    return max(_kinematic_scale(x, bounds), float(np.sqrt(by_torque.max())))


def _torque_parts(x: Array, gravity: Array, viscous: Array) -> TorqueParts:
    friction = viscous * x[..., VELOCITY]
    return TorqueParts(gravity, friction, x[..., TORQUE] - friction - gravity)


def _kinematic_scale(x: Array, bounds: Array) -> float:
    """Return the factor for joint velocities, accelerations and jerks, and the tip's speed."""
    ratio = (np.abs(x) / bounds).reshape(-1, QUANTITIES).max(axis=0)
    kinematic = kinematic_time_scale(ratio[VELOCITY], ratio[ACCELERATION], ratio[JERK])
    return float(max(kinematic, ratio[SPEED]))
