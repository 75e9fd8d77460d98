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

"""What every benchmark needs: machine and versions, ratios of times, rows and their table."""

from __future__ import annotations

from collections.abc import Callable
from importlib import metadata
import os
from pathlib import Path
import platform
import time
from typing import NamedTuple

import numpy as np

PACKAGES = ('numpy', 'scipy', 'toppra', 'casadi', 'ruckig')
REPETITIONS = 21


class Row(NamedTuple):
    """A ratio of what is ours to what is theirs, and what it must not exceed."""

    row: str
    ratio: float
    target: float
    ours: float
    theirs: float
    unit: str

    @property
    def met(self) -> bool:
        """Whether the ratio is within its target."""
        return self.ratio <= self.target


def setting() -> str:
    """Return machine, versions and what the linear algebra may use, in a line each."""
    versions = ', '.join(f'{name} {metadata.version(name)}' for name in PACKAGES)
    threads = os.environ.get('OPENBLAS_NUM_THREADS', 'any number')
    return (f'{_processor()}, {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}\n'
            f'Python {platform.python_version()}, {versions}\nOPENBLAS_NUM_THREADS {threads}')


def _processor() -> str:
    info = Path('/proc/cpuinfo')
    if info.exists():
        for line in info.read_text().splitlines():
            if line.startswith('model name'):
                return line.split(':', 1)[1].strip()
    return platform.processor() or platform.machine()


def seconds(action: Callable[[], object]) -> float:
    """Return how long an action takes [s]."""
    begin = time.perf_counter()
    action()
    return time.perf_counter() - begin


def side_by_side(ours: Callable[[], object], theirs: Callable[[], object],
                 repetitions: int = REPETITIONS) -> tuple[float, float]:
    """Return the median times of two actions, taken in turns after one that does not count [s]."""
    times = np.array([(seconds(ours), seconds(theirs)) for _ in range(repetitions + 1)])
    ours_median, theirs_median = np.median(times[1:], axis=0)
    return float(ours_median), float(theirs_median)


def compared(name: str, target: float, ours: float, theirs: float, unit: str = 's') -> Row:
    """Return the row of a comparison."""
    return Row(name, ours / theirs, target, ours, theirs, unit)


def table(rows: list[Row]) -> str:
    """Return rows as text, in columns."""
    width = max(len(r.row) for r in rows)
    head = f'{"":{width}}  {"ours":>10} {"theirs":>10}       {"ratio":>8} {"target":>8}'
    lines = [f'{r.row:{width}}  {r.ours:10.4g} {r.theirs:10.4g} {r.unit:5} {r.ratio:8.4g} '
             f'{r.target:8.4g}  {"met" if r.met else "MISSED"}' for r in rows]
    return '\n'.join([head, *lines])
