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
Whether time_optimal goes on from any state of a planned motion, under hostile conditions.

    python benchmarks/soak_hostile_moving.py [STATES [SEED [TARGETS]]]

States are of motions of several planners, of the thesis's arm, public ones and random chains, with
limits missing, very small or out of all proportion, scalings, sample periods of 1 to 50 ms, and
at instants at and beside via points. Targets are of one kind each, or of the kinds given. The
rest of the motion is a witness: each state can be gone on from. A refusal is a failure unless the
via points cannot be reached from the motion's end either. Answers are judged as in
`soak_moving_starts`. Prints failures, motions that take over SLOW of the time that was left, and
how many states of each kind there were; the exit code is 1 if any failed.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache
import os
from pathlib import Path
import sys
import time

os.environ.setdefault('OPENBLAS_NUM_THREADS', '1')  # before numpy; one process a core

from moving_answers import broken_limit, other_start  # noqa: E402
import numpy as np  # noqa: E402
from rrr_traj_planner.core.arm.limits import JointLimits  # noqa: E402
from rrr_traj_planner.core.arm.model import RobotModel  # noqa: E402
from rrr_traj_planner.core.dynamics.rigid_body import gravity_torque  # noqa: E402
from rrr_traj_planner.core.errors import RrrPlannerError, TimeLimitError  # noqa: E402
from rrr_traj_planner.core.kinematics.forward import forward_kinematics  # noqa: E402
from rrr_traj_planner.planners.deadline import Deadline  # noqa: E402
from rrr_traj_planner.planners.plan import Plan  # noqa: E402
from rrr_traj_planner.planners.planning import plan  # noqa: E402
from rrr_traj_planner.planners.request import PlanningRequest  # noqa: E402
from tasks import NONE  # noqa: E402

sys.path.insert(0, str(Path(__file__).parents[1] / 'test'))
from helpers.public_arms import arms  # noqa: E402, I100

STATES_OF_A_MOTION = 3
PLANNERS = 'cycloid', 'gauss', 'septic', 'line_arc', 'line_polynomial', 'time_optimal'
TARGETS = 'rest', 'dense', 'near', 'clustered', 'behind', 'other', 'range', 'short'
WEAK, STRONG = (1.05, 1.5), (1e2, 1e5)  # over what holds the arm; over its own effort limits
TRIES = 200                      # at drawing poses that can be held
HELD = 0.95                      # of the effort limits, at drawn poses
SLOW, LEFT = 1.6, 0.1            # over what was left of the motion, if that was so long [s]
TIME_LIMITS, LATE = (None, None, 0.2, 1.0), 0.3  # s, and s after the limit
TIP = 1e-8                       # m
POSTURE = 1e-4                   # rad: nearer points with the same tip are one


@dataclass(frozen=True, eq=False)
class Case:
    """A moving start, and the motion that it is of."""

    name: str
    targets: str
    model: RobotModel
    limits: JointLimits
    request: PlanningRequest
    end: np.ndarray          # where the motion ends [rad]
    left: float | None       # of the motion [s], where that passes the targets
    time_limit: float | None

    def answer(self) -> Plan:
        """Plan it."""
        request = self.request
        if self.time_limit is not None:
            request = replace(request, should_stop=Deadline(self.time_limit, time.process_time))
        return plan(self.model, self.limits, request)

    def is_possible(self) -> bool:
        """Return whether the via points can be held, and reached from where the motion ends."""
        q = self.request.joint_via_points
        needed = np.abs(gravity_torque(self.model, q)) + self.model.friction.coulomb
        if self.left is not None or (needed > self.limits.max_effort).any():
            return bool((needed <= self.limits.max_effort).all())
        try:
            plan(self.model, self.limits, replace(
                self.request, start=self.end, start_velocity=None, start_acceleration=None))
        except RrrPlannerError:
            return False
        return True

    def fault(self, answer: Plan) -> str:
        """Return what is wrong with an answer, nothing if it is right."""
        request = self.request
        limits = self.limits.scaled(request.velocity_scaling, request.acceleration_scaling)
        passed = answer.trajectory(answer.via_times)[0]
        missed = np.abs(passed - request.joint_via_points).max()
        tips = (forward_kinematics(self.model, q) for q in (passed, request.joint_via_points))
        if missed > POSTURE or np.abs(np.subtract(*tips)).max() > TIP:
            return f'misses a via point by {missed:.3g} rad'
        return other_start(answer, request) or broken_limit(answer, limits, self.model, 2000)


