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
Whether any planner fails or breaks a promise on any arm: public descriptions and random chains.

Torque, friction included, and the tip are judged by Pinocchio. Prints for each arm and planner how
many tasks were planned, and of how many; the others were refused for a reason.
"""

from __future__ import annotations

import argparse
from collections import Counter, defaultdict
import os
from pathlib import Path
import sys
import time

os.environ.setdefault('OPENBLAS_NUM_THREADS', '1')  # before numpy; one process a core

from measuring import setting  # noqa: E402
import numpy as np  # noqa: E402
from rrr_traj_planner.core.errors import ConvergenceError, RrrPlannerError  # noqa: E402
from rrr_traj_planner.planners.planning import plan  # noqa: E402
from rrr_traj_planner.planners.registry import planner_ids  # noqa: E402
from rrr_traj_planner.planners.request import PlanningRequest  # noqa: E402

sys.path.insert(0, str(Path(__file__).parents[1] / 'test'))
from helpers.public_arms import Arm, arms, task, violations  # noqa: E402, I100


def outcome(arm: Arm, request: PlanningRequest) -> tuple[str, str]:
    """Plan a request: what came of it, in a word and in full."""
    try:
        found = plan(arm.model, arm.limits, request)
    except ConvergenceError as error:
        return 'FAULT', f'{type(error).__name__}: {error}'
    except RrrPlannerError as error:
        return type(error).__name__, str(error)
    except Exception as error:  # noqa: BLE001  whatever it is, it is counted
        return 'FAULT', f'{type(error).__name__}: {error}'
    broken = violations(arm, request, found)
    return ('VIOLATION', '; '.join(broken)) if broken else ('planned', found.note)


def main() -> int:
    """Run tasks of every arm and planner in turn, and print what came of them."""
    parser = argparse.ArgumentParser(description=__doc__.strip().splitlines()[0])
    parser.add_argument('tasks', type=int, help='how many for each arm and planner')
    parser.add_argument('seed', type=int, help='of the first; the others follow')
    parser.add_argument('--planner', choices=planner_ids(), help='one alone; else all')
    parser.add_argument('--arm', default='', help='part of the names of arms; else all')
    parser.add_argument('--refusals', action='store_true', help='print their texts')
    options = parser.parse_args()
    ids = [options.planner] if options.planner else planner_ids()
    print(setting(), flush=True)
    totals: Counter[str] = Counter()
    print(f'{"arm":18} ' + ' '.join(f'{x[-10:]:>10}' for x in ids), flush=True)
    for arm in arms(options.arm):
        planned, begin = defaultdict(int), time.perf_counter()
        for k, planner_id in enumerate(ids):
            for i in range(options.tasks):
                seed = (options.seed + i, k)
                request = task(arm, planner_id, np.random.default_rng(seed))
                word, text = outcome(arm, request)
                totals[word] += 1
                planned[planner_id] += word == 'planned'
                if word in ('FAULT', 'VIOLATION') or (options.refusals and word != 'planned'):
                    print(f'{arm.name}, {planner_id}, {seed}: {word} {text}', flush=True)
        row = ' '.join(f'{f"{planned[x]}/{options.tasks}":>10}' for x in ids)
        print(f'{arm.name:18} {row}  {time.perf_counter() - begin:.0f} s', flush=True)
    print(dict(totals))
    return int(totals['FAULT'] + totals['VIOLATION'] > 0)


if __name__ == '__main__':
    sys.exit(main())
