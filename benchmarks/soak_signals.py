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
Whether SIGINT and SIGTERM end every script in order, whenever they come.

    python benchmarks/soak_signals.py [N [SEED]] [--jobs 2] [--load] [--seconds 4] [--scripts ...]

N interrupts at random moments of the first SECONDS of the scripts: SIGINT and SIGTERM in turn, to
the script alone and to its whole process group as Ctrl-C in a terminal does it, all scripts as
often. Each must end within LATEST with exit code 0, or by the signal itself where Python had not
begun, without a word about an exception, and leave no process behind. `--load` keeps all
processors busy meanwhile. Printed are the faults with their seeds (`soak_signals.py 1 THAT_SEED`
repeats one) and a table; the exit code is 1 if there was a fault.
"""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
import os
from pathlib import Path
import random
import shutil
import signal
import subprocess
import sys
from tempfile import TemporaryDirectory
import time
from typing import NamedTuple

os.environ.setdefault('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')

SCRIPTS = {'planner': (), 'simulated_arm': (), 'bringup': (), 'demo': (),
           'report': ('--thesis', 'page')}
LATEST = 3.0    # s
GIVEN_UP = 20.0  # s
WORDS = ('Traceback', 'Exception', 'Error', 'terminate', 'dumped', 'Aborted', 'Segmentation')


class Trial(NamedTuple):
    """One interrupt."""

    seed: int
    script: str
    number: signal.Signals
    group: bool
    moment: float  # s

    def __str__(self) -> str:
        to = 'its group' if self.group else 'it'
        return (f'seed {self.seed}: {self.script}, {self.number.name} to {to} '
                f'at {self.moment:.3f} s')


class Outcome(NamedTuple):
    """What has come of it."""

    trial: Trial
    faults: tuple[str, ...]
    how: str
    seconds: float  # from the signal to the end


def trial(seed: int, scripts: list[str], seconds: float) -> Trial:
    """Return the interrupt that a seed stands for."""
    number = (signal.SIGINT, signal.SIGTERM)[seed // len(scripts) % 2]
    return Trial(seed, scripts[seed % len(scripts)], number, bool(seed // 2 // len(scripts) % 2),
                 random.Random(seed).uniform(0.0, seconds))


def run(case: Trial, domain: int) -> Outcome:
    """Interrupt a script, and return what comes of it."""
    command = [shutil.which(case.script), *SCRIPTS[case.script]]
    with TemporaryDirectory() as folder, (Path(folder) / 'said').open('w+') as said:
        process = subprocess.Popen(
            command, cwd=folder, stdin=subprocess.DEVNULL, stdout=said, stderr=said,
            start_new_session=True, env={**os.environ, 'ROS_DOMAIN_ID': str(domain)})
        time.sleep(case.moment)
        before = process.poll()
        sent = time.monotonic()
        if before is None:
            (os.killpg if case.group else os.kill)(process.pid, case.number)
        try:
            code = process.wait(GIVEN_UP)
        except subprocess.TimeoutExpired:
            code = None
        seconds = time.monotonic() - sent
        left = wait_for_rest(process.pid, sent + LATEST)
        if left:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
        said.seek(0)
        words = said.read()
    return Outcome(case, tuple(faults(case, before, code, seconds, left, words)),
                   how(case, before, code), seconds)


def how(case: Trial, before: int | None, code: int | None) -> str:
    """Return how the script has ended, for the table."""
    if before is not None:
        return 'ended before'
    return 'by the signal' if code == -case.number else f'exit code {code}'


def faults(case: Trial, before: int | None, code: int | None, seconds: float, left: list[str],
           words: str) -> Iterator[str]:
    """Yield what is wrong."""
    if before is not None and before != 0:
        yield f'ended before the signal with exit code {before}'
    elif code not in (0, -case.number) or code == -case.number and words:
        yield f'exit code {code}'
    if seconds > LATEST:
        yield f'ended after {seconds:.2f} s'
    if left:
        yield f'left behind: {", ".join(left)}'
    if any(word in words for word in WORDS):
        yield 'said:\n    ' + words.replace('\n', '\n    ').rstrip()


def wait_for_rest(session: int, deadline: float) -> list[str]:
    """Return the command lines of what still runs of a session at a deadline."""
    while (found := running(session)) and time.monotonic() < deadline:
        time.sleep(0.02)
    return found


def running(session: int) -> list[str]:
    """Return the command lines of a session's processes."""
    found = []
    for folder in Path('/proc').glob('[0-9]*'):
        try:
            fields = (folder / 'stat').read_text().rpartition(')')[2].split()
            if int(fields[3]) == session and fields[0] != 'Z':
                found.append((folder / 'cmdline').read_text().replace('\0', ' ').strip())
        except (FileNotFoundError, ProcessLookupError):
            pass
    return found


@contextmanager
def busy_processors(wanted: bool) -> Iterator[None]:
    """Keep all processors busy."""
    hogs = [subprocess.Popen([sys.executable, '-c', 'while True: pass'])
            for _ in range(wanted and os.cpu_count())]
    try:
        yield
    finally:
        for hog in hogs:
            hog.kill()
            hog.wait()


def table(outcomes: list[Outcome]) -> str:
    """Return how often what has come, by script."""
    lines = [f'{"":14} {"n":>5} {"faults":>6} {"slowest":>8}  ended']
    for script in dict.fromkeys(o.trial.script for o in outcomes):
        own = [o for o in outcomes if o.trial.script == script]
        ways = ', '.join(f'{w} {n}' for w, n in sorted(Counter(o.how for o in own).items()))
        lines.append(f'{script:14} {len(own):5} {sum(bool(o.faults) for o in own):6} '
                     f'{max(o.seconds for o in own):6.2f} s  {ways}')
    return '\n'.join(lines)


def main() -> int:
    """Run the soak."""
    parser = argparse.ArgumentParser()
    parser.add_argument('count', type=int, nargs='?', default=1000)
    parser.add_argument('seed', type=int, nargs='?', default=0)
    parser.add_argument('--scripts', nargs='+', choices=SCRIPTS, default=list(SCRIPTS))
    parser.add_argument('--jobs', type=int, default=2)
    parser.add_argument('--load', action='store_true')
    parser.add_argument('--seconds', type=float, default=4.0)
    options = parser.parse_args()
    signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's `&` ignores it, and on
    base = 1 + os.getpid() % (100 - options.jobs)
    free = list(range(base, base + options.jobs))  # domains: one for each job
    outcomes: list[Outcome] = []

    def work(seed: int) -> None:
        domain = free.pop()
        outcome = run(trial(seed, options.scripts, options.seconds), domain)
        free.append(domain)
        outcomes.append(outcome)
        for fault in outcome.faults:
            print(f'{outcome.trial}: {fault}', flush=True)

    with busy_processors(options.load), ThreadPoolExecutor(options.jobs) as pool:
        list(pool.map(work, range(options.seed, options.seed + options.count)))
    print(table(outcomes))
    return 1 if any(o.faults for o in outcomes) else 0


if __name__ == '__main__':
    raise SystemExit(main())
