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

"""Motions that start moving, slowed after their start."""

from dataclasses import replace

from helpers.spline_cases import ARM, closer, FREE
import numpy as np
import pytest
from rrr_traj_planner.planners.joint_timing.from_motion import from_motion
from rrr_traj_planner.planners.joint_timing.margins import Margins
from rrr_traj_planner.planners.joint_timing.problem import JointProblem
from rrr_traj_planner.planners.joint_timing.slowed_after_start import slowed_after_start
from rrr_traj_planner.planners.solver.interior_point import CentralPathPoint
from rrr_traj_planner.planners.solver.limits import DurationConstraints
from rrr_traj_planner.planners.solver.splines import uniform_mesh
from rrr_traj_planner.planners.tasks import JointTask, StartRates

SEGMENTS = 8


def solved(seed):
    """Return the problem of a motion that starts moving, and its solution."""
    rng = np.random.default_rng(seed)
    points = rng.uniform([-1.0, 0.8, -0.8], [1.0, 1.8, 0.8], (SEGMENTS + 1, 3))
    rates = StartRates(*rng.uniform(-0.4, 0.4, (2, 3)))
    task = JointTask(ARM, FREE, points, None, 0.01, start_rates=rates)
    durations = DurationConstraints.all_free(SEGMENTS, 3).from_motion()
    problem = JointProblem(task, uniform_mesh(SEGMENTS, 24), durations)
    constraints = problem.constraints(Margins.none(problem.mesh, SEGMENTS))
    start = from_motion(durations)(task, constraints)
    return problem, problem.minimised(constraints, CentralPathPoint(start, None), 1e-2)


@pytest.mark.parametrize('seed', range(8))
@pytest.mark.parametrize('part', [0.998, 0.99])
def test_motions_beyond_limits_keep_them_with_the_same_start_and_little_more_time(seed, part):
    problem, outcome = solved(seed)
    task = replace(problem.task, limits=closer(problem.task.limits, part))
    tighter = replace(problem, task=task)
    assert tighter.fitting(outcome, outcome.motion) is None
    slower = slowed_after_start(tighter, outcome.motion)
    found = tighter.fitting(outcome, slower).trajectory
    peaks, limits = found.peaks(), tighter.task.limits
    for name in ('velocity', 'acceleration', 'jerk'):
        assert (getattr(peaks, name) <= getattr(limits, f'max_{name}') * (1.0 + 1e-6)).all()
    assert found.via_times[-1] <= 1.05 * outcome.motion.T.sum()
    assert found(found.via_times)[0] == pytest.approx(problem.task.points, abs=1e-9)
    for given, asked in zip(found(0.0)[1:3], problem.task.start_rates):
        assert given == pytest.approx(asked, abs=1e-9)


def test_no_motion_comes_of_one_that_leaves_a_range_or_is_much_too_fast():
    problem, outcome = solved(0)
    far = closer(problem.task.limits, 0.5)
    narrow = replace(problem.task.limits, max_position=problem.task.points.max(axis=0) - 0.01)
    for limits in (far, narrow):
        other = replace(problem, task=replace(problem.task, limits=limits))
        assert slowed_after_start(other, outcome.motion) is None
