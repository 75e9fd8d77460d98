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
Whether every pose of random chains is among the inverse solutions for its tip.

    python benchmarks/soak_inverse.py [POSES [SEED]]

The arms are the thesis's and the public descriptions of test/data/arms. The chains are skew ones,
ones whose joint axes 1 and 2 meet or all but meet, and ones whose joint axes 2 and 3 are parallel.
Each of POSES random joint states must come back to 1e-9 rad, or, next to a singularity, to what
rounding of the tip's position allows, and every solution's tip must be the point, within 1e-9 m.
For each chain it prints the poses lost, those too singular to be compared, the worst differences
and the time of a point. The exit code is 1 if one was lost.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
import sys
import time
from typing import Any

import numpy as np
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arm.urdf_arm import read_urdf
from rrr_traj_planner.core.kinematics.forward import forward_kinematics, jacobian
from rrr_traj_planner.core.kinematics.solutions import all_solutions
from rrr_traj_planner.core.rounding import TIP_ROUNDING

sys.path.insert(0, str(Path(__file__).parents[1] / 'test'))
from helpers.public_arms import DESCRIPTIONS  # noqa: E402, I100
from helpers.random_chains import random_arm, with_axes  # noqa: E402

SINGULAR = 1e-6    # least singular value of the Jacobian, in sizes, of poses that are compared
SAME = 1e-9        # rad
ROUNDING = 1e-14   # of the tip's position, in sizes
CHAINS = 4         # of each kind


def chains(seed: int) -> Iterator[tuple[str, Any]]:
    """Return arms by what they are."""
    yield 'thesis', RobotModel()
    for path in sorted(DESCRIPTIONS.glob('*.urdf')):
        if path.stem != 'planar_arm':  # which is refused
            yield path.stem, RobotModel(read_urdf(path).chain)
    for k in range(seed, seed + CHAINS):
        arm = random_arm(k)
        yield f'skew {k}', arm
        yield f'meeting {k}', with_axes(arm, 0.0)
        for distance in (1e-9, 1e-6, 1e-4, 1e-3, 1e-2):
            yield f'axes at {distance} m {k}', with_axes(arm, distance)
        yield f'parallel {k}', with_axes(arm, parallel=True)
        yield f'meeting and parallel {k}', with_axes(arm, 0.0, parallel=True)


def lost_poses(name: str, arm: Any, q: np.ndarray) -> int:
    """Return how many poses are lost, and print what was found."""
    points, size = forward_kinematics(arm, q), arm.chain.size
    singular = np.linalg.svd(jacobian(arm, q), compute_uv=False)[:, -1] / size
    started = time.perf_counter()
    found, count = all_solutions(arm, points)
    microseconds = 1e6 * (time.perf_counter() - started) / len(q)
    apart = np.abs(np.remainder(found - q[:, np.newaxis] + np.pi, 2.0 * np.pi) - np.pi)
    nearest = np.where(np.isnan(apart), np.inf, apart).max(axis=2).min(axis=1)
    present = np.arange(4) < count[:, np.newaxis]
    tips = forward_kinematics(arm, found[present])
    misses = np.linalg.norm(tips - np.repeat(points, count, axis=0), axis=1)
    regular = singular > SINGULAR
    lost = regular & (nearest > np.maximum(SAME, ROUNDING / singular))
    compared = nearest[regular & ~lost]
    print(f'{name:24} lost {np.count_nonzero(lost)}, singular {np.count_nonzero(~regular)}, '
          f'worst {compared.max(initial=0.0):.1e} rad, {misses.max(initial=0.0):.1e} m, '
          f'{microseconds:.1f} us', flush=True)
    for k in np.flatnonzero(lost):
        print(f'    {q[k].tolist()}: {nearest[k]:.1e} rad, singular value {singular[k]:.1e}')
    return np.count_nonzero(lost) + np.count_nonzero(misses > TIP_ROUNDING)


def main() -> int:
    """Run the soak."""
    poses = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    seed = int(sys.argv[2]) if len(sys.argv) > 2 else 0
    failures = sum(
        lost_poses(name, arm, np.random.default_rng(seed).uniform(-np.pi, np.pi, (poses, 3)))
        for name, arm in chains(seed))
    print(f'{failures} failures')
    return 1 if failures else 0


if __name__ == '__main__':
    raise SystemExit(main())
