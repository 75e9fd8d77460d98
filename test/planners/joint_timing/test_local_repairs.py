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

"""Long motions that are mended where they exceed limits: judged on a dense grid of times."""

from dataclasses import replace
from functools import cache

from helpers.spline_cases import all_free, ARM, LIMITS, NONE, random_motion
import numpy as np
import pytest
from rrr_traj_planner.core.dynamics.motor_torque import motor_torque
from rrr_traj_planner.planners.joint_timing.local_repairs import LocalRepairs, TOLERANCE
from rrr_traj_planner.planners.joint_timing.margins import Margins
from rrr_traj_planner.planners.joint_timing.problem import JointProblem
from rrr_traj_planner.planners.joint_timing.start import rest_to_rest
from rrr_traj_planner.planners.joint_timing.tightening import tightened
from rrr_traj_planner.planners.solver.interior_point import CentralPathPoint
from rrr_traj_planner.planners.tasks import JointTask

SEEDS = range(3)
LONG = 30       # segments
PER_SEGMENT = 2000  # instants
BETWEEN = 2e-5  # relative, by which samples of the check may miss a peak
END = 1e-8      # rad, by which a joint may leave its range
SLOWER = 2e-3   # than without limits between the points
ROUNDING = 1e-9


class Case:
    """A motion near its ranges and limits, fastest but for what it exceeds between the points."""

    def __init__(self, seed, should_stop=lambda: False):
        mesh, points, _ = random_motion(seed, n=12, segments=LONG)
        limits = replace(LIMITS, max_effort=NONE, min_position=points.min(axis=0) - 3e-3,
                         max_position=points.max(axis=0) + 3e-3)
        self.problem = JointProblem(JointTask(
            ARM, limits, points, None, 0.01, should_stop=should_stop), mesh, all_free(LONG))
        self.margins = Margins.none(mesh, LONG)
        constraints = self.problem.constraints(self.margins)
        self.slow = rest_to_rest(self.problem.task, constraints)
        self.outcome = self.problem.minimised(constraints, CentralPathPoint(self.slow, None))
        self.repairs = LocalRepairs(self.problem, self.margins, self.slow, self.outcome)
        self.mended = self.repairs.mend()

    def exceeded(self, m):
        """Return by which part each segment exceeds speeds, and how far it leaves ranges [rad]."""
        limits, found = self.problem.task.limits, self.problem.mesh.trajectory(
            self.problem.task.points, m)
        ends = found.via_times
        q, qd, qdd, _ = found(np.concatenate([
            np.linspace(begin, end, PER_SEGMENT) for begin, end in zip(ends, ends[1:])]))
        factor = np.maximum(np.abs(qd) / limits.max_velocity,
                            np.sqrt(np.abs(qdd) / limits.max_acceleration)) - 1.0
        beyond = np.maximum(q - limits.max_position, limits.min_position - q)
        return [f.reshape(LONG, -1).max(axis=1) for f in (factor, beyond)]


case = cache(Case)


@pytest.mark.parametrize('seed', SEEDS)
def test_what_was_exceeded_between_the_points_is_not_after_the_repairs(seed):
    before, after = (case(seed).exceeded(m) for m in (
        case(seed).outcome.motion, case(seed).repairs.motion))
    assert case(seed).mended
    assert (before[0] > TOLERANCE + BETWEEN).any()
    assert (before[1] > END).any()
    assert after[0].max() < TOLERANCE + BETWEEN
    assert after[1].max() < END


@pytest.mark.parametrize('seed', SEEDS)
def test_segments_that_exceed_nothing_and_have_no_such_neighbours_stay_as_they_are(seed):
    this = case(seed)
    before, after = this.outcome.motion, this.repairs.motion
    factor, beyond = this.exceeded(before)
    kept = np.flatnonzero(before.T == after.T)
    assert 0 < len(kept) < LONG
    assert np.array_equal(before.inner[kept], after.inner[kept])
    assert (factor[kept] < TOLERANCE + BETWEEN).all()
    assert (beyond[kept] < END).all()


@pytest.mark.parametrize('seed', SEEDS)
def test_the_motion_stays_continuous_through_its_via_points_and_nearly_as_fast(seed):
    this = case(seed)
    m, mesh, points = this.repairs.motion, this.problem.mesh, this.problem.task.points
    at = mesh.states(points, m)
    ends = [f[:, mesh.n] for f in at]
    for end, via in zip(ends, (points, m.v, m.a, m.j)):
        assert end == pytest.approx(via[1:], abs=ROUNDING * max(1.0, np.abs(end).max()))
    assert not np.any([m.v[[0, -1]], m.a[[0, -1]], m.j[[0, -1]]])
    assert m.T.sum() < (1.0 + SLOWER) * this.outcome.motion.T.sum()


@pytest.mark.parametrize('seed', SEEDS)
def test_whole_rounds_keep_the_limits_where_repairs_fail(seed, monkeypatch):
    monkeypatch.setattr(LocalRepairs, 'mend', lambda repairs: False)
    this = case(seed)
    found = tightened(this.problem, rest_to_rest)
    factor, beyond = this.exceeded(found.motion)
    slowed = found.cost / found.motion.T.sum() - 1.0
    assert factor.max() < slowed + BETWEEN
    assert beyond.max() < END


def test_repairs_end_where_planning_is_to_stop():
    begun = case(0)
    stopped = LocalRepairs(
        replace(begun.problem, task=replace(begun.problem.task, should_stop=lambda: True)),
        begun.margins, begun.slow, begun.outcome)
    assert not stopped.mend()
    assert stopped.motion.T.tolist() == begun.outcome.motion.T.tolist()


@pytest.mark.parametrize('seed', SEEDS)
def test_the_rounds_of_a_long_motion_return_the_mended_one(seed):
    found = tightened(case(seed).problem, rest_to_rest)
    factor, beyond = case(seed).exceeded(found.motion)
    assert factor.max() < TOLERANCE + BETWEEN
    assert beyond.max() < END
    assert found.cost < (1.0 + TOLERANCE + BETWEEN) * case(seed).repairs.motion.T.sum()


@pytest.mark.parametrize('seed', SEEDS)
def test_motions_by_torque_are_mended_until_none_exceeds_a_torque(seed, monkeypatch):
    mended, mend = [], LocalRepairs.mend
    monkeypatch.setattr(
        LocalRepairs, 'mend', lambda repairs: mended.append(mend(repairs)) or mended[-1])
    mesh, points, _ = random_motion(seed, n=12, segments=2 * LONG)
    limits = replace(LIMITS, max_acceleration=NONE, max_jerk=[100.0] * 3)
    problem = JointProblem(JointTask(ARM, limits, points, None, 0.01), mesh, all_free(2 * LONG))
    found = tightened(problem, rest_to_rest)
    assert mended == [True]
    t = np.linspace(0.0, found.trajectory.duration, 2 * LONG * PER_SEGMENT)
    q, qd, qdd, _ = found.trajectory(t)
    torque = np.abs(motor_torque(ARM, q, qd, qdd)).max(axis=0) / limits.max_effort
    assert 1.0 - 1e-3 < torque.max() < 1.0 + 1e-6
