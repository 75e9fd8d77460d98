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

"""How near the motions of `time_optimal` are to the physical limit, and to other planners."""

from __future__ import annotations

import argparse
from dataclasses import replace

from limit import limit_of
from measuring import compared, Row, setting, table
import numpy as np
from peers import ruckig_duration, toppra_duration
from rrr_traj_planner.core.errors import RrrPlannerError
from rrr_traj_planner.planners.joint_timing.moving_start import limits_of_moving_start
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.tasks import JointTask, StartRates
from tasks import full_torque, gentle, random_task, random_tasks, Task, thesis_tasks, WEAK

SEED = 20
TASKS = 56
PEER_TASKS = 49
MOST_SECONDS = (2.22, 2.67, 1.10, 1.60, 0.935)  # on the thesis's tables
MEDIAN, WORST = 'median', 'worst'
TARGETS = {  # of random tasks: limits, target of the median, of the worst
    'v, a, jerk 10': (gentle(), 1.0065, 1.0125),
    'v, jerk 100, torque': (full_torque(WEAK), 1.013, 1.022),
}


def tables() -> list[Row]:
    """Return our times over the limits, and the targets."""
    rows = []
    for (task, _), most in zip(thesis_tasks(), MOST_SECONDS):
        ours, best = _times(task)
        rows.append(compared(f'{task.name}: time_optimal / limit', most / best, ours, best))
    return rows


def random(count: int = TASKS, seed: int = SEED, say: bool = False) -> list[Row]:
    """Return the median and the worst ratio to the limit over random tasks."""
    rows = []
    for label, (limits, median, worst) in TARGETS.items():
        times = []
        for task in random_tasks(seed, count, limits):
            times.append(_times(task))
            if say:
                ours, best = times[-1]
                print(f'{label}, {task.name}: {len(task.request.via_points)} points, '
                      f'{ours:.4f} s, limit {best:.4f} s, {ours / best:.4f}', flush=True)
        times.sort(key=lambda t: t[0] / t[1])
        for name, target, (ours, best) in ((MEDIAN, median, times[len(times) // 2]),
                                           (WORST, worst, times[-1])):
            rows.append(compared(f'{count} random tasks, {label}: time_optimal / limit, {name}',
                                 target, ours, best, count=len(times)))
    return rows


def peers(count: int = PEER_TASKS, seed: int = SEED) -> list[Row]:
    """Return our times over those of TOPP-RA's and Ruckig's motions, without torque."""
    tasks = random_tasks(seed, count, gentle())
    pairs = [task for task in tasks if len(task.request.via_points) == 2]
    more = [task for task in tasks if len(task.request.via_points) > 2]
    rows = []
    for name, chosen, theirs, target in (('TOPP-RA', more, toppra_duration, 1.05),
                                         ('Ruckig, 2 via points', pairs, ruckig_duration, 1.04)):
        times = sorted(((_own(task), theirs(task.joint_task())) for task in chosen),
                       key=lambda t: t[0] / t[1])
        rows.append(compared(f'{len(chosen)} random tasks, v, a, jerk 10: time_optimal / {name}, '
                             f'{MEDIAN}', target, *times[len(times) // 2], count=len(times)))
    times = sorted((_moving(seed, k) for k in range(count)), key=lambda t: t[0] / t[1])
    for name, target, (ours, theirs) in ((MEDIAN, 1.01, times[len(times) // 2]),
                                         (WORST, 1.03, times[-1])):
        rows.append(compared(f'{count} random moving starts, jerk 10: time_optimal / Ruckig, '
                             f'{name}', target, ours, theirs, count=count))
    return rows


def _moving(seed: int, k: int) -> tuple[float, float]:
    """Return our time and Ruckig's from a random state of a planned motion to a target."""
    rng = np.random.default_rng((seed, k))
    task, other = (random_task(rng, gentle(), 2, f'{seed}/{k}') for _ in range(2))
    before = plan(task.model, task.limits, task.asked_of('time_optimal')).trajectory
    q, *rates, _ = (f[0] for f in before(rng.uniform(0.0, before.duration, 1)))
    request = replace(
        other.asked_of('time_optimal'), via_points=other.request.via_points[:1], start=q,
        start_velocity=rates[0], start_acceleration=rates[1], elbow=None, shoulder=None)
    answer = plan(task.model, task.limits, request)
    limits = limits_of_moving_start(task.model, task.limits, q, StartRates(*rates))
    target = answer.points.positions[-1]
    return answer.trajectory.duration, ruckig_duration(JointTask(
        task.model, limits, np.stack((q, target)), None, request.sample_period,
        start_rates=StartRates(*rates)))


def _own(task: Task) -> float:
    return plan(task.model, task.limits, task.asked_of('time_optimal')).trajectory.duration


def _times(task: Task) -> tuple[float, float]:
    """Return our time, infinite where we fail, and the limit; NaN where the solver finds none."""
    try:
        own = plan(task.model, task.limits, task.asked_of('time_optimal')).trajectory
    except RrrPlannerError as error:
        print(f'{task.name}: {error}', flush=True)
        own = None
    found = limit_of(task, own)
    return (own.duration if own else np.inf), (found.duration if found.solved else np.nan)


def main() -> None:
    """Print every ratio."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--tasks', type=int, default=TASKS, help='random tasks of each kind')
    parser.add_argument('--seed', type=int, default=SEED)
    options = parser.parse_args()
    print(setting())
    print(table(tables() + random(options.tasks, options.seed, say=True) + peers()))


if __name__ == '__main__':
    main()
