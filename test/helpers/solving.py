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

"""Random joint-space timing problems, solved."""

from helpers.spline_cases import all_free, slow_start
from rrr_traj_planner.planners.solver.interior_point import CentralPathPoint, minimise


def never():
    return False


def solve(limits, mesh, points, should_stop=never, durations=None):
    constraints, m = slow_start(limits, mesh, points)
    problem, seen = constraints.problem, []

    def stop():  # at every iterate
        seen.append(problem.motion(problem.arrays['variables'].copy()))
        return should_stop()

    outcome = minimise(problem, CentralPathPoint(m, None), durations or all_free(len(m.T)), stop)
    return problem, m, seen, outcome
