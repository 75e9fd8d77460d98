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

"""What every benchmark needs: machine and versions, times taken in turns, rows and their table."""

from __future__ import annotations

from collections.abc import Callable
from importlib import metadata
import math
import os
from pathlib import Path
import platform
import time
from typing import Any, NamedTuple

import numpy as np

PACKAGES = ('numpy', 'scipy', 'toppra', 'casadi', 'ruckig', 'pin')
REPETITIONS = 21
LEAST_REPETITIONS = 3  # where a time is given for all of them


class Row(NamedTuple):
    """A ratio of what is ours to what is theirs, and its target, at most, if it has one."""

    row: str
    ratio: float
    target: float | None  # None: for information
    ours: float
    theirs: float
    unit: str
    count: int = 1        # measurements of each, of which these are the medians

    @property
    def met(self) -> bool | None:
        """Whether the ratio is within its target; None where there is none."""
        return None if self.target is None else self.ratio <= self.target

    def as_json(self) -> dict[str, Any]:
        """Return what bench.json holds of it; None stands for what is not finite."""
        fields = self._asdict()
        del fields['count']
        return {name: None if isinstance(value, float) and not math.isfinite(value) else value
                for name, value in fields.items()}


class Medians(NamedTuple):
    """Median times of actions [s], and of how many each."""

    times: tuple[float, ...]
    count: int


def setting() -> str:
    """Return machine, versions and what the linear algebra may use, in a line each."""
    versions = ', '.join(f'{name} {_version(name)}' for name in PACKAGES)
    threads = os.environ.get('OPENBLAS_NUM_THREADS', 'any number')
    return (f'{_processor()}, {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}\n'
            f'Python {platform.python_version()}, {versions}\nOPENBLAS_NUM_THREADS {threads}')


def _version(package: str) -> str:
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return 'missing'


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


def in_turns(*actions: Callable[[], object], repetitions: int = REPETITIONS,
             budget: float = math.inf, measure: Callable[..., float] = seconds) -> Medians:
    """
    Return the medians of actions that take turns, after a round that does not count.

    Parameters
    ----------
    *actions : callable
        What is measured.
    repetitions : int
        How often.
    budget : float
        Time [s] after which LEAST_REPETITIONS do; where the round that does not count has taken
        all of it, that one is the measurement.
    measure : callable
        Returns an action's figure; by default the time that it takes [s].

    Returns
    -------
    Medians
        One for each action.

    """
    begin = time.perf_counter()
    first, rounds = [measure(action) for action in actions], []
    if time.perf_counter() - begin > budget:
        rounds = [first]
    else:
        while len(rounds) < min(LEAST_REPETITIONS, repetitions) or (
                len(rounds) < repetitions and time.perf_counter() - begin < budget):
            rounds.append([measure(action) for action in actions])
    return Medians(tuple(np.median(rounds, axis=0).tolist()), len(rounds))


def compared(name: str, target: float | None, ours: float, theirs: float, unit: str = 's',
             count: int = 1) -> Row:
    """Return the row of a comparison."""
    return Row(name, ours / theirs, target, ours, theirs, unit, count)


def timed(name: str, target: float | None, medians: Medians, ours: int = 0,
          theirs: int = 1) -> Row:
    """Return the row of two of the actions that took turns, in the unit that suits the times."""
    times = medians.times[ours], medians.times[theirs]
    scale, unit = next((s, u) for s, u in ((1e6, 'us'), (1e3, 'ms'), (1.0, 's'))
                       if s * max(times) < 1e3 or u == 's')
    return compared(name, target, scale * times[0], scale * times[1], unit, medians.count)


def table(rows: list[Row]) -> str:
    """Return rows as text, in columns."""
    width = max((len(r.row) for r in rows), default=0)
    head = f'{"":{width}}  {"ours":>10} {"theirs":>10}       {"n":>4} {"ratio":>8} {"target":>8}'
    return '\n'.join([head, *(_line(r, width) for r in rows)])


def _line(r: Row, width: int) -> str:
    target = '-' if r.target is None else f'{r.target:.4g}'
    verdict = {None: '', True: 'met', False: 'MISSED'}[r.met]
    return (f'{r.row:{width}}  {r.ours:10.4g} {r.theirs:10.4g} {r.unit:5} {r.count:4} '
            f'{r.ratio:8.4g} {target:>8}  {verdict}').rstrip()
