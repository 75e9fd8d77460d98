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
How planning takes hostile requests: no bug, sound answers, the same answer to the same request.

    python benchmarks/soak_hostile.py [REQUESTS [SEED]]

The requests are those of the tests (`test/helpers/hostile_requests.py`), from message to message.
Failures are printed and counted; the exit code is 1 if there were any.
"""

from __future__ import annotations

from collections import Counter
from pathlib import Path
import sys
from time import perf_counter
import traceback
import warnings

from hypothesis import given, HealthCheck, Phase, seed, settings
import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / 'test'))
from helpers import hostile_requests as hostile  # noqa: E402, I100

NAMES = {getattr(hostile.CODES, name): name for name in dir(hostile.CODES)
         if name.isupper() and isinstance(getattr(hostile.CODES, name), int)}
SHOWN = 20  # failures are printed in full up to so many
EVERY = 4   # one request in so many is planned twice


class Soak:
    """What the requests have come to."""

    def __init__(self) -> None:
        self.codes: Counter[str] = Counter()
        self.failures: list[str] = []
        self.warnings: Counter[str] = Counter()
        self.seconds: list[float] = []
        self.slowest = ''

    def try_one(self, request) -> None:
        """Plan a request, now and then twice, and judge the answers."""
        with warnings.catch_warnings(record=True) as seen:
            warnings.simplefilter('always')
            started = perf_counter()
            try:
                response = hostile.answered(request)
                self._note_time(perf_counter() - started, request)
                self.codes[NAMES[response.error_code]] += 1
                hostile.assert_sound(request, response)
                if self.codes.total() % EVERY == 0:
                    assert hostile.answered(request) == response, 'same request, another answer'
            except Exception as error:
                self.codes[f'bug: {type(error).__name__}'] += 1
                self.failures.append(f'{traceback.format_exc()}\n{request}')
                if len(self.failures) <= SHOWN:
                    print(self.failures[-1], flush=True)
        self.warnings.update(f'{Path(w.filename).name}:{w.lineno} {w.message}' for w in seen)

    def _note_time(self, seconds: float, request) -> None:
        if not self.seconds or seconds > max(self.seconds):
            self.slowest = str(request)
        self.seconds.append(seconds)

    def report(self) -> str:
        """Return the figures."""
        times = np.percentile(self.seconds, (50, 90, 99, 100))
        return '\n'.join((
            f'{self.codes.total()} requests, {len(self.failures)} failures',
            *(f'  {count:6d} {code}' for code, count in self.codes.most_common()),
            'planning time, percentiles 50, 90, 99, 100 [s]: '
            + ', '.join(f'{t:.4f}' for t in times),
            f'numerical warnings: {self.warnings.total()}',
            *(f'  {count:6d} {text}' for text, count in self.warnings.most_common(10)),
            f'slowest: {self.slowest[:2000]}'))


def main() -> int:
    """Run the soak."""
    requests = int(sys.argv[1]) if len(sys.argv) > 1 else 10_000
    number = int(sys.argv[2]) if len(sys.argv) > 2 else 0
    soak = Soak()

    @seed(number)
    @settings(max_examples=requests, database=None, deadline=None, phases=[Phase.generate],
              suppress_health_check=list(HealthCheck))
    @given(hostile.hostile_requests())
    def run(request) -> None:
        soak.try_one(request)
        if soak.codes.total() % 500 == 0:
            print(f'{soak.codes.total()} requests, {len(soak.failures)} failures', flush=True)

    try:
        run()
    except KeyboardInterrupt:
        print('interrupted')
    print(soak.report())
    return 1 if soak.failures else 0


if __name__ == '__main__':
    raise SystemExit(main())
