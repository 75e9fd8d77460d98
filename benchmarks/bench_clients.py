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
How long a small request waits while others' long ones are planned, and what that costs these.

    python benchmarks/bench_clients.py [--planner ID] [--long N ...] [--points N] [--small N]

N clients ask for plans of many points again and again; another one asks for table 6.1's meanwhile.
"""

from __future__ import annotations

import argparse
from pathlib import Path
import sys
from threading import Event, Thread
from time import perf_counter

from measuring import setting
import numpy as np
from ros_processes import Client, node, plan_request
from rrr_traj_planner.planners.registry import planner_ids
from soak_deadlines import SHAPES
from tasks import TIPS

LONG = 0, 1, 2, 5, 10


class LongOnes:
    """Clients that ask for long plans until they are told to stop."""

    def __init__(self, server, count: int, points: int, planner_id: str) -> None:
        self.took, self.refused = [], 0
        self._ended = Event()
        self._request = plan_request(figure(points), planner_id=planner_id)
        self._threads = [Thread(target=self._run, args=(server,)) for _ in range(count)]

    def __enter__(self) -> LongOnes:
        for thread in self._threads:
            thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._ended.set()
        for thread in self._threads:
            thread.join()

    def _run(self, server) -> None:
        with Client() as client:
            ask = client.service(server, 'plan_trajectory')
            while not self._ended.is_set():
                started = perf_counter()
                try:
                    ask(self._request)
                except RuntimeError:  # refused
                    self.refused += 1
                self.took.append(perf_counter() - started)


def figure(points: int):
    """Return a Lissajous figure that the thesis's joint_1 can reach."""
    return SHAPES['lissajous'](points) + np.array([0.0, 0.35, 0.0])


def main() -> None:
    """Print latencies."""
    parser = argparse.ArgumentParser(description=__doc__.strip().partition('\n')[0])
    parser.add_argument('--planner', choices=sorted(planner_ids()), default='time_optimal')
    parser.add_argument('--long', nargs='+', type=int, default=LONG)
    parser.add_argument('--points', type=int, default=1000)
    parser.add_argument('--small', type=int, default=40)
    options = parser.parse_args()
    print(setting())
    small = plan_request(TIPS['6.1'])
    with node('planner') as server, Client() as client:
        ask = client.service(server, 'plan_trajectory')
        ask(small)
        for count in options.long:
            with LongOnes(server, count, options.points, options.planner) as long_ones:
                pause = Event()
                beyond = []
                while len(beyond) < options.small or count and not long_ones.took:
                    pause.wait(0.1)
                    started = perf_counter()
                    response = ask(small)
                    beyond.append(perf_counter() - started - response.planning_time)
            mean = f'{np.mean(long_ones.took):.2f} s' if long_ones.took else '-'
            print(f'{count} long: small ones beyond their planning time, median, worst: '
                  f'{np.median(beyond):.3f}, {max(beyond):.3f} s; long ones take {mean}, '
                  f'{len(long_ones.took)} answered, {long_ones.refused} of them refused',
                  flush=True)


if __name__ == '__main__':
    sys.path.insert(0, str(Path(__file__).parent))
    main()
