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

"""How long the planner's service takes beyond planning, beside an echo of the same answer."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from pathlib import Path
import sys
import time

from measuring import in_turns, REPETITIONS, Row, seconds, setting, table, timed
from ros_processes import Client, MISSING, plan_request, Process
from rrr_traj_planner.core.trajectory.sampling import sample
from rrr_traj_planner.core.trajectory.trajectory import Trajectory
from rrr_traj_planner.planners.planning import plan
from tasks import gentle, TIPS, WEAK
from tasks import table as thesis_table

POINTS = 500
TARGET = 1.2
REST = 0.1  # s, for what a server does after an answer: it must not count as the next one's
SERVER = Path(__file__).with_name('plan_and_echo.py')


def rows(repetitions: int = REPETITIONS) -> list[Row]:
    """Return round trips of 500 points over the echo's, less the planning and with it."""
    if MISSING:
        print(MISSING, flush=True)
        return []
    task = thesis_table('6.1', gentle(WEAK), '')
    period = _period(plan(task.model, task.limits, task.request).trajectory, POINTS)
    request = plan_request(TIPS['6.1'], sample_period=period)
    with Client() as client, Process(
            sys.executable, SERVER, period, '--ros-args', '--log-level', 'error') as server:
        ask, echo = (client.service(server, name) for name in ('plan_trajectory', 'echo'))
        for call in (ask, echo):
            found = len(call(request).trajectory.points)
            if found != POINTS:
                raise RuntimeError(f'{found} points, not {POINTS}')
        planning: list[float] = []

        def trip() -> float:
            taken = seconds(lambda: planning.append(ask(request).planning_time))
            return taken - planning[-1]

        medians = in_turns(trip, lambda: seconds(lambda: echo(request)),
                           lambda: trip() + planning[-1], repetitions=repetitions,
                           measure=_rested)
    name = f'service round trip, {POINTS} points'
    return [timed(f'{name}, less planning / echo of the same message', TARGET, medians),
            timed(f'{name}, with planning / echo of the same message', None, medians, ours=2)]


def _rested(trip: Callable[[], float]) -> float:
    """Return a trip's time, begun when both processes are idle [s]."""
    time.sleep(REST)
    return trip()


def _period(trajectory: Trajectory, points: int) -> float:
    """Return the sample period for which an answer has so many points [s]."""
    for intervals in range(points, points // 2, -1):
        period = trajectory.duration / intervals
        if len(sample(trajectory, period).times) == points:
            return period
    raise LookupError(f'no period gives {points} points')


def main() -> None:
    """Print every ratio."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--repetitions', type=int, default=REPETITIONS)
    found = rows(parser.parse_args().repetitions)
    print(setting())
    print(table(found))


if __name__ == '__main__':
    main()
