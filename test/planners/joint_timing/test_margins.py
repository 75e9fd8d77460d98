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

from helpers.spline_cases import all_free, ARM, bounds, LIMITS, NONE, random_motion, share_of
import numpy as np
import pytest
from rrr_traj_planner.core.dynamics.rigid_body import inverse_dynamics
from rrr_traj_planner.core.rounding import JOINT_ROUNDING
from rrr_traj_planner.planners.joint_timing.dense_check import JointCheck
from rrr_traj_planner.planners.joint_timing.least_time import fastest
from rrr_traj_planner.planners.joint_timing.margins import LARGER, Margins, MOST_MARGIN
from rrr_traj_planner.planners.joint_timing.problem import JointProblem
from rrr_traj_planner.planners.joint_timing.start import rest_to_rest
from rrr_traj_planner.planners.solver.interior_point import CentralPathPoint, minimise
from rrr_traj_planner.planners.tasks import JointTask

SEEDS = range(8)
KINDS = ('torque', 'velocity', 'range')
LESS = 0.2         # of what was exceeded, that is exceeded after margins were enlarged
COUNTS = 1e-4      # relative, that was exceeded
BETWEEN = 2e-3     # of what was exceeded, that a dense mesh may miss
CHECKS = 100        # of the dense mesh from point to point
NEAR = 0.02        # relative: motions of 8 intervals exceed a limit far between the points
KEPT = 1e-6        # relative: by so little more, a limit counts as kept


def never():
    return False


def limits_of(kind, points):
    """Return limits of which one kind is what shapes motions."""
    if kind == 'torque':
        return replace(LIMITS, max_acceleration=NONE, max_jerk=[1e3] * 3)
    if kind == 'velocity':
        return replace(LIMITS, max_velocity=[0.4, 0.3, 0.5], max_acceleration=[1.2] * 3,
                       max_effort=NONE)
    return replace(LIMITS, max_effort=NONE, max_acceleration=[4.0] * 3,
                   min_position=points.min(axis=0) - 3e-3, max_position=points.max(axis=0) + 3e-3)


def with_stays(durations, stays):
    """Return constraints under which joints stay at via points too."""
    fixed = durations.fixed.copy()
    fixed[1:-1] |= stays
    return durations._replace(fixed=fixed)


def constraints_with(margins, task, mesh, least_T=None):
    """Return a task's limits less margins."""
    return JointProblem(task, mesh, all_free(len(task.points) - 1), least_T).constraints(margins)


class Case:
    """A least-time motion that keeps its limits at the points, and the margins found for it."""

    def __init__(self, kind, seed):
        self.mesh, self.points, _ = random_motion(seed, n=12)
        self.task = JointTask(ARM, limits_of(kind, self.points), self.points, None, 0.01)
        self.none = Margins.none(self.mesh, len(self.points) - 1)
        self.slow, self.motion = self.solved(self.none)
        self.margins = self.none.widened(self.task, self.mesh, self.slow, self.check(self.motion))

    def solved(self, margins):
        """Return the motion to begin with and the fastest one, with margins."""
        constraints = constraints_with(margins, self.task, self.mesh)
        start, durations = rest_to_rest(self.task, constraints), all_free(len(self.points) - 1)
        assert constraints.problem.is_within(start)
        return start, minimise(constraints.problem, CentralPathPoint(start, None),
                               with_stays(durations, margins.stays), never).motion

    def check(self, m):
        return JointCheck(self.task, self.mesh, m)

    def trajectory(self, m):
        return self.mesh.trajectory(self.points, m)

    def excess(self, m):
        """Return what `beyond` does on a dense grid, (N, samples, 3)."""
        ends = np.concatenate(([0.0], np.cumsum(m.T)))
        t = np.array([begin + T * self.dense_parts(k) for k, (begin, T) in enumerate(
            zip(ends[:-1], m.T))])
        return [x.reshape(*t.shape, 3) for x in self.beyond(self.trajectory(m), t.ravel())]

    def beyond(self, trajectory, t):
        """Return what range, velocity, acceleration and torque are exceeded by at times."""
        (q, qd, qdd, _), limits = trajectory(t), self.task.limits
        return (q - limits.max_position, limits.min_position - q, np.abs(qd) - limits.max_velocity,
                np.abs(qdd) - limits.max_acceleration,
                np.abs(inverse_dynamics(ARM, q, qd, qdd)) - limits.max_effort)

    def dense_parts(self, k):
        """Return CHECKS places from point to point of a segment, as parts of it."""
        starts, part = self.mesh.starts[k], np.arange(2 * CHECKS) / (2 * CHECKS)
        return np.append((starts[:-1, np.newaxis] + self.mesh.parts[k][:, np.newaxis]
                          * part).ravel(), 1.0)

    def near(self, excess, width):
        """Return the largest excess so far around every point, points in the order of time."""
        samples = excess.shape[1]
        rows = [excess[:, max(i - width, 0):i + width + 1].max(axis=1)
                for i in range(0, samples, CHECKS)]
        return np.stack(rows, axis=1)

    def in_time(self, margins):
        """Return margins at the points in the order of time."""
        n = self.mesh.n
        order = np.stack((np.arange(n), n + 1 + np.arange(n)), axis=1).ravel()
        return margins[..., np.append(order, n), :]


