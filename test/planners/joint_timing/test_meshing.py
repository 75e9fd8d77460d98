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

"""Refined meshes, of which a few segments may keep the mesh that they had."""

from dataclasses import replace

from helpers.spline_cases import all_free, ARM, FREE
import numpy as np
import pytest
from rrr_traj_planner.planners.joint_timing import meshing
from rrr_traj_planner.planners.joint_timing.margins import Margins
from rrr_traj_planner.planners.joint_timing.problem import JointProblem
from rrr_traj_planner.planners.joint_timing.start import rest_to_rest
from rrr_traj_planner.planners.methods.time_optimal import plan
from rrr_traj_planner.planners.solver.refinement import moved
from rrr_traj_planner.planners.solver.splines import Mesh, uniform_mesh
from rrr_traj_planner.planners.tasks import JointTask

LONG, INTERVALS = 40, 10
SEEDS = range(3)


def long_problem(seed):
    rng = np.random.default_rng(9100 + seed)
    points = rng.uniform([-1.0, 0.8, -0.8], [1.0, 1.8, 0.8], (LONG + 1, 3))
    task = JointTask(ARM, FREE, points, None, 0.01)
    return JointProblem(task, uniform_mesh(LONG, INTERVALS), all_free(LONG))


@pytest.mark.parametrize('kept', [0.0, 0.2])
@pytest.mark.parametrize('seed', SEEDS)
def test_a_motion_on_the_refined_mesh_is_within_the_limits_and_faster(seed, kept, monkeypatch):
    monkeypatch.setattr(meshing, 'KEPT', kept)
    problem = long_problem(seed)
    remeshed, first = meshing.meshed(problem, rest_to_rest)
    constraints = remeshed.constraints(Margins.none(remeshed.mesh, LONG))
    start, points = first(problem.task, constraints), problem.task.points
    assert constraints.is_within(start)
    slow = rest_to_rest(problem.task, problem.constraints(Margins.none(problem.mesh, LONG)))
    assert start.T.sum() < 0.9 * slow.T.sum()
    assert remeshed.mesh.states(points, start).q[:, INTERVALS] == pytest.approx(
        points[1:], abs=1e-9)


@pytest.mark.parametrize(('most', 'is_kept'), [(0.03, True), (0.02, False)])
def test_a_segment_that_would_exceed_limits_keeps_its_mesh_if_few_do(most, is_kept, monkeypatch):
    # Of 40 segments one, 2.5 %, exceeds its limits so far that no slower motion helps.
    monkeypatch.setattr(meshing, 'KEPT', most)
    problem = long_problem(0)
    points, margins = problem.task.points, Margins.none(problem.mesh, LONG)
    before = rest_to_rest(problem.task, problem.constraints(margins))
    parts = np.random.default_rng(9200).uniform(0.9, 1.1, (LONG, INTERVALS))
    mesh = Mesh(parts / parts.sum(axis=1, keepdims=True))
    motion = moved(problem.mesh, mesh, points, before)
    motion.inner[7] *= 100.0
    found = meshing.slower_on(problem, before, mesh, motion)
    if not is_kept:
        assert found is None
        return
    remeshed, slower = found
    same = (remeshed.mesh.parts == mesh.parts).all(axis=1)
    assert np.flatnonzero(~same).tolist() == [7]
    assert remeshed.mesh.parts[7] == pytest.approx(problem.mesh.parts[7])
    assert remeshed.constraints(margins).is_within(slower)
    assert remeshed.mesh.states(points, slower).q[:, INTERVALS] == pytest.approx(
        points[1:], abs=1e-9)


@pytest.mark.parametrize('speed', [0.01, 0.05, 0.2])
@pytest.mark.parametrize('way', [0.5, 2.0])
def test_long_cruises_between_short_ramps_take_the_least_time(way, speed):
    # Ramps with jerk J and acceleration a: Biagiotti & Melchiorri, Trajectory Planning for
    # Automatic Machines and Robots, 2008, 3.4. That jerk takes 20 ms to rise makes them longer.
    J, a = 10.0, 1.0
    ramp = speed / a + a / J if speed * J > a ** 2 else 2.0 * np.sqrt(speed / J)
    limits = replace(FREE, max_velocity=[speed] * 3, max_acceleration=[a] * 3, max_jerk=[J] * 3)
    points = np.array([[0.1, 1.4, 0.0], [0.1 + way, 1.4, -0.5 * way]])
    found = plan(JointTask(ARM, limits, points, None, 0.01))
    assert found.duration == pytest.approx(way / speed + ramp, abs=0.06)
