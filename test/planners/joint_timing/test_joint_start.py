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

"""The motion that the method begins with: stops at every via point, strictly within all limits."""

from dataclasses import replace

from helpers.spline_cases import (
    ARM,
    blocked_task,
    bounds,
    is_connected,
    LIMITS,
    NONE,
    random_motion,
    share_of,
    slow_start,
)
import numpy as np
import pytest
from rrr_traj_planner.core.dynamics.rigid_body import (
    gravity_torque,
    inertia_matrix,
    inverse_dynamics,
)
from rrr_traj_planner.core.errors import LimitViolationError
from rrr_traj_planner.planners.joint_timing.constraints import JointConstraints
from rrr_traj_planner.planners.joint_timing.start import (
    cannot_be_held,
    rest_to_rest,
    rest_to_rest_shapes,
    with_durations,
)
from rrr_traj_planner.planners.solver.splines import uniform_mesh, with_stops
from rrr_traj_planner.planners.tasks import JointTask

SEEDS = range(12)
START_SCALING = 1.02
BETWEEN_POINTS = 1.1  # of an effort limit, on a path with few points to a leg


@pytest.mark.parametrize('limits', [LIMITS, replace(LIMITS, max_effort=NONE), replace(
    LIMITS, max_acceleration=NONE, max_jerk=NONE)], ids=['all', 'no torque', 'torque'])
@pytest.mark.parametrize('seed', SEEDS)
def test_start_stops_at_every_via_point_strictly_within_all_limits(seed, limits):
    mesh, points, _ = random_motion(seed)
    constraints, m = slow_start(limits, mesh, points)
    at = mesh.states(points, m)
    assert constraints.problem.is_within(m)
    assert at.q[:, mesh.n] == pytest.approx(points[1:], abs=1e-12)
    assert (m.v == 0.0).all()
    assert at.qd[:, mesh.n] == pytest.approx(np.zeros_like(points[1:]), abs=1e-12)


@pytest.mark.parametrize('seed', SEEDS)
def test_start_is_slower_than_it_must_be_by_two_percent_only(seed):
    mesh, points, _ = random_motion(seed)
    constraints, m = slow_start(LIMITS, mesh, points)
    faster = with_durations(m, m.T / (1.001 * START_SCALING))
    slacks = constraints.problem.slacks(faster)[:-2 * len(m.T)]  # but for least durations
    # in each segment some limit is then broken
    assert (slacks.reshape(len(m.T), -1).min(axis=1) < 0.0).all()


def test_least_durations_are_kept():
    mesh, points, _ = random_motion(3)
    least_T = np.full(len(points) - 1, 30.0)
    assert (slow_start(LIMITS, mesh, points, least_T)[1].T == START_SCALING * least_T).all()


def started(task):
    """Return a task of two poses, its constraints and the motion to begin with."""
    mesh = uniform_mesh(1, 24)
    none = np.zeros((1, 2 * mesh.n + 1, 3))
    constraints = JointConstraints(task.model, task.limits, mesh, task.points,
                                   np.stack((none, none)), none, none, none)
    return task, constraints, rest_to_rest(task, constraints)


@pytest.mark.parametrize('seed', SEEDS)
def test_a_path_around_infeasible_poses_is_within_ranges_and_torques(seed):
    task, constraints, m = started(blocked_task(seed))
    if m is None:
        return
    assert constraints.problem.is_within(m)
    trajectory = constraints.mesh.trajectory(task.points, m)
    q, qd, qdd, _ = trajectory(np.linspace(0.0, trajectory.duration, 4001))
    assert q[[0, -1]] == pytest.approx(task.points, abs=1e-9)
    assert (q >= task.limits.min_position - 1e-9).all()
    assert (q <= task.limits.max_position + 1e-9).all()
    # Holdable at any speed on the path, and within limits at this one but for between points.
    assert share_of(task, q).max() < 1.0
    torque = np.abs(inverse_dynamics(task.model, q, qd, qdd)) / task.limits.max_effort
    assert torque.max() < BETWEEN_POINTS


