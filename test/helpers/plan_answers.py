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

"""What a successful answer to a plan request must satisfy."""

from __future__ import annotations

from math import pi

from helpers.plan_requests import NAMES, points_of, SECOND, stamps, TABLE_6_1
import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.control.trajectory_validation import check_trajectory
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.trajectory.quintic_spline import spline_through
from rrr_traj_planner.nodes.arm_node.arm_messages import incoming_trajectory
from rrr_traj_planner_interfaces.srv import PlanTrajectory

CODES = PlanTrajectory.Response
ROUNDING = 1e-9  # of a few thousand operations on numbers of about 1


def assert_sampled(response, period):
    """Assert that points come every period and at every via time, none too near to another."""
    t, via = stamps(response.trajectory), np.round(np.multiply(response.via_times, SECOND))
    step = round(period * SECOND)
    assert t[0] == 0
    assert (np.diff(t) > 0).all()
    assert set(via) <= set(t)
    assert t[-1] == via[-1]
    fixed = np.union1d((0, t[-1]), via)
    for due in range(step, t[-1], step):
        assert due in t or np.abs(fixed - due).min() < 0.1 * step + 1
    for before, after in zip(t, t[1:]):
        assert after - before >= 0.1 * step - 1 or {before, after} <= set(fixed)
        assert after - before <= 1.1 * step + 1


def assert_good(response, points=TABLE_6_1, start=None, period=0.01, elbow='up',
                scale=(1.0, 1.0)):
    """Assert that an answer keeps the contract: form, times, via points, limits, figures."""
    assert (response.error_code, response.message) == (CODES.SUCCESS, '')
    assert response.failed_via_point == -1
    assert response.planning_time > 0.0
    trajectory = response.trajectory
    assert (trajectory.header.stamp.sec, trajectory.header.stamp.nanosec) == (0, 0)
    assert trajectory.header.frame_id == 'base_link'
    assert trajectory.joint_names == NAMES
    for point in trajectory.points:
        assert (len(point.positions), len(point.velocities), len(point.accelerations),
                len(point.effort)) == (3, 3, 3, 0)
    assert_sampled(response, period)
    check_trajectory(incoming_trajectory(trajectory), NAMES, now=0)

    motion = points_of(trajectory)
    for end in (0, -1):
        assert motion.velocities[end].tolist() == motion.accelerations[end].tolist() == [0.0] * 3
    if start is not None:
        assert motion.positions[0].tolist() == list(start)
    at_via = np.searchsorted(stamps(trajectory), np.round(np.multiply(response.via_times, SECOND)))
    tip = forward_kinematics(RobotModel(), motion.positions[at_via])
    np.testing.assert_allclose(tip, points, atol=ROUNDING)
    bent = motion.positions[at_via[0], 2]
    assert (bent <= pi / 2) == (elbow == 'up')  # at pi / 2 the arm is stretched

    limits = JointLimits().scaled(*scale)
    _, qd, qdd = spline_through(motion).within(np.linspace(0.0, 1.0, 17))
    for peak, seen, limit in zip(
            (response.peak_velocity, response.peak_acceleration),
            (np.abs(qd).max(axis=(0, 1)), np.abs(qdd).max(axis=(0, 1))),
            (limits.max_velocity, limits.max_acceleration)):
        assert (np.array(peak) <= limit * (1.0 + 1e-6)).all()
        assert (seen <= limit * (1.0 + 1e-3)).all()
        np.testing.assert_allclose(peak, seen, rtol=0.02, atol=1e-3)
    assert (np.array(response.peak_jerk) <= limits.max_jerk * (1.0 + 1e-6)).all()
    assert (np.array(response.peak_effort) <= limits.max_effort * (1.0 + 1e-6)).all()
