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

"""Trajectories that replace another one, and checks of the motion that follows."""

from __future__ import annotations

from dataclasses import replace
from math import inf

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.control.replacement import replacement
from rrr_traj_planner.core.control.takeover import Takeover
from rrr_traj_planner.core.nanoseconds import nanoseconds
from rrr_traj_planner.core.trajectory.trajectory_points import TrajectoryPoints

LIMITS = JointLimits(max_effort=np.full(3, inf))
NOW, LEAD = 50.0, 0.001
NOW_NS = nanoseconds(NOW)
Q = np.array([0.5, 1.0, 0.2])
FAST = replace(LIMITS, max_acceleration=np.full(3, 10.0))
REST = (*Q, *(0.0,) * 6)
MOVING = (*Q, 0.3, -0.4, 0.5, 0.2, 0.1, -0.3)


def takeover(command=REST, limits=LIMITS):
    return Takeover(NOW, command, limits, RobotModel())


def replaced(*arguments):
    return replacement(*arguments).motion


def smooth_points(start, duration=3.0, n=301):
    """Return points of a quintic from rest to rest."""
    s = np.linspace(0.0, 1.0, n)
    d = np.array([0.3, -0.4, 0.5])
    return TrajectoryPoints(
        duration * s, start + np.outer(10 * s ** 3 - 15 * s ** 4 + 6 * s ** 5, d),
        np.outer(30 * s ** 2 - 60 * s ** 3 + 30 * s ** 4, d) / duration,
        np.outer(60 * s - 180 * s ** 2 + 120 * s ** 3, d) / duration ** 2,
        np.full(n, True), np.full(n, True))


def single(q, time):
    return TrajectoryPoints([time], [q], *np.zeros((2, 1, 3)), [False], [False])


def positions_only(*timed):
    times, q = zip(*timed)
    n = len(times)
    return TrajectoryPoints(times, q, *np.zeros((2, n, 3)), [False] * n, [False] * n)


def commands(motion, until):
    times = np.arange(NOW, until, 1e-3)
    return times, np.array([motion(t) for t in times])


def assert_smooth(command, motion, limits=LIMITS):
    """Position and velocity go on from the command without a jump, within the limits."""
    _, states = commands(motion, motion.end + 0.1)
    np.testing.assert_allclose(states[0, :6], command[:6], atol=1e-9)
    most = max(1.0, np.abs(command[6:]).max())
    assert np.abs(np.diff(states[:, :3], axis=0)).max() <= 1e-3 * 1.001
    assert np.abs(np.diff(states[:, 3:6], axis=0)).max() <= 1e-3 * most * 1.001
    assert (np.abs(states[:, 3:6]) <= limits.max_velocity * 1.001).all()
    assert (np.abs(states[:, 6:]) <= most * 1.001).all()
