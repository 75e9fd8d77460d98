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

"""`time_optimal` where torque does not allow the straight path: another one, or a refusal."""

from dataclasses import replace
import re

from helpers.measured_motions import HIT, LIMIT_MARGIN, Measured, outcomes
from helpers.planning_cases import ARM, LIMITS, NONE
from helpers.random_tasks import Task
from helpers.spline_cases import blocked_task, is_connected
from helpers.time_optimal_cases import durations_of, GAP, KEPT, measured, through
import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.dynamics.rigid_body import gravity_torque, inverse_dynamics
from rrr_traj_planner.core.errors import LimitViolationError, TimingError
from rrr_traj_planner.core.trajectory.quintic_spline import spline_through
from rrr_traj_planner.core.trajectory.torque import time_scale_for_torque
from rrr_traj_planner.planners.methods import time_optimal
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.request import PlanningRequest
from rrr_traj_planner.planners.tasks import JointTask

BETWEEN_POINTS = 1e-3  # relative, of the quintic through the points


def test_refusals_name_a_torque_that_the_straight_path_needs():
    for task, error in outcomes('time_optimal')[1].values():
        joint = task.model.joint_names.index(error.joint)
        k = int(re.match(r'segment (\d+): no path found', str(error))[1])
        straight = np.linspace(task.q[k], task.q[k + 1], 2001)
        torque = np.abs(gravity_torque(task.model, straight))[:, joint].max()
        assert error.limit == task.limits.max_effort[joint]
        assert torque >= error.limit * (1.0 - 1e-5)
        assert torque == pytest.approx(error.value, rel=2e-2)


def segment(task, k):
    """Return two poses of a random task as a task of their own."""
    return JointTask(task.model, task.limits, task.q[k:k + 2], None, 0.01)


def test_tasks_are_refused_only_where_no_cells_within_a_margin_connect_the_poses():
    for task, error in outcomes('time_optimal')[1].values():
        k = int(re.match(r'segment (\d+)', str(error))[1])
        assert not is_connected(segment(task, k), margin=2.0)


def test_joint_3_is_refused_only_where_no_other_path_exists():
    # Gravity torque of joint 3 depends on theta_2 + theta_3 alone, which takes, on any path, every
    # value between those at the ends.
    for task, error in outcomes('time_optimal')[1].values():
        if error.joint != task.model.joint_names[2]:
            continue
        k = int(re.match(r'segment (\d+)', str(error))[1])
        ends = task.q[k:k + 2, 1] + task.q[k:k + 2, 2]
        q = np.zeros((2001, 3))
        q[:, 2] = np.linspace(*ends, 2001)
        assert np.abs(gravity_torque(task.model, q))[:, 2].max() >= error.limit * (1.0 - 1e-5)


@pytest.mark.parametrize('seed', range(12))
def test_another_path_is_taken_where_the_straight_one_is_infeasible_if_there_is_one(seed):
    task = blocked_task(seed)
    try:
        trajectory = time_optimal.plan(task)
    except LimitViolationError:
        assert not is_connected(task, margin=2.0)
        return
    assert is_connected(task, margin=-2.0)
    q, qd, qdd, _ = trajectory(np.linspace(0.0, trajectory.duration, 2001))
    assert q[[0, -1]] == pytest.approx(task.points, abs=HIT)
    assert (q >= task.limits.min_position - HIT).all()
    assert (q <= task.limits.max_position + HIT).all()
    torque = np.abs(inverse_dynamics(task.model, q, qd, qdd)) / task.limits.max_effort
    assert torque.max() <= 1.0 + LIMIT_MARGIN


def blocked_line():
    """Return two poses, and joint 2's gravity torques on the straight line between them."""
    q = np.array([[0.88, 1.29, -1.47], [0.51, 1.56, 0.91]])
    return q, np.abs(gravity_torque(ARM, np.linspace(*q, 401)))[:, 1]


