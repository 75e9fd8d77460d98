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

"""How long planning takes, beside TOPP-RA, and how it grows with the via points."""

from __future__ import annotations

import argparse

from measuring import compared, REPETITIONS, Row, setting, side_by_side, table
import numpy as np
from peers import toppra_duration
from rrr_traj_planner.planners.planning import plan
from tasks import full_torque, gentle, random_task, Task, WEAK
from tasks import table as thesis_table

SEED = 7
FEW, MANY, GROWTH = 10, 100, 12.0  # via points, and by how much longer the many may take
GROWTH_REPETITIONS = 3


def beside_toppra(repetitions: int = REPETITIONS) -> list[Row]:
    """Return our planning times, from request to checked answer, over TOPP-RA's."""
    rows = []
    for label, limits, planners in (
            ('v, a', gentle(), {'cycloid': 0.1, 'time_optimal': 1.0}),
            ('v, torque', full_torque(WEAK), {'time_optimal': 1.0})):
        for task in (thesis_table('6.1', limits, label), _random(8, limits)):
            given = task.joint_task()
            for planner_id, target in planners.items():
                ours, theirs = side_by_side(_planning(task, planner_id),
                                            lambda given=given: toppra_duration(given),
                                            repetitions)
                rows.append(compared(
                    f'planning, {len(given.points)} via points, {label}: '
                    f'{planner_id} / TOPP-RA', target, 1e3 * ours, 1e3 * theirs, 'ms'))
    return rows


def growth(repetitions: int = GROWTH_REPETITIONS) -> list[Row]:
    """Return the planning times of many via points over those of few."""
    rows = []
    for label, limits, planner_ids in (('v, a, jerk', gentle(), ('cycloid', 'time_optimal')),
                                       ('torque', full_torque(WEAK), ('time_optimal',))):
        many, few = (_random(n, limits) for n in (MANY, FEW))
        for planner_id in planner_ids:
            long, short = side_by_side(_planning(many, planner_id), _planning(few, planner_id),
                                       repetitions)
            rows.append(compared(f'planning, {planner_id}, {label}: {MANY} via points / {FEW}',
                                 GROWTH, 1e3 * long, 1e3 * short, 'ms'))
    return rows


def _planning(task: Task, planner_id: str):
    request = task.asked_of(planner_id)
    return lambda: plan(task.model, task.limits, request)


def _random(points: int, limits: object) -> Task:
    return random_task(np.random.default_rng(SEED), limits, points, f'{points} random points')


def main() -> None:
    """Print every ratio."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--repetitions', type=int, default=REPETITIONS)
    options = parser.parse_args()
    print(setting())
    print(table(beside_toppra(options.repetitions) + growth()))


if __name__ == '__main__':
    main()
