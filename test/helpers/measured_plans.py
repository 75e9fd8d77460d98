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

"""Plans of random feasible tasks by every joint-space planner, planned once and sampled."""

from functools import cache

from helpers.random_tasks import KINDS, Measured, random_task
import numpy as np
from rrr_traj_planner.core.errors import LimitViolationError
from rrr_traj_planner.planners.planning import plan

EXACT = ['cycloid', 'cycloid_approach_a', 'cycloid_approach_c', 'gauss', 'septic', 'poly_434']
MISSING = ['cycloid_approach_b', 'poly_414']  # these miss via points, by construction

# Approach (a) passes via points at cruise velocity, so it cannot plan tasks at the end of a range.
SEEDS = {'cycloid': range(212),
         'cycloid_approach_a': [s for s in range(252) if KINDS[s % len(KINDS)] != 'at a limit']}
SOME_SEEDS = range(40)  # of the others


@cache
def outcomes(planner_id):
    """Return the sampled plans, and the refusals with their tasks."""
    planned, refused = {}, {}
    for seed in SEEDS.get(planner_id, SOME_SEEDS):
        task = random_task(seed)
        try:
            planned[seed] = Measured(
                task, plan(task.model, task.limits, task.asked_of(planner_id)))
        except LimitViolationError as error:
            refused[seed] = (task, error)
    return planned, refused


def broken(motions, excess):
    """Return the seeds of motions for which a measure is positive, with the measure."""
    found = {seed: float(np.max(excess(m))) for seed, m in motions.items()}
    return {seed: value for seed, value in found.items() if not value <= 0.0}


def via_points(m):
    """Return the joint positions at the via points of a request, shape (n, 3) [rad]."""
    return m.task.q[len(m.task.q) - len(m.plan.via_times):]