def test_path_avoids_poses_that_joint_2_cannot_hold():
    q, torque = blocked_line()
    limit = 0.5 * (max(torque[[0, -1]]) + torque.max())
    assert torque.max() > 1.02 * limit  # the straight line is infeasible
    limits = replace(LIMITS, max_effort=[150.0, limit, 200.0])
    with pytest.raises(LimitViolationError, match='along the segment'):
        plan(ARM, limits, through(q, planner_id='cycloid'))
    m = measured(limits, q)
    assert m.violations() == []
    straight = q[0] + (m.q[:, :1] - q[0, 0]) / (q[1, 0] - q[0, 0]) * (q[1] - q[0])
    assert np.abs(m.q - straight).max() > 0.1


@pytest.mark.parametrize('joint_1', [-1.4, 1.4])
def test_other_paths_take_the_same_time_wherever_joint_1_is(joint_1):
    q, torque = blocked_line()
    limits = replace(LIMITS, min_position=[-3.0, *LIMITS.min_position[1:]],
                     max_position=[3.0, *LIMITS.max_position[1:]],
                     max_effort=[150.0, 0.5 * (max(torque[[0, -1]]) + torque.max()), 200.0])
    aside = np.array([joint_1, 0.0, 0.0])
    # Zero is outside joint 1's range.
    moved = replace(limits, min_position=[joint_1 + 0.3, *LIMITS.min_position[1:]],
                    max_position=[joint_1 + 1.2, *LIMITS.max_position[1:]])
    if joint_1 < 0.0:
        moved = replace(moved, min_position=[-2.0, *LIMITS.min_position[1:]],
                        max_position=[-0.1, *LIMITS.max_position[1:]])
    here, there = (measured(x, q + d).plan.via_times[-1] for x, d in (
        (limits, 0.0), (moved, aside)))
    assert there == pytest.approx(here, rel=GAP)


# Gravity torque alone is 1.04 times joint 3's limit on the path of the fastest motion.
WEAK_JOINT_3 = JointLimits(
    min_position=[-1.40188418, 0.84157753, -1.23443453],
    max_position=[0.0531041, 2.30419673, 1.1562909],
    max_velocity=[2.81122301, 2.4985027, 0.51311566],
    max_acceleration=[1.46388941, 0.51223958, 0.68577841], max_jerk=NONE,
    max_effort=[3.08132901, 157.30897877, 54.64090592])
DYNAMIC_TIPS = [(0.46996464, -0.02130729, 0.88146230), (0.29513201, -0.10969616, 1.06199934),
                (0.43890897, -0.58788287, 1.03682936), (0.51175404, -0.05552639, 0.53294995)]


def test_a_motion_that_only_inertia_makes_feasible_has_closer_points_and_is_not_slowed():
    limits = WEAK_JOINT_3  # a slower motion on the same path exceeds them
    found = plan(ARM, limits, PlanningRequest(DYNAMIC_TIPS, planner_id='time_optimal'))
    assert np.isinf(time_scale_for_torque(ARM, limits, found.trajectory).value[2])
    assert np.diff(found.points.times).min() <= 0.0055 and 'slower' not in found.note
    t = np.linspace(0.0, found.points.times[-1], 20_001)
    q, qd, qdd, _ = spline_through(found.points).at(t)
    assert (np.abs(qd) <= limits.max_velocity * (1.0 + BETWEEN_POINTS)).all()
    assert (np.abs(qdd) <= limits.max_acceleration * (1.0 + BETWEEN_POINTS)).all()
    assert (found.effort <= limits.max_effort * (1.0 + LIMIT_MARGIN)).all()


@pytest.mark.parametrize('slower', [1.2, 3.0, 30.0])
def test_durations_too_long_for_that_path_are_kept_on_another_one(slower):
    fastest = plan(ARM, WEAK_JOINT_3, PlanningRequest(DYNAMIC_TIPS, planner_id='time_optimal'))
    durations = slower * durations_of(fastest)
    try:
        found = plan(ARM, WEAK_JOINT_3, PlanningRequest(
            DYNAMIC_TIPS, planner_id='time_optimal', segment_durations=durations))
    except TimingError:
        assert slower < 3.0  # the other paths may take longer
        return
    assert durations_of(found) == pytest.approx(durations, abs=KEPT)
    q = fastest.trajectory(fastest.via_times)[0]
    task = Task(0, '', ARM, WEAK_JOINT_3, q, PlanningRequest(DYNAMIC_TIPS))
    assert Measured(task, found).violations() == []
