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

"""Points of a trajectory, as a trajectory_msgs/JointTrajectory carries them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import cast

import numpy as np
from numpy.typing import NDArray
from rrr_traj_planner.core.arrays import Array, finite_array, IntArray, truth_array
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.read_only import ReadOnlyArrays

# std::numeric_limits<float>::epsilon(): the controller treats smaller velocities as zero [rad/s].
FLOAT_EPSILON = float(np.finfo(np.float32).eps)


@dataclass(frozen=True, eq=False)
class TrajectoryPoints(ReadOnlyArrays):
    """
    Points of a trajectory, each with or without velocity and acceleration.

    Parameters
    ----------
    times : array_like, shape (n,)
        Strictly increasing [s].
    positions : array_like, shape (n, 3)
        [rad].
    velocities, accelerations : array_like, shape (n, 3), optional
        [rad/s], [rad/s^2]; zero where a point has none, and if left out.
    has_velocity, has_acceleration : array_like of bool, shape (n,), optional
        Whether a point has them; if left out, all points have those that are given.

    Raises
    ------
    InvalidInputError
        If there is no point, times do not increase, or shapes differ.

    """

    times: Array
    positions: Array
    velocities: Array = cast(Array, None)
    accelerations: Array = cast(Array, None)
    has_velocity: NDArray[np.bool_] = cast(NDArray[np.bool_], None)
    has_acceleration: NDArray[np.bool_] = cast(NDArray[np.bool_], None)

    def __post_init__(self) -> None:
        """Check shapes and order, fill in what is left out and make the arrays read-only."""
        times = finite_array('times', self.times, (-1,))
        n = len(times)
        if n == 0 or (np.diff(times) <= 0.0).any():
            raise InvalidInputError('times must be strictly increasing, and at least one')
        fields: dict[str, NDArray[np.generic]] = {
            'times': times, 'positions': finite_array('positions', self.positions, (n, 3))}
        for name, known in (('velocities', 'has_velocity'), ('accelerations', 'has_acceleration')):
            values, has = getattr(self, name), getattr(self, known)
            fields[name] = (np.zeros((n, 3)) if values is None
                            else finite_array(name, values, (n, 3)))
            fields[known] = (np.full(n, values is not None) if has is None
                             else truth_array(known, has, (n,)))
        for name, array in fields.items():
            object.__setattr__(self, name, array)
        super().__post_init__()

    @property
    def duration(self) -> float:
        """Time of the last point [s]."""
        return float(self.times[-1])


def with_start_state(points: TrajectoryPoints, time: float,
                     state: tuple[Array, Array, Array]) -> TrajectoryPoints:
    """
    Return points preceded by a state, from which a segment leads to the first one.

    Parameters
    ----------
    points : TrajectoryPoints
        The points.
    time : float
        Time of the state, on the points' clock; before the first of them [s].
    state : tuple of ndarray, shape (3,)
        Position [rad], velocity [rad/s], acceleration [rad/s^2].

    Returns
    -------
    TrajectoryPoints
        With one point more, which has velocity and acceleration.

    """
    q, qd, qdd = state
    return TrajectoryPoints(
        np.append(time, points.times), np.vstack((q, points.positions)),
        np.vstack((qd, points.velocities)), np.vstack((qdd, points.accelerations)),
        np.append(True, points.has_velocity), np.append(True, points.has_acceleration))


def segment_orders(points: TrajectoryPoints) -> IntArray:
    """
    Return the degree of the polynomial between each two points.

    Velocities and accelerations are used where both points have them; accelerations without
    velocities are not (joint_trajectory_controller then commands zero positions, which is not
    reproduced).

    Parameters
    ----------
    points : TrajectoryPoints
        The points.

    Returns
    -------
    ndarray of int, shape (n - 1,)
        1, 3 or 5.

    """
    velocity = points.has_velocity[:-1] & points.has_velocity[1:]
    acceleration = velocity & points.has_acceleration[:-1] & points.has_acceleration[1:]
    orders: IntArray = 1 + 2 * velocity.astype(int) + 2 * acceleration.astype(int)
    return orders
