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

"""Whether `time_optimal` ever fails or breaks a limit, on many hard tasks that are feasible."""

from __future__ import annotations

import argparse
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
import os
import time
from typing import NamedTuple

os.environ.setdefault('OPENBLAS_NUM_THREADS', '1')  # before numpy; one process a core

from measuring import setting  # noqa: E402
import numpy as np  # noqa: E402
from rrr_traj_planner.core.dynamics.rigid_body import inverse_dynamics  # noqa: E402
from rrr_traj_planner.core.kinematics.forward import forward_kinematics  # noqa: E402
from rrr_traj_planner.planners.plan import Plan  # noqa: E402
from rrr_traj_planner.planners.planning import plan  # noqa: E402
from soak_tasks import KINDS, soak_task  # noqa: E402
from tasks import Task  # noqa: E402

PER_SAMPLE = 20            # checked points between two samples
LIMIT_TOLERANCE = 1e-6     # relative, the promise of every planner
POSITION_TOLERANCE = 1e-9  # rad
PLACE_TOLERANCE = 1e-8     # m, and s for what rests
KNOT_WIDTH = 1e-9          # s, the distance over which jerk is checked for jumps,
PART_OF_PIECE = 1e-5       # less between short pieces, in which jerk rises steeply
JUMP = 1e-3                # of the largest jerk, that counts as none
PROGRESS = 250             # tasks after which it is said how far it has come
PERCENTILES = (50, 90, 99, 100)


class Result(NamedTuple):
    """What came of one task."""

    seed: int
    points: int
    seconds: float
    duration: float
    note: str
    failure: str
    violations: list[str]


def soak(seed: int, planner_id: str, limit: float) -> Result:
    """Plan the task of a seed, in a limited time [s] as the node does, and check the answer."""
    task = soak_task(seed)
    begin, found, failure = time.perf_counter(), None, ''
    request = replace(task.asked_of(planner_id),
                      should_stop=lambda: time.perf_counter() > begin + limit)
    try:
        found = plan(task.model, task.limits, request)
    except Exception as error:  # noqa: BLE001  whatever it is, it is counted
        failure = f'{type(error).__name__}: {error}'
    seconds = time.perf_counter() - begin
    broken = violations(task, found) if found else []
    return Result(seed, len(request.via_points), seconds, found.trajectory.duration if found
                  else np.nan, found.note if found else '', failure, broken)


def violations(task: Task, found: Plan) -> list[str]:
    """Return what a plan breaks on a dense grid, by nothing but evaluating it there."""
    motion, limits = found.trajectory, task.limits
    n = int(np.ceil(motion.duration * PER_SAMPLE / task.request.sample_period))
    t = np.union1d(np.linspace(0.0, motion.duration, n + 1), motion.knots)
    q, qd, qdd, jerk = motion(t)
    tau = inverse_dynamics(task.model, q, qd, qdd)
    broken = [f'{name}: {np.abs(x).max(axis=0)} over {bound}' for name, x, bound in (
        ('velocity', qd, limits.max_velocity), ('acceleration', qdd, limits.max_acceleration),
        ('jerk', jerk, limits.max_jerk), ('torque', tau, limits.max_effort))
        if (np.abs(x) > bound * (1.0 + LIMIT_TOLERANCE)).any()]
    outside = np.maximum(limits.min_position - q, q - limits.max_position).max()
    if outside > POSITION_TOLERANCE:
        broken.append(f'position: {outside:.3g} rad outside its range')
    missed = np.abs(forward_kinematics(task.model, motion(found.via_times)[0])
                    - task.request.via_points).max()
    if missed > PLACE_TOLERANCE:
        broken.append(f'via point missed by {missed:.3g} m')
    if np.abs([*qd[[0, -1]], *qdd[[0, -1]]]).max() > PLACE_TOLERANCE:
        broken.append('not at rest at an end')
    return broken + _jumps(found, float(np.abs(jerk).max()))


def _jumps(found: Plan, largest: float) -> list[str]:
    """Return the largest jump of jerk at a knot, if there is one."""
    motion = found.trajectory
    pieces = np.diff(motion.knots)
    width = np.minimum(KNOT_WIDTH, PART_OF_PIECE * np.minimum(pieces[:-1], pieces[1:]))
    knots = motion.knots[1:-1]
    before, after = motion(knots - width)[3], motion(knots + width)[3]
    jump = np.abs(after - before).max(initial=0.0)
    return [f'jerk jumps by {jump:.3g} rad/s^3'] if jump > JUMP * largest else []


def report(results: list[Result]) -> str:
    """Return counts, percentiles of planning time by number of via points, and every fault."""
    faulty = [r for r in results if r.failure or r.violations]
    lines = [f'seed {r.seed} ({KINDS[r.seed % len(KINDS)]}, {r.points} points): '
             f'{r.failure or "; ".join(r.violations)}' for r in faulty]
    for label, least, most in (('2 to 8', 2, 8), ('more', 9, 99)):
        seconds = [r.seconds for r in results if least <= r.points <= most]
        if seconds:
            values = ', '.join(f'{p} %: {v:.3f} s' for p, v in zip(
                PERCENTILES, np.percentile(seconds, PERCENTILES)))
            lines.append(f'planning time, {label} via points: {values}')
    noted = [r for r in results if r.note]
    kinds = Counter(KINDS[r.seed % len(KINDS)] for r in noted)
    lines += [f'{len(noted)} with a note: '
              + ', '.join(f'{kind} {count}' for kind, count in kinds.items()),
              f'{len(results)} tasks, {sum(bool(r.failure) for r in results)} failures, '
              f'{sum(bool(r.violations) for r in results)} with violations']
    return '\n'.join(lines)


def main() -> int:
    """Run the tasks of consecutive seeds and print what came of them."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('tasks', type=int, help='how many')
    parser.add_argument('seed', type=int, help='of the first; the others follow')
    parser.add_argument('--jobs', type=int, default=1, help='processes')
    parser.add_argument('--planner', default='time_optimal')
    parser.add_argument('--limit', type=float, default=1.0, help='planning time [s]')
    options = parser.parse_args()
    print(setting(), flush=True)
    seeds = range(options.seed, options.seed + options.tasks)
    with ProcessPoolExecutor(options.jobs) as pool:
        results = []
        for result in pool.map(soak, seeds, [options.planner] * len(seeds),
                               [options.limit] * len(seeds)):
            results.append(result)
            if result.failure or result.violations:
                print(f'seed {result.seed}: {result.failure or result.violations}', flush=True)
            if len(results) % PROGRESS == 0:
                print(f'{len(results)} of {options.tasks}', flush=True)
    print(report(results))
    return int(any(r.failure or r.violations for r in results))


if __name__ == '__main__':
    raise SystemExit(main())
