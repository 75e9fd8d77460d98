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

"""Margins for what happens between points, against dense evaluation around every point."""

from dataclasses import replace
from functools import cache

from helpers.ramp_cases import all_free, ARM, bounds, LIMITS, NONE, random_motion, share_of
import numpy as np
import pytest
from rrr_traj_planner.core.dynamics.rigid_body import inverse_dynamics
from rrr_traj_planner.core.rounding import JOINT_ROUNDING
from rrr_traj_planner.planners.joint_timing.dense_check import JointCheck
from rrr_traj_planner.planners.joint_timing.least_time import fastest
from rrr_traj_planner.planners.joint_timing.margins import LARGER, Margins, MOST_VELOCITY_MARGIN
from rrr_traj_planner.planners.joint_timing.problem import JointProblem
from rrr_traj_planner.planners.joint_timing.start import rest_to_rest
from rrr_traj_planner.planners.solver.interior_point import CentralPathPoint, minimise
from rrr_traj_planner.planners.solver.ramps import time_scaled
from rrr_traj_planner.planners.tasks import JointTask

SEEDS = range(8)
KINDS = ('torque', 'velocity', 'range')
LESS = 0.2         # of what was exceeded, that is exceeded after margins were enlarged
COUNTS = 1e-4      # relative, that was exceeded
BETWEEN = 2e-3     # of what was exceeded, that a dense grid may miss
CHECKS = 100        # of the dense grid from point to point
NEAR = 0.02        # relative: chains of 8 ramps exceed a limit far between the points
KEPT = 1e-6        # relative: by so little more, a limit counts as kept


def never():
    return False


def limits_of(kind, points):
    """Return limits of which one kind is what shapes motions."""
    if kind == 'torque':
        return replace(LIMITS, max_acceleration=NONE, max_jerk=[50.0] * 3)
    if kind == 'velocity':
        return replace(LIMITS, max_velocity=[0.4, 0.3, 0.5], max_acceleration=[3.0] * 3,
                       max_effort=NONE)
    return replace(LIMITS, max_effort=NONE, max_acceleration=[4.0] * 3,
                   min_position=points.min(axis=0) - 3e-3, max_position=points.max(axis=0) + 3e-3)


def constraints_with(margins, task, grid, least_T=None):
    """Return a task's limits less margins."""
    return JointProblem(task, grid, all_free(len(task.points) - 1), least_T).constraints(margins)


class Case:
    """A least-time motion that keeps its limits at the points, and the margins found for it."""

    def __init__(self, kind, seed):
        self.grid, self.points, _ = random_motion(seed, n=8)
        self.task = JointTask(ARM, limits_of(kind, self.points), self.points, None, 0.01)
        self.none = Margins.none(self.grid, len(self.points) - 1)
        self.slow, self.motion = self.solved(self.none)
        self.margins = self.none.widened(self.task, self.grid, self.slow, self.check(self.motion))

    def solved(self, margins):
        """Return the motion to begin with and the fastest one, with margins."""
        constraints = constraints_with(margins, self.task, self.grid)
        start, durations = rest_to_rest(self.task, constraints), all_free(len(self.points) - 1)
        assert constraints.problem.is_within(start)
        return start, minimise(constraints.problem, CentralPathPoint(start, None),
                               durations._replace(fixed_velocities=margins.at_rest), never).motion

    def check(self, m):
        return JointCheck(self.task, self.grid, m)

    def trajectory(self, m):
        return self.grid.trajectory(self.points, m)

    def excess(self, m):
        """Return what range, velocity and torque are exceeded by, each (N, samples, 3)."""
        ends = np.concatenate(([0.0], np.cumsum(m.T)))
        t = np.linspace(ends[:-1], ends[1:], 2 * self.grid.n * CHECKS + 1, axis=1)
        q, qd, qdd, _ = (f.reshape(*t.shape, 3) for f in self.trajectory(m)(t.ravel()))
        limits = self.task.limits
        return (q - limits.max_position, limits.min_position - q, np.abs(qd) - limits.max_velocity,
                np.abs(inverse_dynamics(ARM, q, qd, qdd)) - limits.max_effort)

    def near(self, excess, width):
        """Return the largest excess so far around every point, points in the order of time."""
        samples = excess.shape[1]
        rows = [excess[:, max(i - width, 0):i + width + 1].max(axis=1)
                for i in range(0, samples, CHECKS)]
        return np.stack(rows, axis=1)

    def in_time(self, margins):
        """Return margins at the points in the order of time."""
        n = self.grid.n
        order = np.stack((np.arange(n), n + 1 + np.arange(n)), axis=1).ravel()
        return margins[..., np.append(order, n), :]