@pytest.mark.parametrize('seed', SEEDS)
def test_there_is_a_start_just_where_cells_within_the_limits_connect_the_poses(seed):
    task, _, m = started(blocked_task(seed))
    if is_connected(task, margin=2.0):
        assert m is not None
    if not is_connected(task, margin=-2.0):
        assert m is None


def hardly_open(seed):
    """Return two poses straight between which gravity takes all of a torque but a thousandth."""
    task = blocked_task(seed)
    share = share_of(task, np.linspace(*task.points, 1001)).max()
    return replace(task, limits=replace(
        task.limits, max_jerk=NONE, max_effort=task.limits.max_effort * share / 0.999))


def test_the_faster_of_the_straight_path_and_another_is_taken():
    gained = []
    for seed in range(40):
        task, constraints, m = started(hardly_open(seed))
        path = with_stops(rest_to_rest_shapes(constraints.mesh, task.points), np.ones(1))

        def straight_in(part, path=path, T=m.T, constraints=constraints):
            return constraints.problem.is_within(with_durations(path, part * T))

        assert not straight_in(1.0 / (1.001 * START_SCALING))
        gained.append(not straight_in(1.5))
    assert sum(gained) >= 3
    assert gained.count(False) >= 3


@pytest.mark.parametrize('effort', [100.0, 20.0, 5.0, 1.0])
def test_joint_1_alone_is_moved_however_weak_its_motor(effort):
    points = np.array([[0.2, 1.4, 0.1], [1.2, 1.4, 0.1]])
    limits = replace(LIMITS, max_velocity=NONE, max_acceleration=NONE, max_jerk=[1e4] * 3,
                     max_effort=[effort, 250.0, 200.0])
    constraints, m = slow_start(limits, uniform_mesh(1, 24), points)
    assert constraints.problem.is_within(m)
    # At constant inertia and full torque forth and back: the septic is slower by the square root
    # of a quarter of its largest normalised acceleration, 84 / (5 sqrt(5)).
    least = 2.0 * np.sqrt(inertia_matrix(ARM, points[0])[0, 0] / effort)
    assert least <= m.T[0] <= 1.05 * np.sqrt(0.25 * 84.0 / (5.0 * np.sqrt(5.0))) * least


def blocked(limit):
    """Return a task whose straight path needs more of joint 2; the limit [N m] is given."""
    points = np.array([[0.88, 1.29, -1.47], [0.51, 1.56, 0.91]])
    limits = replace(LIMITS, max_effort=[150.0, limit, 200.0])
    return JointTask(ARM, limits, points, None, 0.01), bounds(limits, uniform_mesh(1, 24), points)


def test_error_without_a_path_names_segment_joint_and_torque():
    task, constraints = blocked(45.0)
    task = replace(task, limits=replace(
        task.limits, min_position=[-2.9, 1.2, -2.9], max_position=[3.1, 1.6, 3.1]))
    assert not is_connected(task, margin=-2.0)
    assert rest_to_rest(task, constraints) is None
    error = cannot_be_held(replace(task, segment_numbers=np.array([4])), constraints.mesh.n)
    assert isinstance(error, LimitViolationError)
    torque = np.abs(gravity_torque(ARM, np.linspace(*task.points, 4001)))[:, 1].max()
    assert str(error).startswith('segment 4: no path found along which the motors can hold')
    assert error.joint == 'joint_2'
    assert error.limit == 45.0
    assert error.value == pytest.approx(torque, rel=1e-2)


@pytest.mark.parametrize(('joint', 'side', 'end'), [(1, 'max_position', 1.565),
                                                    (2, 'min_position', -1.48)])
def test_detours_stay_in_the_ranges(joint, side, end):
    task, _ = blocked(70.0)
    narrow = getattr(task.limits, side).copy()
    narrow[joint] = end
    limits = replace(task.limits, **{side: narrow})
    task = replace(task, limits=limits)
    constraints = bounds(limits, uniform_mesh(1, 24), task.points)
    assert is_connected(task, margin=2.0)
    q = constraints.mesh.states(task.points, rest_to_rest(task, constraints)).q
    assert (q <= limits.max_position + 1e-9).all()
    assert (q >= limits.min_position - 1e-9).all()