@cache
def every_arm() -> list[tuple[str, RobotModel, JointLimits]]:
    """Return the thesis's arm, public ones and random chains, with their limits."""
    thesis = JointLimits(max_effort=np.array([150.0, 200.0, 200.0]))
    own = [('thesis', RobotModel(), thesis)] * 6
    return own + [(arm.name, arm.model, arm.limits) for arm in arms()]


def hostile_limits(rng: np.random.Generator, model: RobotModel, limits: JointLimits,
                   poses: np.ndarray) -> JointLimits:
    """Return an arm's limits with some of them missing, weak or out of proportion."""
    needed = np.abs(gravity_torque(model, poses)).max(axis=0) / HELD + model.friction.coulomb
    effort = (limits.max_effort, limits.max_effort, NONE, limits.max_effort * 10.0 ** rng.uniform(
        2.0, 5.0), np.minimum(limits.max_effort, np.maximum(
            rng.uniform(*WEAK) * needed, 1e-3 * limits.max_effort)))[rng.integers(5)]
    acceleration, jerk = (
        (own, NONE, np.where(rng.random(3) < 0.5, own, np.inf))[rng.choice(3, p=(0.5, 0.25, 0.25))]
        for own in (limits.max_acceleration, limits.max_jerk))
    if rng.random() < 0.1:
        effort = np.where(rng.random(3) < 0.5, effort, np.inf)
    missing = np.isinf(effort) & np.isinf(acceleration)
    return replace(limits, max_effort=effort, max_jerk=jerk, max_acceleration=np.where(
        missing, limits.max_acceleration, acceleration))


def pose(rng: np.random.Generator, model: RobotModel, limits: JointLimits) -> np.ndarray:
    """Return a random pose that can be held."""
    for _ in range(TRIES):
        q = rng.uniform(np.maximum(limits.min_position, -np.pi),
                        np.minimum(limits.max_position, np.pi))
        if rng.random() < 0.15:
            j = rng.integers(3)
            q[j] = (limits.min_position, limits.max_position)[rng.integers(2)][j]
            q = np.where(np.isfinite(q), q, 0.0)
        if holds(model, limits, q):
            return q
    raise LookupError('no pose can be held')


def holds(model: RobotModel, limits: JointLimits, q: np.ndarray) -> bool:
    """Return whether the motors hold a pose."""
    held = HELD * (limits.max_effort - model.friction.coulomb)
    return bool((np.abs(gravity_torque(model, q)) <= held).all())


def cases(seed: int, kinds: tuple[str, ...]) -> Iterator[Case]:
    """Give moving starts of one motion; none where there is no motion."""
    rng = np.random.default_rng(seed)
    name, model, own = every_arm()[rng.integers(len(every_arm()))]
    points = np.array([pose(rng, model, own) for _ in range(rng.integers(2, 7))])
    limits = hostile_limits(rng, model, own, points)
    planner_id = str(rng.choice(PLANNERS))
    if np.isinf(limits.max_acceleration).any() or rng.random() < 0.3:
        planner_id = 'time_optimal'
    if planner_id.startswith('line'):
        points = points[0] + np.cumsum(rng.uniform(-0.3, 0.3, points.shape), axis=0)
    scaling = rng.choice([1.0, 1.0, rng.uniform(0.05, 1.0)], 2)
    common = {'velocity_scaling': float(scaling[0]), 'acceleration_scaling': float(scaling[1]),
              'sample_period': float(10.0 ** rng.uniform(-3.0, -1.3))}
    asked = ({'via_points': forward_kinematics(model, points[1:]), 'start': points[0]}
             if planner_id.startswith('line') else {'joint_via_points': points})
    try:
        before = plan(model, limits, PlanningRequest(**asked, planner_id=planner_id, **common))
    except RrrPlannerError:
        return
    for number in range(STATES_OF_A_MOTION):
        targets = str(rng.choice(kinds))
        t = instant(rng, before, targets)
        q, qd, qdd, _ = (f[0] for f in before.trajectory(np.array([t])))
        q = np.clip(q, limits.min_position, limits.max_position)
        goals, left = targets_of(rng, targets, model, own, before, t)
        yield Case(
            f'seed {seed}/{number}, {name}, {planner_id}, {targets}', targets, model, limits,
            PlanningRequest(joint_via_points=goals, start=q, start_velocity=qd,
                            start_acceleration=qdd, planner_id='time_optimal', **common),
            before.trajectory(before.trajectory.duration)[0],
            before.trajectory.duration - t if left else None,
            TIME_LIMITS[rng.integers(len(TIME_LIMITS))])


