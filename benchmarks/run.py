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

"""Run the quick form of every benchmark: one table, build/bench.json and build/bench.png."""

from __future__ import annotations

import argparse
from collections.abc import Callable
import json
import os
from pathlib import Path
import sys
import time
import traceback

os.environ.setdefault('OPENBLAS_NUM_THREADS', '1')  # before numpy: for ours and theirs alike

import bench_arm  # noqa: E402
import bench_dynamics  # noqa: E402
import bench_messages  # noqa: E402
import bench_motion_time  # noqa: E402
import bench_paths  # noqa: E402
import bench_planning_time  # noqa: E402
import bench_processes  # noqa: E402
import bench_service  # noqa: E402
import bench_studio  # noqa: E402
from measuring import Row, setting, table  # noqa: E402
from ratio_plot import draw  # noqa: E402

QUICK_TASKS = 14
QUICK_PATHS = 4
BUILD = Path(__file__).parents[1] / 'build'
RESULT, PICTURE = BUILD / 'bench.json', BUILD / 'bench.png'


def groups(tasks: int) -> dict[str, Callable[[], list[Row]]]:
    """Return what is measured, in the order of the table."""
    return {
        'planning beside TOPP-RA': bench_planning_time.beside_toppra,
        'motions beside the limit': lambda: [
            *bench_motion_time.tables(), *bench_motion_time.random(tasks)],
        'motions beside TOPP-RA and Ruckig': bench_motion_time.peers,
        'paths': lambda: [*bench_paths.tables(), *bench_paths.random(QUICK_PATHS)],
        'dynamics': bench_dynamics.rows,
        'simulated arm': bench_arm.rows,
        'messages': bench_messages.rows,
        'service': bench_service.rows,
        'processes': bench_processes.rows,
        'studio': bench_studio.rows,
        'growth with the via points': bench_planning_time.growth}


def measured_rows(tasks: int) -> tuple[list[Row], list[str]]:
    """Return the rows, and the groups without any because something is broken."""
    found: list[Row] = []
    failed = []
    for name, measured in groups(tasks).items():
        began = time.monotonic()
        try:
            found += measured()
        except Exception:  # ten minutes of other rows are not to be lost
            traceback.print_exc()
            failed.append(name)
        print(f'{name}: {time.monotonic() - began:.0f} s', file=sys.stderr, flush=True)
    return found, failed


def main() -> int:
    """Print, write and draw the rows."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--tasks', type=int, default=QUICK_TASKS,
                        help='random tasks of each kind whose motion time is compared')
    options = parser.parse_args()
    print(setting(), flush=True)
    found, failed = measured_rows(options.tasks)
    print(table(found))
    BUILD.mkdir(exist_ok=True)
    RESULT.write_text(json.dumps([row.as_json() for row in found], indent=1,
                                 allow_nan=False) + '\n')
    rated = [row for row in found if row.target is not None]
    draw(rated, setting(), PICTURE)
    print(f'{sum(bool(row.met) for row in rated)} of {len(rated)} targets met, {len(found)} rows; '
          f'written to {RESULT.relative_to(BUILD.parent)} and {PICTURE.relative_to(BUILD.parent)}')
    if failed:
        print(f'FAILED, without rows: {", ".join(failed)}')
    return int(bool(failed))


if __name__ == '__main__':
    raise SystemExit(main())
