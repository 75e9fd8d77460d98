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
import os
from pathlib import Path
import shutil
import subprocess
import sys
import tempfile
import time

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = 'rrr_traj_planner'
INSTALLED = 'installed'  # a folder of the copy: the tests refuse to import from the sources' own
LEFT_OUT = '.git', '.venv', 'build', 'install', 'log', '*.so'
TESTS = 'test/core', 'test/planners'
WIDTH = 68       # characters of a fault in the table
LONGEST = 900.0  # s: a fault may make a loop endless

# The folder of tests nearest to some code; lines of that code, each in one file alone, and what
# takes their place.
FAULTS = {
    'test/core/dynamics': (
        ('potential -= chain.mass[i]', 'potential += chain.mass[i]'),
        ('moves = np.arange(3) <= i', 'moves = np.arange(3) < i'),
        ('inertia = R @ chain.inertia[i] @ np.swapaxes(R, -1, -2)',
         'inertia = R @ chain.inertia[i]'),
        ('torque[1] -= 0.5 * dot(qd, p2), torque[2]', 'torque[1] -= dot(qd, p2), torque[2]'),
        ('g->first[2] += a[0] * b[0] * c[1];', 'g->first[2] -= a[0] * b[0] * c[1];'),
    ),
    'test/core/kinematics': (
        ('rate[3 * c + i] += x[second_by[i][j]][c] * qd[j];',
         'rate[3 * c + i] += x[second_by[i][j]][c];'),
        ('to[SECOND] = volume(b[0], c[1], c[2])', 'to[SECOND] = volume(a[0], c[1], c[2])'),
        ('right[c] = path->dddp[n][c] - 3.0 * h[c];', 'right[c] = path->dddp[n][c] - h[c];'),
        ('rests[..., np.newaxis] == np.arange(RESTS)',
         'rests[..., np.newaxis] >= np.arange(RESTS)'),
    ),
    'test/core/arm': (
        ('reduced = chain.mass[2] * mass / both', 'reduced = mass'),
    ),
    'test/core/motion_laws': (
        ('self.velocity + T * (self.c * s - self.b / w * sine)',
         'self.velocity + T * (self.c * s + self.b / w * sine)'),
        ('peak_acceleration=15.0 / 8.0', 'peak_acceleration=15.0 / 9.0'),
        ('mean = np.abs(self.change) / self.duration',
         'mean = np.abs(self.change) * self.duration'),
    ),
    'test/core/simulation': (
        ('slope ** 2 - 4.0 * half * self.acceleration',
         'slope ** 2 + 4.0 * half * self.acceleration'),
        ('torque = spring * fmax(1.0 + damping * rate, 0.0);',
         'torque = spring * fmax(1.0 - damping * rate, 0.0);'),
        ('elements[element[i][j]] = i == j;', 'elements[element[i][j]] = 1.0;'),
        ('self._velocity_gain = (1.0 - pole) ** 2 / step',
         'self._velocity_gain = (1.0 - pole) / step'),
    ),
    'test/core/path': (
        ('radius = (x * x + y * y) / (2.0 * y)', 'radius = (x * x + y * y) / y'),
        ('inward = 0.5 * (direction[..., 1:, :] - direction[..., :-1, :])',
         'inward = 1.0 * (direction[..., 1:, :] - direction[..., :-1, :])'),
    ),
    'test/core/trajectory': (
        ('np.flatnonzero(~(value <= limit * (1.0 + TOLERANCE)))',
         'np.flatnonzero(~(value <= limit * (2.0 + TOLERANCE)))'),
        ('vertex = -0.2 * c[4] / c[5]', 'vertex = -0.4 * c[4] / c[5]'),
    ),
    'test/planners/transitions': (
        ('q1 = points[:-1] + 0.5 * (v0 + parts.cruise) * parts.first',
         'q1 = points[:-1] + 0.5 * (v0 - parts.cruise) * parts.first'),
        ('return cruise * T - 0.5 * (u0 * least_time(law, u0)',
         'return cruise * T - 1.0 * (u0 * least_time(law, u0)'),
        ('by_cruise = capped ? 0.0 : T - a.m * a.t - b.m * b.t;',
         'by_cruise = capped ? 0.0 : T - a.m * a.t + b.m * b.t;'),
        ('return fmin(fmax(v0, v1) + rise(law', 'return fmin(fmin(v0, v1) + rise(law'),
    ),
    'test/planners/solver': (
        # rounds of tightening
        ('growth ** max(round_ - schedule.patience, 0)',
         'growth ** max(round_ + schedule.patience, 0)'),
        # torques and their derivatives
        ('x[i] += product[i] + gravity[i] +', 'x[i] += product[i] - gravity[i] +'),
        ('+ product[j][i] - product[i][j];', '+ product[j][i] + product[i][j];'),
        ('by_w[l][j] + by_w[j][l] - w[1]', 'by_w[l][j] + by_w[j][l] + w[1]'),
        # constraints
        ('to[2 * i + 1] = value[i] - lower[i];', 'to[2 * i + 1] = value[i] + lower[i];'),
        ('p->least_T ? m.T[k] - p->least_T[k] : 1.0;\n        duration_slack[0]',
         'p->least_T ? m.T[k] : 1.0;\n        duration_slack[0]'),
        ('- (barrier + dual[2 * c + 1] * shift[2 * c + 1])',
         '+ (barrier + dual[2 * c + 1] * shift[2 * c + 1])'),
        ('return 2.0 * p->N * (constraints_of(p)', 'return 1.0 * p->N * (constraints_of(p)'),
        ('v + (w).hv * a + (w).vj * j + (w).vu * u,', 'v + (w).hv * a + (w).vj * j - (w).vu * u,'),
        # Newton steps
        ('*common_gradient += p->proportions[k] * right[B];', '*common_gradient += right[B];'),
        ('decrease = -(r_T + p->weights[k]) * dT;', 'decrease = -r_T * dT;'),
        ('decrease -= sums[c];', 'decrease += sums[c];'),
        ('own[s] -= column[i] * own[i * sides + s];',
         'own[s] += column[i] * own[i * sides + s];'),
        # trials, multipliers, shifts
        ('if (!all_retain(p->slack, s->slack, slacks_size(p), retained)) {',
         'if (!all_retain(p->slack, s->slack, slacks_size(p), -retained)) {'),
        ('sum = p->weights[k] * m.T[k];', 'sum = m.T[k];'),
        ('moved[i] = (barrier - dual[i] * rate[i])', 'moved[i] = (barrier + dual[i] * rate[i])'),
        ('in enumerate(sides):', 'in enumerate(sides[::-1]):'),
        # steps of segments
        ('l->flipped[k] ^= 1;', 'l->flipped[k] |= 1;'),
        ('if (!(p->shift[i] > 0.0))\n            continue;\n        p->shift[i] *= 1.0 - 1.0',
         'if (!(p->shift[i] > 0.0))\n            continue;\n        p->shift[i] *= 1.0 - 0.0'),
        # the interior-point method and its line search
        ('return float(self._cost - self._barrier * self._log)',
         'return float(self._cost + self._barrier * self._log)'),
        ('complementarity < relative_gap * self._cost', 'complementarity > relative_gap'),
        ('+ self._count * self._barrier)', ')'),
        ('(shifted_before or self._cost < self._best_cost)',
         '(self._cost < self._best_cost)'),
        ('self._centres,\n                       not self._problem.shifted)',
         'self._centres,\n                       True)'),
        ('found.cost - barrier * found.log\n', 'found.cost + barrier * found.log\n'),
        # the barrier method
        ('const double up = change - (v1 - v0), down = change + (v1 - v0);',
         'const double up = change - (v1 - v0), down = change - (v1 - v0);'),
        ('largest_displacement(&law, -v0, -v1, T[k]) + D;',
         'largest_displacement(&law, -v0, -v1, T[k]) - D;'),
        ('bound[i][0] = high - low;', 'bound[i][0] = high + low;'),
        ('*first = p->gradient[i][1] + p->gradient[i + JOINTS][0] + p->bound[i][0];',
         '*first = p->gradient[i][1] + p->gradient[i + JOINTS][0];'),
        ('g += first * in[k];', 'g += first;'),
        ('sum += v[i][e] * fmax(fabs(a[e][e]), LEAST', 'sum += v[i][e] * fmax(a[e][e], LEAST'),
        ('if change <= -SUFFICIENT_DECREASE * squared:',
         'if change <= SUFFICIENT_DECREASE * squared:'),
        ('squared < decrement or squared < rounding', 'squared > decrement or squared < rounding'),
        ('barrier.durations, count / weight)', 'barrier.durations, 1.0 / weight)'),
        ('return float(self.weights @ T)', 'return float(T.sum())'),
    ),
    'test/planners/joint_timing': (
        ('self._margins = before.widened(problem.task, problem.mesh, self._slow, self._check)',
         'self._margins = before'),
        ('fits.cost < best.cost)', 'fits.cost > best.cost)'),
    ),
    'test/planners/methods': (
        ('scale = np.minimum(limits.max_acceleration, by_torque)',
         'scale = np.maximum(limits.max_acceleration, by_torque)'),
    ),
    'test/planners/path_timing': (
        ('ratio = constant / task.limits.max_effort',
         'ratio = constant / task.limits.max_velocity'),
        ('constraints.margins + check.excess)', 'constraints.margins - self._check.excess)'),
        ('T, motion, _ = min(self._rounds.found', 'T, motion, _ = max(self._rounds.found'),
        ('time_scaled(outcome.motion, factor), T - outcome.gap',
         'time_scaled(outcome.motion, factor), T + outcome.gap'),
    ),
}


