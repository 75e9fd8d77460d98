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
How far answers come after planning_time_limit: every planner, shapes of paths, 3 to 1,000 points.

    python benchmarks/soak_deadlines.py [--planners ID ...] [--shapes NAME ...] [--points N ...]
                                        [--limits SECONDS ...] [--processor]

Each request is answered in a process of its own, from message to message as the planner node does
it, and given up GIVE_UP seconds after its limit, with a trace of where it was. The exit code is 1
if an answer came more than ALLOWED seconds after its limit. With --processor all times are of the
processor, for machines that other programs take.
"""

from __future__ import annotations

import argparse
from collections import defaultdict
import faulthandler
import os
from pathlib import Path
import sys
from time import perf_counter, process_time

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / 'test'))
from helpers.plan_requests import plan_request  # noqa: E402, I100
from rrr_traj_planner.nodes.parameters.configuration import PlannerConfig  # noqa: E402
from rrr_traj_planner.nodes.parameters.table import PLANNER, rows_of  # noqa: E402
from rrr_traj_planner.nodes.planner_node import scheduler  # noqa: E402
from rrr_traj_planner.nodes.planner_node.node import _answer  # noqa: E402
from rrr_traj_planner.planners.registry import planner_ids  # noqa: E402
from rrr_traj_planner_interfaces.srv import PlanTrajectory  # noqa: E402

ALLOWED = 0.5  # s
GIVE_UP, PATIENCE = 20.0, 5.0  # s, and how much slower a busy machine may be
POINTS = 3, 10, 30, 100, 300, 1000
LIMITS = 0.2, 1.0, 5.0
CENTRE = np.array([0.6, 0.0, 1.0])
WIDEST = np.array([0.1, 0.15, 0.1])
CODES = {getattr(PlanTrajectory.Response, name): name for name in dir(PlanTrajectory.Response)
         if name.isupper() and isinstance(getattr(PlanTrajectory.Response, name), int)}


def circle(n: int):
    """Return points on a horizontal circle of radius 0.1 m."""
    t = np.linspace(0.0, 2.0 * np.pi, n, endpoint=False)
    return CENTRE + 0.1 * np.stack((np.cos(t), np.sin(t), 0.0 * t), axis=1)


def upright_circle(n: int):
    """Return points on an upright circle of radius 0.1 m."""
    return CENTRE + (circle(n) - CENTRE)[:, [0, 2, 1]]


def lissajous(n: int):
    """Return points of a Lissajous figure in space."""
    t = np.linspace(0.0, 2.0 * np.pi, n, endpoint=False)
    return CENTRE + WIDEST * np.sin(np.stack((3.0 * t, 2.0 * t, 5.0 * t + 0.3), axis=1))


def zigzag(n: int):
    """Return points to the left and right in turn."""
    k = np.arange(n)
    return CENTRE + WIDEST * np.stack(
        (2.0 * k / n - 1.0, (-1.0) ** k, np.sin(0.7 * k)), axis=1)


def random_walk(n: int):
    """Return points some 3 cm apart, each in another direction."""
    steps = 0.03 * np.random.default_rng(n).standard_normal((n, 3))
    way = np.cumsum(steps, axis=0) / WIDEST
    return CENTRE + WIDEST * (np.abs((way + 1.0) % 4.0 - 2.0) - 1.0)


def scattered(n: int):
    """Return points anywhere in a box."""
    return CENTRE + WIDEST * np.random.default_rng(n).uniform(-1.0, 1.0, (n, 3))


def line(n: int):
    """Return points on a straight line of 0.36 m."""
    return CENTRE + WIDEST * np.linspace(-1.0, 1.0, n)[:, np.newaxis]


def millimetres(n: int):
    """Return points 1 mm apart on a helix of radius 5 cm."""
    t = 0.02 * np.arange(n)
    return CENTRE + np.stack((0.05 * np.cos(t), 0.05 * np.sin(t), 1e-4 * np.arange(n)), axis=1)


SHAPES = {f.__name__: f for f in (
    circle, upright_circle, lissajous, zigzag, random_walk, scattered, line, millimetres)}


def config(limit: float) -> PlannerConfig:
    """Return the thesis's arm, whose joint_1 may turn to both sides."""
    values = {name: row.default for name, row in rows_of(
        PLANNER, ('joint_1', 'joint_2', 'joint_3')).items()}
    return PlannerConfig.from_values({
        **values, 'joint_limits.joint_1.min_position': -0.5 * np.pi,
        'planning_time_limit': limit})


def ask(planner: str, shape: str, n: int, limit: float, clock) -> tuple[float, str]:
    """Return when a request was answered, after its limit, and what it came to."""
    read, write = os.pipe()
    pid = os.fork()
    if not pid:
        faulthandler.dump_traceback_later(PATIENCE * (limit + GIVE_UP), exit=True)
        scheduler.perf_counter = clock
        request = plan_request(SHAPES[shape](n), planner_id=planner)
        started, cpu = clock(), process_time()
        with scheduler.Scheduler().job() as job:
            response = _answer(request, config(limit), None, lambda: False, job).response
        seconds, cpu = clock() - started, process_time() - cpu
        end = response.via_times[-1] if response.via_times else 0.0
        os.write(write, f'{seconds} {CODES[response.error_code]}, {cpu:.2f} s of processor, '
                        f'motion {end:.3f} s; {response.message[:300]}'.encode())
        os._exit(0)
    os.close(write)
    with os.fdopen(read) as pipe:
        said = pipe.read()
    os.waitpid(pid, 0)
    seconds, _, text = said.partition(' ') if said else (np.inf, '', 'given up')
    return float(seconds) - limit, text


def main() -> int:
    """Run the matrix."""
    parser = argparse.ArgumentParser(description=__doc__.strip().partition('\n')[0])
    parser.add_argument('--planners', nargs='+', default=sorted(planner_ids()))
    parser.add_argument('--shapes', nargs='+', default=SHAPES, choices=SHAPES)
    parser.add_argument('--points', nargs='+', type=int, default=POINTS)
    parser.add_argument('--limits', nargs='+', type=float, default=LIMITS)
    parser.add_argument('--processor', action='store_true')
    options = parser.parse_args()
    clock = process_time if options.processor else perf_counter
    late = defaultdict(list)
    for planner in options.planners:
        for shape in options.shapes:
            for n in options.points:
                for limit in options.limits:
                    after, text = ask(planner, shape, n, limit, clock)
                    late[planner].append(after)
                    mark = 'LATE ' if after > ALLOWED else ''
                    print(f'{planner:18} {shape:14} {n:5d} limit {limit:g} s: answered after '
                          f'{after + limit:.2f} s {mark}{text}', flush=True)
    for planner, seconds in late.items():
        print(f'{planner:18} {len(seconds)} requests, {sum(s > ALLOWED for s in seconds)} late, '
              f'latest {max(seconds):+.2f} s after its limit')
    return int(any(s > ALLOWED for seconds in late.values() for s in seconds))


if __name__ == '__main__':
    raise SystemExit(main())