def instant(rng: np.random.Generator, before: Plan, targets: str) -> float:
    """Return a random instant of a motion, often at or beside a via point."""
    T, via = before.trajectory.duration, before.via_times
    if targets == 'short' or rng.random() < 0.2:
        beside = rng.choice([-1.0, 1.0]) if targets != 'short' else -1.0
        return float(np.clip(rng.choice(via) + beside * 10.0 ** rng.uniform(-9.0, -2.0),
                             0.0, T - 1e-6))
    return float(rng.uniform(0.0, T))


def targets_of(rng: np.random.Generator, kind: str, model: RobotModel, limits: JointLimits,
               before: Plan, t: float) -> tuple[np.ndarray, bool]:
    """Return via points [rad], and whether the rest of the motion passes them."""
    trajectory, T = before.trajectory, before.trajectory.duration
    q, qd = (f[0] for f in trajectory(np.array([t]))[:2])
    end = trajectory(T)[0]

    def inside(points: np.ndarray) -> np.ndarray:
        return np.clip(points, limits.min_position, limits.max_position)

    if kind in ('rest', 'short'):
        return inside(trajectory(before.via_times[before.via_times > t])[0]), True
    if kind == 'dense':
        times = np.linspace(t, T, rng.integers(4, 40))[1:]
        return inside(trajectory(times)[0]), True
    if kind == 'near':
        way = rng.normal(size=3)
        way *= 10.0 ** rng.uniform(-5.0, -1.0) / np.linalg.norm(way)
        return inside((q + way)[np.newaxis]), False
    if kind == 'clustered':
        size, n = 10.0 ** rng.uniform(-4.0, -1.0), int(rng.integers(3, 12))
        return inside(pose(rng, model, limits) + size * rng.uniform(-1.0, 1.0, (n, 3))), False
    if kind == 'behind':
        behind = trajectory(max(t - rng.uniform(0.0, 0.3), 0.0))[0]
        return inside(np.array([behind, end] if rng.random() < 0.5 else [behind])), False
    if kind == 'range':
        goal = pose(rng, model, limits)
        j = rng.integers(3)
        goal[j] = np.where(qd[j] > 0.0, limits.max_position, limits.min_position)[j]
        return inside(np.where(np.isfinite(goal), goal, 0.0)[np.newaxis]), False
    return np.array([pose(rng, model, limits) for _ in range(rng.integers(1, 5))]), False


def main() -> int:
    """Run the soak."""
    states = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    seed = int(sys.argv[2]) if len(sys.argv) > 2 else 0
    kinds = tuple(sys.argv[3:]) or TARGETS
    counts: Counter[str] = Counter()
    ratios, seconds = defaultdict(list), defaultdict(list)
    while counts.total() < states:
        for case in cases(seed, kinds):
            began, wrong, outcome = time.process_time(), '', 'planned'
            try:
                answer = case.answer()
            except Exception as error:  # noqa: BLE001  whatever it is, it is counted
                wrong, outcome = f'{type(error).__name__}: {error}', (
                    'out of time' if isinstance(error, TimeLimitError) else
                    'refused' if isinstance(error, RrrPlannerError) else 'bug')
            taken = time.process_time() - began
            if outcome == 'planned':
                wrong = case.fault(answer)
                outcome = 'violation' if wrong else outcome
                if case.left and case.left > LEFT and case.time_limit is None:
                    ratios[case.targets].append(answer.trajectory.duration / case.left)
                    if ratios[case.targets][-1] > SLOW:
                        print(f'{case.name}: slow, {ratios[case.targets][-1]:.2f} times '
                              f'{case.left:.3g} s; {answer.note}', flush=True)
            elif outcome == 'refused' and not case.is_possible():
                wrong, outcome = '', 'impossible'
            if case.time_limit is None:
                seconds[case.targets].append(taken)
            elif taken > case.time_limit + LATE:
                print(f'{case.name}: LATE, {taken:.2f} s, limit {case.time_limit} s', flush=True)
            counts[outcome] += 1
            if wrong:
                print(f'{case.name}: {wrong}', flush=True)
        seed += 1
    print(dict(counts), 'next seed', seed)
    for kind in sorted(seconds):
        r = np.array(ratios[kind] or [np.nan])
        print(f'{kind:10} {len(seconds[kind]):5d} states, planning median '
              f'{np.median(seconds[kind]):.3f} s, longest {max(seconds[kind]):.2f} s; '
              f'{(r > SLOW).sum()} of {np.isfinite(r).sum()} slow, median {np.median(r):.3f}, '
              f'worst {r.max():.3f}')
    return int(counts['refused'] + counts['violation'] + counts['bug'] > 0)


if __name__ == '__main__':
    sys.exit(main())
