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

"""An arm's motion as its joint states show it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.trajectory.trajectory_points import TrajectoryPoints
from rrr_traj_planner.nodes.output.message_times import seconds
from sensor_msgs.msg import JointState


def recorded_motion(states: Sequence[JointState], joint_names: Sequence[str],
                    start: float) -> tuple[TrajectoryPoints, Array | None]:
    """
    Return the motion that joint states show.

    Parameters
    ----------
    states : sequence of JointState
        At least two states, each with positions of all joints; velocities and efforts may be
        missing or NaN, as of controllers that do not know them.
    joint_names : sequence of str
        The arm's joints.
    start : float
        Time that is to be zero [s].

    Returns
    -------
    motion : TrajectoryPoints
        The states whose time is after that of the one before.
    torque : ndarray, shape (n, 3), or None
        Motor torques [N m]; None: the states have none.

    """
    times = np.array([seconds(s.header.stamp) for s in states]) - start
    fresh = np.concatenate(([True], np.diff(times) > 0.0))
    states, times = [s for s, new in zip(states, fresh) if new], times[fresh]
    q = in_order(states, joint_names, 'position')
    qd = in_order(states, joint_names, 'velocity')
    torque = in_order(states, joint_names, 'effort')
    return (TrajectoryPoints(times, q, qd if np.isfinite(qd).all() else np.gradient(
        q, times, axis=0)), torque if np.isfinite(torque).all() else None)


def in_order(states: Sequence[JointState], joint_names: Sequence[str], field: str) -> Array:
    """
    Return a field of joint states in the order of an arm's joints.

    Parameters
    ----------
    states : sequence of JointState
        The states, which may have more joints.
    joint_names : sequence of str
        The arm's joints.
    field : str
        `position`, `velocity` or `effort`.

    Returns
    -------
    ndarray, shape (n, 3)
        The values; NaN where a state has none.

    """
    found = []
    for state in states:
        values = dict(zip(state.name, getattr(state, field)))
        found.append([values.get(name, np.nan) for name in joint_names])
    return np.array(found)
