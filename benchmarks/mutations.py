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

"""Whether the tests catch small faults in core and planners: a sign, a factor, a missing term."""

from __future__ import annotations

import argparse
from pathlib import Path
import subprocess
import sys
import time

import rrr_traj_planner

# Lines of the package, each in one file alone, and what takes their place.
FAULTS = (
    ('base_inertia=I1[1] + I2[0] + I3[2],', 'base_inertia=I1[1] + I2[0] - I3[2],'),
    ('shoulder_inertia=I2[2] + I3[1] + m2', 'shoulder_inertia=I2[2] + m2'),
    ('upper_weight=(m2 * l2 + m3 * a2) * g,', 'upper_weight=(m2 * l2 + m3 * l2) * g,'),
    ('s2 * c3 + c2 * s3, c2 * c3 - s2 * s3', 's2 * c3 + c2 * s3, c2 * c3 + s2 * s3'),
    ('model.d4 * np.cos(q23), model.d4 * np.sin(q23)',
     'model.d4 * np.cos(q23), -model.d4 * np.sin(q23)'),
    ('r, h = hypot(x, y), z - model.d1', 'r, h = hypot(x, y), z + model.d1'),
    ('l3 = (m3 * model.l3 + mass * model.d4) / (m3 + mass)',
     'l3 = (m3 * model.l3 + mass * model.l3) / (m3 + mass)'),
    ('self.velocity + T * (self.c * s - self.b / w * sine)',
     'self.velocity + T * (self.c * s + self.b / w * sine)'),
    ('peak_acceleration=15.0 / 8.0', 'peak_acceleration=15.0 / 9.0'),
    ('mean = np.abs(self.change) / self.duration', 'mean = np.abs(self.change) * self.duration'),
    ('self.peak_jerk = 1.0 / (constant_jerk_fraction + 4.0 * self._rise / pi)',
     'self.peak_jerk = 1.0 / (constant_jerk_fraction + 2.0 * self._rise / pi)'),
    ('slope ** 2 - 4.0 * half * self.acceleration', 'slope ** 2 + 4.0 * half * self.acceleration'),
    ('radius = (x * x + y * y) / (2.0 * y)', 'radius = (x * x + y * y) / y'),
    ('inward = 0.5 * (direction[..., 1:, :] - direction[..., :-1, :])',
     'inward = 1.0 * (direction[..., 1:, :] - direction[..., :-1, :])'),
    ('torque = spring * max(1.0 + self.damping * rate, 0.0)',
     'torque = spring * max(1.0 - self.damping * rate, 0.0)'),
    ('self._velocity_gain = (1.0 - pole) ** 2 / step',
     'self._velocity_gain = (1.0 - pole) / step'),
    ('q1 = points[:-1] + 0.5 * (v0 + parts.cruise) * parts.first',
     'q1 = points[:-1] + 0.5 * (v0 - parts.cruise) * parts.first'),
    ('np.minimum(limits.max_acceleration, (torque / inertia).max(axis=0))',
     'np.maximum(limits.max_acceleration, (torque / inertia).max(axis=0))'),
    ('ratio = np.abs(table.values.g) / task.limits.max_effort',
     'ratio = np.abs(table.values.g) / task.limits.max_velocity'),
    ('np.flatnonzero(~(value <= limit * (1.0 + TOLERANCE)))',
     'np.flatnonzero(~(value <= limit * (2.0 + TOLERANCE)))'),
    ('vertex = -0.2 * c[4] / c[5]', 'vertex = -0.4 * c[4] / c[5]'),
)


def caught(file: Path, right: str, wrong: str, tests: list[str]) -> str:
    """Return the first test that fails with a fault in the installed package, or an empty text."""
    source = file.read_text()
    try:
        file.write_text(source.replace(right, wrong))
        done = subprocess.run(
            [sys.executable, '-m', 'pytest', '-x', '-q', '-p', 'no:cacheprovider', *tests],
            text=True, capture_output=True, check=False)
    finally:
        file.write_text(source)
    failed = [line for line in done.stdout.splitlines() if line.startswith(('FAILED', 'ERROR'))]
    return failed[0].split(' - ')[0] if failed else ''


def main() -> int:
    """Put in one fault after another; exit with 1 if a test misses one."""
    parser = argparse.ArgumentParser(
        description=__doc__, epilog='Other arguments are for pytest: test/core test/planners -n 2')
    parser.add_argument('--first', type=int, default=0)
    parser.add_argument('--last', type=int, default=len(FAULTS))
    options, tests = parser.parse_known_args()
    missed = 0
    files = sorted(Path(rrr_traj_planner.__file__).parent.rglob('*.py'))
    for number, (right, wrong) in list(enumerate(FAULTS))[options.first:options.last]:
        file, = (f for f in files if right in f.read_text())
        began = time.perf_counter()
        test = caught(file, right, wrong, tests)
        missed += not test
        print(f'{number:2} {file.stem}: {wrong}\n   {test or "MISSED"}, '
              f'{time.perf_counter() - began:.0f} s', flush=True)
    print(f'{missed} missed')
    return int(missed > 0)


if __name__ == '__main__':
    raise SystemExit(main())