case = cache(Case)
every = pytest.mark.parametrize(('kind', 'seed'), [(k, s) for k in KINDS for s in SEEDS])


@pytest.mark.parametrize('seed', SEEDS)
def test_no_margins_leave_the_limits_as_they_are(seed):
    grid, points, m = random_motion(seed)
    task = JointTask(ARM, LIMITS, points, None, 0.01)
    for least_T in (None, 0.5 * m.T):
        constraints = constraints_with(Margins.none(grid, len(m.T)), task, grid, least_T)
        found = constraints.problem.slacks(m)
        assert (found == bounds(LIMITS, grid, points, least_T).problem.slacks(m)).all()


@every
def test_margins_grow_by_what_is_exceeded_around_each_point(kind, seed):
    c = case(kind, seed)
    excess = c.excess(c.motion)[2:]
    for margins, x, most in ((c.margins.velocities, excess[0],
                              MOST_VELOCITY_MARGIN * c.task.limits.max_velocity),
                             (c.margins.efforts, excess[1], np.inf)):
        near = c.near(x, CHECKS // 2)
        # limits do not count at a segment's first point: those beside it stand for it
        near[:, 1] = np.maximum(near[:, 1], near[:, 0])
        near[:-1, -1] = np.maximum(near[:-1, -1], near[1:, 0])
        least = np.minimum(np.maximum(near, 0.0), most)
        assert (c.in_time(margins) >= least * (1.0 - BETWEEN)).all()
        assert (margins <= most).all()


@every
def test_margins_grow_nowhere_else(kind, seed):
    c = case(kind, seed)
    limits, excess = c.task.limits, c.excess(c.motion)[2:]
    for margins, x, limit in ((c.margins.velocities, excess[0], limits.max_velocity),
                              (c.margins.efforts, excess[1], limits.max_effort)):
        if np.isinf(limit).all():
            assert (margins == 0.0).all()
            continue
        near = c.near(x, CHECKS // 2 + CHECKS // 4)
        near[:, 1] = np.maximum(near[:, 1], near[:, 0])
        near[:-1, -1] = np.maximum(near[:-1, -1], near[1:, 0])
        far = near < -BETWEEN * limit
        assert (c.in_time(margins)[far] == 0.0).all()
        assert far.any()
        # no more than the factor, of what is exceeded by more than rounding
        most = LARGER * np.maximum(near, 0.0) * 1.3 + BETWEEN * limit
        assert (c.in_time(margins) <= most).all()


@every
def test_positions_have_margins_where_and_in_the_direction_that_a_range_is_left(kind, seed):
    c = case(kind, seed)
    beyond = np.stack(c.excess(c.motion)[:2]).max(axis=2)        # (2, N, 3)
    made = c.margins.positions.max(axis=2)
    assert (made[beyond > 1e-7] > 0.0).all()
    assert (made[beyond < 0.0] == 0.0).all()
    # a slow motion still has half of its own distance to the ends
    q = c.grid.states(c.points, c.slow).q
    own = np.stack((c.task.limits.max_position - q, q - c.task.limits.min_position))
    assert (c.margins.positions <= 0.5 * np.maximum(own, 0.0)).all()


def test_ranges_velocities_and_torques_are_all_exceeded_by_some_motion():
    for kind, kinds in (('torque', (2, 3)), ('velocity', (2,)), ('range', (0, 1))):
        for k in kinds:
            assert any(case(kind, seed).excess(case(kind, seed).motion)[k].max() > COUNTS
                       for seed in SEEDS)


@every
def test_a_motion_planned_again_with_margins_exceeds_much_less(kind, seed):
    c = case(kind, seed)
    _, again = c.solved(c.margins)
    scales = (1.0, 1.0, *(np.where(np.isinf(x), 1.0, x) for x in (
        c.task.limits.max_velocity, c.task.limits.max_effort)))
    before, after = (np.array([(x / scale).max() for x, scale in zip(c.excess(m), scales)])
                     for m in (c.motion, again))
    # Where a joint is to stop at a via point from now on, the motion takes another course, which
    # exceeds limits in other places: what the first round makes of it says nothing.
    assert (after <= np.maximum(LESS * before, COUNTS)).all() or c.margins.at_rest.any()


@every
def test_rounds_of_tightening_end_near_the_optimum_within_every_limit(kind, seed):
    c = case(kind, seed)
    found = fastest(c.task, c.grid)
    assert found.gap <= NEAR * found.cost
    slower = found.cost / found.motion.T.sum()
    assert slower <= 1.0 + NEAR
    exceeded = [x.max() for x in c.excess(time_scaled(found.motion, slower))]
    assert max(exceeded[:2]) <= JOINT_ROUNDING
    assert max(exceeded[2:]) <= KEPT * max(
        limit.max() for limit in (c.task.limits.max_velocity, c.task.limits.max_effort)
        if np.isfinite(limit).all())


@every
def test_margins_stay_as_they_were_where_no_limit_is_broken(kind, seed):
    c = case(kind, seed)
    again = c.margins.widened(c.task, c.grid, c.slow, c.check(c.slow))
    assert max(x.max() for x in c.excess(c.slow)) <= 1e-9
    for name in ('positions', 'velocities', 'efforts', 'at_rest'):
        assert (getattr(again, name) == getattr(c.margins, name)).all()


@every
def test_margins_never_shrink(kind, seed):
    c = case(kind, seed)
    more = c.margins.widened(c.task, c.grid, c.slow, c.check(c.motion))
    for name in ('velocities', 'efforts', 'positions'):
        assert (getattr(more, name) >= getattr(c.margins, name)).all()


@pytest.mark.parametrize('seed', SEEDS)
def test_a_part_of_margins_is_a_part_of_every_margin(seed):
    c = case('torque', seed)
    none, half, whole = (constraints_with(c.margins.part(x), c.task, c.grid).problem.slacks(
        c.slow) for x in (0.0, 0.5, 1.0))
    assert half == pytest.approx(0.5 * (none + whole))
    assert (none == bounds(c.task.limits, c.grid, c.points).problem.slacks(c.slow)).all()


@pytest.mark.parametrize('seed', SEEDS)
def test_margins_leave_a_slow_motion_half_of_what_gravity_leaves(seed):
    c = case('torque', seed)
    large = c.margins._replace(efforts=c.margins.efforts + 1e3).of_slow_motion()
    bound = constraints_with(large, c.task, c.grid).effort
    q = c.grid.states(c.points, c.slow).q[:, 1:]
    tau = np.abs(inverse_dynamics(ARM, q, np.zeros_like(q), np.zeros_like(q)))
    assert bound == pytest.approx(0.5 * (c.task.limits.max_effort + tau))
    assert share_of(c.task, q).max() < 1.0


def test_joints_that_leave_their_range_beside_a_via_point_at_its_end_stop_there():
    found = []
    for seed in range(24):
        grid, points, m = random_motion(seed, n=8, segments=3)
        k, j = 1 + seed % 2, seed % 3
        points[:, j] = np.minimum(points[:, j], points[k, j] - 0.05 * (np.arange(4) != k))
        limits = replace(LIMITS, max_effort=NONE, max_position=np.where(
            np.arange(3) == j, points[k, j], LIMITS.max_position))
        task = JointTask(ARM, limits, points, None, 0.01)
        m = grid.restored(points, m)
        margins = Margins.none(grid, 3)
        slow = rest_to_rest(task, constraints_with(margins, task, grid))
        at_rest = margins.widened(task, grid, slow, JointCheck(task, grid, m)).at_rest
        beside = grid.states(points, m).q[[k - 1, k], :, j].max() > points[k, j] + 1e-6
        assert not beside or at_rest[k - 1, j]
        assert not np.delete(at_rest, j, axis=1).any()
        found.append(bool(beside))
    assert any(found)
