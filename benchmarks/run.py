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

"""Run the quick form of every benchmark, print one table and write build/bench.json."""

from __future__ import annotations

import argparse
import json
import os
from pathlib import Path

os.environ.setdefault('OPENBLAS_NUM_THREADS', '1')  # before numpy: for ours and theirs alike

import bench_motion_time  # noqa: E402
import bench_paths  # noqa: E402
import bench_planning_time  # noqa: E402
from measuring import Row, setting, table  # noqa: E402

QUICK_TASKS = 14
QUICK_PATHS = 4
RESULT = Path(__file__).parents[1] / 'build' / 'bench.json'


def rows(tasks: int) -> list[Row]:
    """Return every row, in the order of the table."""
    return [*bench_planning_time.beside_toppra(), *bench_planning_time.growth(),
            *bench_motion_time.tables(), *bench_motion_time.random(tasks),
            *bench_motion_time.peers(), *bench_paths.tables(), *bench_paths.random(QUICK_PATHS)]


def main() -> None:
    """Print and write the rows."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--tasks', type=int, default=QUICK_TASKS,
                        help='random tasks of each kind whose motion time is compared')
    options = parser.parse_args()
    print(setting(), flush=True)
    found = rows(options.tasks)
    print(table(found))
    RESULT.parent.mkdir(exist_ok=True)
    RESULT.write_text(json.dumps([row._asdict() for row in found], indent=1) + '\n')
    print(f'{sum(row.met for row in found)} of {len(found)} targets met; '
          f'written to {RESULT.relative_to(RESULT.parents[1])}')


if __name__ == '__main__':
    main()
