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
Whether motions begin where the arm is: random starts, every planner, ranges of up to two turns.

    python benchmarks/soak_starts.py [REQUESTS [SEED]]

Starts are in any of the four postures, at ends of ranges and on joint axis 1; via points are near
them, anywhere, on joint axis 1 and within 1e-13 to 1e-6 m of it. Every answer must begin with the
start state, meet the last via point and keep the joints' ranges. Failures are printed; the exit
code is 1 if there were any.
"""

from __future__ import annotations

from collections import Counter
import sys

import numpy as np
from rrr_traj_planner.core.arm.lengths import ArmLengths
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.errors import ConvergenceError, RrrPlannerError
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.registry import planner_ids
from rrr_traj_planner.planners.request import PlanningRequest

ARM, PI = RobotModel(), np.pi
RANGES = (([-PI, 0.0, -PI], [PI, PI, 2.0 * PI]), ([-PI] * 3, [PI] * 3),
          ([-1.5 * PI, 0.0, -PI], [1.5 * PI, PI, 2.0 * PI]), ([-2.0 * PI] * 3, [2.0 * PI] * 3),
          ([0.0, 0.0, -PI], [0.5 * PI, PI, 2.0 * PI]), ([-PI, -0.5, -1.0], [2.0 * PI, 4.0, 4.0]))
FIRST_POINT, LAST_POINT, RANGE = 1e-9, 1e-8, 1e-9  # rad, m, rad


def random_request(rng: np.random.Generator) -> tuple[JointLimits, PlanningRequest]:
    """Return limits and a request with a start state."""
    low, high = (np.array(x) for x in RANGES[rng.integers(len(RANGES))])
    start = rng.uniform(low, high)
    if rng.random() < 0.2:
        joint = rng.integers(3)
        start[joint] = (low, high)[rng.integers(2)][joint]
    if rng.random() < 0.1:  # the tip on joint axis 1
        sine = -ArmLengths().a2 * np.cos(start[1]) / ArmLengths().d4
        start[2] = np.clip(np.arcsin(np.clip(sine, -1.0, 1.0)) - start[1], low[2], high[2])
    effort = np.full(3, np.inf) if rng.random() < 0.7 else JointLimits().max_effort
    request = PlanningRequest(
        random_points(rng, start, low, high), start=start,
        planner_id=str(rng.choice(planner_ids())), elbow=(None, None, 'up', 'down')[
            rng.integers(4)])
    return JointLimits(low, high, max_effort=effort), request


def random_points(rng: np.random.Generator, start: np.ndarray, low: np.ndarray,
                  high: np.ndarray) -> np.ndarray:
    """Return one to three via points."""
    n = rng.integers(1, 4)
    kind = rng.random()
    if kind < 0.3:
        tip = forward_kinematics(ARM, start)
        return tip + rng.normal(size=(n, 3)) * 10.0 ** rng.uniform(-3.0, -1.0)
    if kind < 0.6:
        return forward_kinematics(ARM, start + np.cumsum(0.2 * rng.normal(size=(n, 3)), axis=0))
    points = forward_kinematics(ARM, rng.uniform(low, high, (n, 3)))
    if kind < 0.8:
        turn = rng.uniform(-PI, PI)
        off = 10.0 ** rng.uniform(-13.0, -6.0) * rng.integers(2)
        points[rng.integers(n)] = off * np.cos(turn), off * np.sin(turn), rng.uniform(1.2, 1.8)
    return points


def fault(limits: JointLimits, request: PlanningRequest) -> str:
    """Return what is wrong with the answer, nothing if it is right; refusals are raised."""
    answer = plan(ARM, limits, request)
    q = answer.points.positions
    if np.abs(q[0] - request.start).max() > FIRST_POINT:
        return f'begins at {q[0]}'
    if np.linalg.norm(forward_kinematics(ARM, q[-1]) - request.via_points[-1]) > LAST_POINT:
        return f'ends with the tip at {forward_kinematics(ARM, q[-1])}'
    if not ((q >= limits.min_position - RANGE) & (q <= limits.max_position + RANGE)).all():
        return 'leaves a range'
    return ''


def main() -> int:
    """Run the soak."""
    requests = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    seed = int(sys.argv[2]) if len(sys.argv) > 2 else 0
    counts: Counter[str] = Counter()
    failures = 0
    for k in range(seed, seed + requests):
        limits, request = random_request(np.random.default_rng(k))
        try:
            wrong = fault(limits, request)
            counts['planned'] += 1
        except RrrPlannerError as error:
            counts[type(error).__name__] += 1
            wrong = str(error) if isinstance(error, ConvergenceError) else ''
        if wrong:
            failures += 1
            print(f'seed {k}, {request.planner_id} from {request.start} through '
                  f'{request.via_points.tolist()}: {wrong}', flush=True)
    print(f'{requests} requests, {failures} failures: '
          + ', '.join(f'{count} {what}' for what, count in counts.most_common()))
    return 1 if failures else 0


if __name__ == '__main__':
    raise SystemExit(main())
