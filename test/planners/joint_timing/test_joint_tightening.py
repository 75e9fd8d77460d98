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

"""What rounds of tightening return where they are cut short: the best of what was found."""

from dataclasses import replace
from itertools import product

from helpers.spline_cases import all_free, ARM, LIMITS, NONE, random_motion
from rrr_traj_planner.planners.joint_timing.problem import JointProblem
from rrr_traj_planner.planners.joint_timing.start import rest_to_rest
from rrr_traj_planner.planners.joint_timing.tightening import tightened
from rrr_traj_planner.planners.tasks import JointTask

TORQUE = replace(LIMITS, max_acceleration=NONE, max_jerk=[50.0] * 3)  # exceeded between points
SEEDS = range(8)


def test_the_fastest_of_all_motions_that_keep_the_limits_is_returned(monkeypatch):
    costs, several, fitting = [], 0, JointProblem.fitting

    def noted(problem, outcome, motion):
        fits = fitting(problem, outcome, motion)
        costs.append(fits.cost)
        return fits

    monkeypatch.setattr(JointProblem, 'fitting', noted)
    for seed, calls in product(SEEDS, (5, 20, 40)):
        mesh, points, _ = random_motion(seed, n=8)
        left = iter(range(calls))
        task = JointTask(ARM, TORQUE, points, None, 0.01,
                         should_stop=lambda left=left: next(left, None) is None)
        costs.clear()
        best = tightened(JointProblem(task, mesh, all_free(len(points) - 1)), rest_to_rest)
        assert best.cost == min(costs)
        several += len(set(costs)) > 1
    assert several > 1