def run(folder: Path, *command: str) -> subprocess.CompletedProcess[str]:
    """Run a Python command in a copy of the repository, with the package from there."""
    path = os.pathsep.join((str(folder / INSTALLED), os.environ.get('PYTHONPATH', '')))
    return subprocess.run([sys.executable, *command], cwd=folder, text=True, capture_output=True,
                          check=False, timeout=LONGEST, env={**os.environ, 'PYTHONPATH': path})


def build(folder: Path) -> None:
    """Compile the kernels beside their sources."""
    done = run(folder, 'setup.py', '-q', 'build_ext', '--inplace')
    if done.returncode:
        raise SystemExit(done.stderr)


def copied(folder: Path) -> Path:
    """Return the package, in a copy of the repository: links to it are installed, and built."""
    shutil.copytree(ROOT, folder, ignore=shutil.ignore_patterns(*LEFT_OUT))
    package = folder / PACKAGE
    (folder / INSTALLED).mkdir()
    (folder / INSTALLED / PACKAGE).symlink_to(package)
    build(folder)
    found = run(folder / INSTALLED, '-c', f'import {PACKAGE}; print({PACKAGE}.__file__)').stdout
    assert Path(found.strip()).resolve().parent == package, found
    return package


def first_failure(folder: Path, tests: list[str]) -> str:
    """Return the first test that fails, or an empty text."""
    try:
        done = run(folder, '-m', 'pytest', '-x', '-q', '-p', 'no:cacheprovider', *tests)
    except subprocess.TimeoutExpired:
        return f'no end within {LONGEST:.0f} s'
    failed = [line for line in done.stdout.splitlines() if line.startswith(('FAILED', 'ERROR'))]
    if done.returncode < 0:
        return f'ended by signal {-done.returncode}'
    if done.returncode and not failed:
        raise SystemExit(done.stdout + done.stderr)
    return failed[0].split(' - ')[0].split()[1] if failed else ''


