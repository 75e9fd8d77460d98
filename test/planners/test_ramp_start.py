"""The motion that the method begins with: stops at every via point, strictly within all limits."""

from dataclasses import replace

import numpy as np
import pytest
from ramp_cases import ARM, bounds, LIMITS, NONE, random_motion, slow_start
from rrr_traj_planner.core.dynamics import gravity_torque
from rrr_traj_planner.core.errors import LimitViolationError
from rrr_traj_planner.planners.ramp_chain import Grid
from rrr_traj_planner.planners.ramp_start import cannot_be_held, rest_to_rest
from rrr_traj_planner.planners.request import JointTask

SEEDS = range(12)
ROOM = 1.02


@pytest.mark.parametrize('limits', [LIMITS, replace(LIMITS, max_effort=NONE), replace(
    LIMITS, max_acceleration=NONE, max_jerk=NONE)], ids=['all', 'no torque', 'torque'])
@pytest.mark.parametrize('seed', SEEDS)
def test_start_stops_at_every_via_point_strictly_within_all_limits(seed, limits):
    grid, points, _ = random_motion(seed)
    constraints, m = slow_start(limits, grid, points)
    at = grid.states(points, m)
    assert min(s.min() for s in constraints.slacks(m)) > 0.0
    assert at.q[:, grid.n] == pytest.approx(points[1:], abs=1e-12)
    assert (m.v == 0.0).all()
    assert at.qd[:, grid.n] == pytest.approx(np.zeros_like(points[1:]), abs=1e-12)


@pytest.mark.parametrize('seed', SEEDS)
def test_start_is_slower_than_it_must_be_by_two_percent_only(seed):
    grid, points, _ = random_motion(seed)
    constraints, m = slow_start(LIMITS, grid, points)
    faster = grid.slowed(m, m.T / (1.001 * ROOM))
    slacks = constraints.slacks(faster)
    for k in range(len(m.T)):  # in each segment some limit is then broken
        assert min(s[:, k].min() for s in slacks) < 0.0


def test_floors_are_kept():
    grid, points, _ = random_motion(3)
    floor = np.full(len(points) - 1, 30.0)
    assert (slow_start(LIMITS, grid, points, floor)[1].T == ROOM * floor).all()


def blocked(limit):
    """Return a task whose straight way takes 80.8 N m of joint 2, its ends 41.3 N m."""
    points = np.array([[0.88, 1.29, -1.47], [0.51, 1.56, 0.91]])
    limits = replace(LIMITS, max_effort=[150.0, limit, 200.0])
    return JointTask(ARM, limits, points, None, 0.01), bounds(limits, Grid(20), points)


def test_a_blocked_way_goes_over_the_vertical_and_keeps_the_forearm_s_direction_there():
    task, constraints = blocked(70.0)
    straight = np.linspace(*task.points, 201)
    assert np.abs(gravity_torque(ARM, straight))[:, 1].max() > 80.0
    m = rest_to_rest(task, constraints)
    q = constraints.grid.states(task.points, m).q[0]
    assert (np.abs(gravity_torque(ARM, q)) < task.limits.max_effort).all()
    assert q[:, 1].max() > task.points[:, 1].max() - 1e-12
    up = q[:8]  # on the first leg joint 1 waits, and theta_2 + theta_3 stays
    assert up[:, 0] == pytest.approx(np.full(8, task.points[0, 0]), abs=1e-12)
    assert up[:, 1:].sum(axis=1) == pytest.approx(np.full(8, up[0, 1:].sum()), abs=1e-12)


def test_where_no_way_is_found_there_is_none_and_the_error_names_segment_joint_and_torque():
    task, constraints = blocked(45.0)
    assert rest_to_rest(task, constraints) is None
    error = cannot_be_held(replace(task, segment_numbers=np.array([4])), constraints.grid)
    assert isinstance(error, LimitViolationError)
    torque = np.abs(gravity_torque(ARM, np.linspace(*task.points, 4001)))[:, 1].max()
    assert str(error).startswith('segment 4: no way is found on which the motors can hold')
    assert error.joint == 'joint_2'
    assert error.limit == 45.0
    assert error.value == pytest.approx(torque, rel=1e-2)


def test_detours_stay_in_the_ranges():
    task, constraints = blocked(70.0)
    narrow = replace(task.limits, max_position=[3.0, 1.565, 3.0])
    m = rest_to_rest(replace(task, limits=narrow), constraints)
    if m is not None:
        assert (constraints.grid.states(task.points, m).q[..., 1] <= 1.565 + 1e-9).all()
    # theta_3 of the first pose would rise beyond its range: no detour
    shut = replace(task.limits, min_position=[-3.0, -3.0, -1.48])
    m = rest_to_rest(replace(task, limits=shut), constraints)
    if m is not None:
        assert (constraints.grid.states(task.points, m).q[..., 2] >= -1.48 - 1e-9).all()