case = cache(Case)
every = pytest.mark.parametrize(('kind', 'seed'), [(k, s) for k in KINDS for s in SEEDS])


@pytest.mark.parametrize('seed', SEEDS)
def test_no_margins_leave_the_limits_as_they_are(seed):
    mesh, points, m = random_motion(seed)
    task = JointTask(ARM, LIMITS, points, None, 0.01)
    for least_T in (None, 0.5 * m.T):
        constraints = constraints_with(Margins.none(mesh, len(m.T)), task, mesh, least_T)
        found = constraints.problem.slacks(m)
        assert (found == bounds(LIMITS, mesh, points, least_T).problem.slacks(m)).all()


@every
def test_margins_grow_by_what_is_exceeded_around_each_point(kind, seed):
    c = case(kind, seed)
    excess = c.excess(c.motion)[2:]
    limits = c.task.limits
    for margins, x, most in (
            (c.margins.velocities, excess[0], MOST_MARGIN * limits.max_velocity),
            (c.margins.accelerations, excess[1], MOST_MARGIN * limits.max_acceleration),
            (c.margins.efforts, excess[2], np.inf)):
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
                              (c.margins.accelerations, excess[1], limits.max_acceleration),
                              (c.margins.efforts, excess[2], limits.max_effort)):
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
    q = c.mesh.states(c.points, c.slow).q
    own = np.stack((c.task.limits.max_position - q, q - c.task.limits.min_position))
    assert (c.margins.positions <= 0.5 * np.maximum(own, 0.0)).all()


def test_ranges_velocities_and_torques_are_all_exceeded_by_some_motion():
    for kind, kinds in (('torque', (2, 4)), ('velocity', (2, 3)), ('range', (0, 1))):
        for k in kinds:
            assert any(case(kind, seed).excess(case(kind, seed).motion)[k].max() > COUNTS
                       for seed in SEEDS)


@every
def test_a_motion_planned_again_with_margins_exceeds_much_less(kind, seed):
    c = case(kind, seed)
    _, again = c.solved(c.margins)
    scales = (1.0, 1.0, *(np.where(np.isinf(x), 1.0, x) for x in (
        c.task.limits.max_velocity, c.task.limits.max_acceleration,
        c.task.limits.max_effort)))
    before, after = (np.array([(x / scale).max() for x, scale in zip(c.excess(m), scales)])
                     for m in (c.motion, again))
    # Where a joint is to stop at a via point from now on, the motion takes another course, which
    # exceeds limits in other places: what the first round makes of it says nothing.
    assert (after <= np.maximum(LESS * before, COUNTS)).all() or c.margins.stays.any()


