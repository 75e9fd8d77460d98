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

"""Planned motions that end at the ends of ranges are stopped inside them, at any instant."""

from __future__ import annotations

import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.dynamics.rigid_body import gravity_torque, inverse_dynamics
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.stopping.stop import stop
from rrr_traj_planner.core.trajectory.reference_trajectory import reference_through
from rrr_traj_planner.core.trajectory.trajectory_points import TrajectoryPoints
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.request import PlanningRequest

MODEL, NONE = RobotModel(), np.full(3, np.inf)
POINTS = 1.001  # a plan's points may take so much of a limit

KINDS = {
    'all': JointLimits(),
    'no jerk': JointLimits(max_jerk=NONE),
    'torque': JointLimits(max_acceleration=NONE),
    'torque alone': JointLimits(max_acceleration=NONE, max_jerk=NONE)}


def motion_of(planner_id, limits, *q):
    """Return what the arm makes of a plan through joint positions."""
    points = plan(MODEL, limits, PlanningRequest(
        forward_kinematics(MODEL, np.array(q)), planner_id=planner_id, elbow='up')).points
    known = np.ones(len(points.times), dtype=bool)
    return reference_through(TrajectoryPoints(
        points.times, points.positions, points.velocities, points.accelerations, known, known))


def assert_stops(motion, limits, t):
    stopped, warnings = stop(motion, t, limits, MODEL)
    q, qd, qdd, _ = stopped.at(np.linspace(t, stopped.end, 400))
    assert warnings == ()
    assert stopped.end <= motion.end + 1e-9
    np.testing.assert_allclose((q[0], qd[0]), [x[0] for x in motion.at([t])[:2]], atol=1e-9)
    for state in (q, stopped.final):
        assert (state >= limits.min_position - 1e-6).all()
        assert (state <= limits.max_position + 1e-6).all()
    assert (np.abs(qd) <= POINTS * limits.max_velocity).all()
    assert (np.abs(qdd) <= POINTS * limits.max_acceleration).all()
    planned = np.abs(inverse_dynamics(MODEL, *motion.at(np.linspace(t, motion.end, 400))[:3]))
    bound = np.maximum(limits.max_effort, planned.max(axis=0))
    assert (np.abs(inverse_dynamics(MODEL, q, qd, qdd)) <= POINTS * bound).all()
    assert (np.abs(gravity_torque(MODEL, stopped.final)) <= limits.max_effort).all()


@pytest.mark.parametrize(('planner_id', 'kind'), [
    *((name, kind) for name in ('time_optimal', 'line_arc') for kind in KINDS),
    *((name, kind) for name in ('cycloid', 'poly_434') for kind in ('all', 'no jerk'))])
def test_motion_to_the_ends_of_ranges_is_stopped_inside_them(planner_id, kind):
    limits = KINDS[kind]
    motion = motion_of(planner_id, limits, (1.4, 1.0, 0.2), (0.0, 1.3, -0.3))
    for t in np.linspace(0.0, motion.end, 23):
        assert_stops(motion, limits, t)


def test_motion_that_turns_at_the_end_of_a_range_is_stopped_inside_it():
    limits = KINDS['all']
    motion = motion_of('time_optimal', limits, (0.5, 1.0, 0.2), (0.0, 1.1, 0.0), (0.5, 1.0, 0.2))
    for t in np.linspace(0.4, 0.6, 15) * motion.end:
        assert_stops(motion, limits, t)