def caught(folder: Path, file: Path, fault: tuple[str, str], near: str, others: list[str]) -> str:
    """Return the first test that fails with a fault in a file, or an empty text."""
    source = file.read_text()
    compiled = file.suffix != '.py'
    file.write_text(source.replace(*fault))
    if compiled:
        build(folder)
    found = (first_failure(folder, [near, *others])
             or first_failure(folder, [*TESTS, *others]))
    file.write_text(source)
    if compiled:
        build(folder)
    return found


def main() -> int:
    """Put in one fault after another; exit with 1 if the tests miss one."""
    parser = argparse.ArgumentParser(
        description=__doc__, epilog='Other arguments are for pytest: -n 2')
    parser.add_argument('--first', type=int, default=0)
    parser.add_argument('--last', type=int)
    options, others = parser.parse_known_args()
    faults = list(enumerate((near, *fault) for near, group in FAULTS.items() for fault in group))
    faults = faults[options.first:options.last]
    missed = 0
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch, ROOT.name).resolve()
        package = copied(folder)
        files = [file for kind in ('*.py', '*.[ch]', '*.inc') for file in package.rglob(kind)]
        for near in dict.fromkeys(near for _, (near, *_) in faults):
            if failure := first_failure(folder, [near, *others]):
                raise SystemExit(f'without a fault: {failure}')
        for number, (near, right, wrong) in faults:
            began = time.perf_counter()
            file, = (f for f in files if right in f.read_text())
            test = caught(folder, file, (right, wrong), near, others)
            missed += not test
            print(f'{number:2} {time.perf_counter() - began:4.0f} s  {file.name:22} '
                  f'{" ".join(wrong.split()):{WIDTH}.{WIDTH}}  {test or "MISSED"}', flush=True)
    print(f'{missed} of {len(faults)} missed')
    return int(missed > 0)


if __name__ == '__main__':
    raise SystemExit(main())