@every
def test_rounds_of_tightening_end_near_the_optimum_within_every_limit(kind, seed):
    c = case(kind, seed)
    found = fastest(c.task, c.mesh)
    assert found.gap <= NEAR * found.cost
    assert found.cost <= (1.0 + NEAR) * found.motion.T.sum()
    t = np.linspace(0.0, found.trajectory.duration, 20_001)  # on a mesh of its own
    exceeded = [x.max() for x in c.beyond(found.trajectory, t)]
    assert max(exceeded[:2]) <= JOINT_ROUNDING
    assert max(exceeded[2:]) <= KEPT * max(
        limit.max() for limit in (c.task.limits.max_velocity, c.task.limits.max_acceleration,
                                  c.task.limits.max_effort)
        if np.isfinite(limit).all())


@every
def test_margins_stay_as_they_were_where_no_limit_is_broken(kind, seed):
    c = case(kind, seed)
    again = c.margins.widened(c.task, c.mesh, c.slow, c.check(c.slow))
    assert max(x.max() for x in c.excess(c.slow)) <= 1e-9
    for name in ('positions', 'velocities', 'accelerations', 'efforts', 'stays'):
        assert (getattr(again, name) == getattr(c.margins, name)).all()


@every
def test_margins_never_shrink(kind, seed):
    c = case(kind, seed)
    more = c.margins.widened(c.task, c.mesh, c.slow, c.check(c.motion))
    for name in ('velocities', 'accelerations', 'efforts', 'positions'):
        assert (getattr(more, name) >= getattr(c.margins, name)).all()


@pytest.mark.parametrize('seed', SEEDS)
def test_a_part_of_margins_is_a_part_of_every_margin(seed):
    c = case('torque', seed)
    none, half, whole = (constraints_with(c.margins.part(x), c.task, c.mesh).problem.slacks(
        c.slow) for x in (0.0, 0.5, 1.0))
    assert half == pytest.approx(0.5 * (none + whole))
    assert (none == bounds(c.task.limits, c.mesh, c.points).problem.slacks(c.slow)).all()


@pytest.mark.parametrize('seed', SEEDS)
def test_margins_leave_a_slow_motion_half_of_what_gravity_leaves(seed):
    c = case('torque', seed)
    large = c.margins._replace(efforts=c.margins.efforts + 1e3).of_slow_motion()
    bound = constraints_with(large, c.task, c.mesh).effort
    q = c.mesh.states(c.points, c.slow).q[:, 1:]
    tau = np.abs(inverse_dynamics(ARM, q, np.zeros_like(q), np.zeros_like(q)))
    assert bound == pytest.approx(0.5 * (c.task.limits.max_effort + tau))
    assert share_of(c.task, q).max() < 1.0


def test_joints_that_leave_their_range_beside_a_via_point_at_its_end_stop_there():
    found = []
    for seed in range(24):
        mesh, points, m = random_motion(seed, n=8, segments=3)
        k, j = 1 + seed % 2, seed % 3
        points[:, j] = np.minimum(points[:, j], points[k, j] - 0.05 * (np.arange(4) != k))
        limits = replace(LIMITS, max_effort=NONE, max_position=np.where(
            np.arange(3) == j, points[k, j], LIMITS.max_position))
        task = JointTask(ARM, limits, points, None, 0.01)
        m = mesh.restored(points, m)
        margins = Margins.none(mesh, 3)
        slow = rest_to_rest(task, constraints_with(margins, task, mesh))
        check = JointCheck(task, mesh, m)
        stays = margins.widened(task, mesh, slow, check).stays
        beside = mesh.states(points, m).q[[k - 1, k], :, j].max() > points[k, j] + 1e-6
        again = margins._replace(stays=stays).widened(task, mesh, slow, check).stays
        # First the velocity is zero; where the joint leaves its range even so, the others too.
        assert not beside or (stays[k - 1, 0, j] and again[k - 1, :, j].all())
        assert not stays[:, 1:].any()
        assert not np.delete(again, j, axis=2).any()
        found.append(bool(beside))
    assert any(found)
