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

"""How long planning takes, beside TOPP-RA, and how it grows."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator
from dataclasses import replace
import math
from pathlib import Path
import sys

from measuring import in_turns, REPETITIONS, Row, setting, table, timed
import numpy as np
from peers import toppra_duration
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.registry import planner
from rrr_traj_planner.planners.request import PlanningRequest
from tasks import full_torque, gentle, NONE, random_task, Task, WEAK
from tasks import table as thesis_table

sys.path.insert(0, str(Path(__file__).parents[1] / 'test'))
from helpers.public_arms import Arm, arms  # noqa: E402, I100
from helpers.public_arms import task as request_to  # noqa: E402

SEED = 7
OTHER_ARMS = ('go1_leg', 'kr16_2_first3')
GROWTH = 12.0         # by how much longer ten times the via points may take
FEWEST, SEVERAL = 3, 8           # via points
FEW, MORE, MANY = 10, 100, 1000
LONG_PERIOD = 0.05    # s between samples: an answer through 1,000 random points has 60,000
GROWTH_BUDGET = 20.0  # s for one row


def beside_toppra(repetitions: int = REPETITIONS) -> list[Row]:
    """Return our planning times over TOPP-RA's, from joint via points and from the request."""
    return [row for label, task, targets in _small_tasks() for planner_id, target in
            targets.items() for row in _beside(label, task, planner_id, target, repetitions)]


def _beside(label: str, task: Task, planner_id: str, target: float,
            repetitions: int) -> list[Row]:
    given, method = task.joint_task(), planner(planner_id).plan
    medians = in_turns(lambda: method(given), lambda: toppra_duration(given),
                       _planning(task, planner_id), repetitions=repetitions)
    return [timed(f'planning, {label}: {planner_id} / TOPP-RA', target, medians),
            timed(f'planning, {label}: plan() with {planner_id} / TOPP-RA', None, medians,
                  ours=2)]


def growth(repetitions: int = REPETITIONS, budget: float = GROWTH_BUDGET) -> list[Row]:
    """Return the planning times of many via points over those of few."""
    rows = []
    for many, few, label, limits, planner_id in (
            (MANY, MORE, 'v, a, jerk', gentle(), 'cycloid'),
            (MANY, MORE, 'v, a, jerk', gentle(), 'time_optimal'),
            (MORE, FEW, 'v, a, jerk', gentle(), 'cycloid'),
            (MORE, FEW, 'v, a, jerk', gentle(), 'time_optimal'),
            (MORE, FEW, 'v, torque', full_torque(WEAK), 'time_optimal')):
        actions = (_planning(_random(n, limits, LONG_PERIOD), planner_id) for n in (many, few))
        rows.append(timed(
            f'planning, {planner_id}, {label}: {many:,} via points / {few}', GROWTH,
            in_turns(*actions, repetitions=repetitions, budget=budget)))
    return rows


def _small_tasks() -> Iterator[tuple[str, Task, dict[str, float]]]:
    """Give label, task and the targets of planners."""
    for label, limits, targets in (
            ('v, a', gentle(), {'cycloid': 0.1, 'time_optimal': 1.0}),
            ('v, torque', full_torque(WEAK), {'time_optimal': 1.0})):
        for task in (thesis_table('6.1', limits, label), _random(SEVERAL, limits)):
            yield f'{len(task.request.via_points)} via points, {label}', task, targets
    for name in OTHER_ARMS:
        arm, = arms(name)
        for label, limits, targets in (
                ('v, a', replace(arm.limits, max_effort=NONE),
                 {'cycloid': 0.1, 'time_optimal': 1.0}),
                ('v, torque', replace(arm.limits, max_acceleration=NONE), {'time_optimal': 1.0})):
            for points in (FEWEST, SEVERAL):
                yield (f'{points} via points, {label}, {name}',
                       Task(name, limits, PlanningRequest(_tips(arm, points)), arm.model), targets)


def _tips(arm: Arm, number: int) -> np.ndarray:
    """Return the tips of random poses that the arm can hold, away from singular ones."""
    rng = np.random.default_rng(SEED)
    drawn = [request_to(arm, 'cycloid', rng).via_points for _ in range(number)]
    return np.concatenate(drawn)[:number]


def _planning(task: Task, planner_id: str) -> Callable[[], object]:
    request = task.asked_of(planner_id)
    return lambda: plan(task.model, task.limits, request)


def _random(points: int, limits: object, sample_period: float = 0.01) -> Task:
    task = random_task(np.random.default_rng(SEED), limits, points, f'{points} random points')
    return replace(task, request=replace(task.request, sample_period=sample_period))


def main() -> None:
    """Print every ratio."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--repetitions', type=int, default=REPETITIONS)
    parser.add_argument('--budget', type=float, default=math.inf,
                        help='seconds for each row of growth, then fewer repetitions do')
    options = parser.parse_args()
    print(setting())
    print(table(beside_toppra(options.repetitions) + growth(options.repetitions, options.budget)))


if __name__ == '__main__':
    main()
