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

"""
Whether motions that start moving keep every limit, from random states of planned motions.

    python benchmarks/soak_moving_starts.py [STATES [SEED]]

States are at random times of motions of several planners, with and without jerk and torque limits.
From each, time_optimal plans through the via points that are left, or through others. Answers must
begin with the state, pass the via points, and keep limits on a grid of 1 ms. Prints failures, and
how the time compares with what was left of the motion; the exit code is 1 if any failed.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
import os
import sys
import time

os.environ.setdefault('OPENBLAS_NUM_THREADS', '1')  # before numpy; one process a core

from moving_answers import broken_limit, other_start  # noqa: E402
import numpy as np  # noqa: E402
from rrr_traj_planner.core.errors import RrrPlannerError  # noqa: E402
from rrr_traj_planner.core.kinematics.forward import forward_kinematics  # noqa: E402
from rrr_traj_planner.planners.plan import Plan  # noqa: E402
from rrr_traj_planner.planners.planning import plan  # noqa: E402
from tasks import full_torque, gentle, NONE, random_task, Task, WEAK  # noqa: E402

STATES_OF_A_MOTION = 4
LIMITS = (gentle(), full_torque(WEAK), replace(gentle(), max_effort=np.array(WEAK)),
          replace(gentle(), max_jerk=NONE))
PLANNERS = 'cycloid', 'gauss', 'septic', 'time_optimal', 'time_optimal'
TIP = 1e-8                            # m
SHORT = 0.3                           # s, left of a motion, below which times are not compared


def moving_tasks(seed: int) -> Iterator[tuple[Task, float | None]]:
    """Give tasks that start moving, and what was left of the motion where that is comparable."""
    rng = np.random.default_rng(seed)
    limits = LIMITS[rng.integers(len(LIMITS))]
    fast = np.isinf(limits.max_acceleration).any()
    planner_id = 'time_optimal' if fast else str(rng.choice(PLANNERS))
    task, other = (random_task(rng, limits, int(rng.integers(2, 6)), f'seed {seed}')
                   for _ in range(2))
    try:
        before = plan(task.model, task.limits, task.asked_of(planner_id))
    except RrrPlannerError:
        return
    T = before.trajectory.duration
    for t in rng.uniform(0.0, T, STATES_OF_A_MOTION):
        q, qd, qdd, _ = (f[0] for f in before.trajectory(np.array([t])))
        own = rng.random() < 0.5
        points = task.request.via_points[before.via_times > t] if own else (
            other.request.via_points)
        request = replace(
            task.asked_of('time_optimal'), via_points=points, start=q, start_velocity=qd,
            start_acceleration=qdd, elbow=None, shoulder=None)
        comparable = own and planner_id == 'time_optimal' and T - t > SHORT
        yield replace(task, request=request), T - t if comparable else None


def fault(task: Task, answer: Plan) -> str:
    """Return what is wrong with an answer, nothing if it is right."""
    tips = forward_kinematics(task.model, answer.trajectory(answer.via_times)[0])
    missed = np.linalg.norm(tips - task.request.via_points, axis=1).max() > TIP
    return other_start(answer, task.request) or ('misses a via point' if missed else broken_limit(
        answer, task.limits, task.model, 2 + int(1e3 * answer.trajectory.duration)))


def main() -> int:
    """Run the soak."""
    states = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    seed = int(sys.argv[2]) if len(sys.argv) > 2 else 0
    counts: Counter[str] = Counter()
    ratios, seconds = [], []
    while counts.total() < states:
        for task, left in moving_tasks(seed):
            began = time.process_time()
            try:
                answer = plan(task.model, task.limits, task.request)
            except RrrPlannerError as error:
                wrong = f'{type(error).__name__}: {error}'
            else:
                seconds.append(time.process_time() - began)
                wrong = fault(task, answer)
                if left is not None:
                    ratios.append(answer.trajectory.duration / left)
            counts['failed' if wrong else 'planned'] += 1
            if wrong:
                print(f'{task.name}: {wrong}', flush=True)
        seed += 1
    print(dict(counts))
    for name, values, unit in (('time over what was left', ratios, ''),
                               ('planning', seconds, ' s of processor time')):
        print(f'{name}: median {np.median(values):.4f}{unit}, '
              f'95 % {np.quantile(values, 0.95):.4f}{unit}, worst {max(values):.4f}{unit}')
    return 1 if counts['failed'] else 0


if __name__ == '__main__':
    sys.exit(main())
