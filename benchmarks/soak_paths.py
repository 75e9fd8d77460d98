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

"""Whether a planner of paths ever fails or breaks a promise, on many paths that are feasible."""

from __future__ import annotations

import argparse
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
import os
import time

os.environ.setdefault('OPENBLAS_NUM_THREADS', '1')  # before numpy; one process a core

from measuring import setting  # noqa: E402
import numpy as np  # noqa: E402
from path_tasks import KINDS, path_task, PLANNERS  # noqa: E402
from rrr_traj_planner.core.dynamics.rigid_body import inverse_dynamics  # noqa: E402
from rrr_traj_planner.core.kinematics.forward import forward_kinematics, jacobian  # noqa: E402
from rrr_traj_planner.core.kinematics.inverse import inverse_kinematics  # noqa: E402
from rrr_traj_planner.core.trajectory.quintic_spline import spline_through  # noqa: E402
from rrr_traj_planner.planners.plan import Plan  # noqa: E402
from rrr_traj_planner.planners.planning import plan  # noqa: E402
from soak_time_optimal import PERCENTILES, Result  # noqa: E402
from tasks import Task  # noqa: E402

PER_SAMPLE = 20          # checked points between two samples
PER_KNOT = 8             # and between two knots
LIMIT_TOLERANCE = 1e-6   # relative, the promise of every planner
POINTS_TOLERANCE = 1e-3  # relative, of the quintic through the points
ANGLE_TOLERANCE = 1e-9   # rad
PLACE_TOLERANCE = 1e-9   # m
REST = 1e-9              # rad/s and rad/s^2
BESIDE = 1e-9            # s from a knot, where both sides are checked
LEAST_BESIDE, PART_OF_PIECE = 1e-12, 1e-4  # less beside short pieces, where jerk is steep
CONTINUOUS = 1e-9        # rad, rad/s, rad/s^2
ROUNDING = 1e-13         # of the largest value, in what is evaluated on both sides
PROGRESS = 100           # tasks, after which it is said how far it is
NANOSECOND = 1e-9        # to which stamps are rounded
TOLD = 1e-2              # rad/s^2 of a step that the note must tell of


def soak(seed: int, limit: float) -> Result:
    """Plan the task of a seed, in a limited time [s] as the node does, and check the answer."""
    task = path_task(seed)
    begin, found, failure = time.perf_counter(), None, ''
    request = replace(task.request, should_stop=lambda: time.perf_counter() > begin + limit)
    try:
        found = plan(task.model, task.limits, request)
    except Exception as error:  # noqa: BLE001  whatever it is, it is counted
        failure = f'{type(error).__name__}: {error}'
    seconds = time.perf_counter() - begin
    broken = violations(task, found) if found else []
    return Result(seed, len(request.via_points), seconds, found.trajectory.duration if found
                  else np.nan, found.note if found else '', failure, broken)


def violations(task: Task, found: Plan) -> list[str]:
    """Return what a plan breaks on a dense grid, by nothing but evaluating it there."""
    motion = found.trajectory
    n = int(np.ceil(motion.duration * PER_SAMPLE / task.request.sample_period))
    share = np.arange(PER_KNOT) / PER_KNOT
    between = motion.knots[:-1, np.newaxis] + np.diff(motion.knots)[:, np.newaxis] * share
    t = np.unique(np.concatenate((np.linspace(0.0, motion.duration, n + 1), between.ravel(),
                                  motion.knots[1:-1] - BESIDE, motion.knots)))
    return [*_limits_broken(task, found, t), *_points_missed(task, found),
            *_path_left(task, found, t), *_jumps(task, found), *_samples_broken(task, found)]


def _limits_broken(task: Task, found: Plan, t: np.ndarray) -> list[str]:
    """Return the limits that are exceeded, ranges included, and motion at the ends."""
    limits = task.limits
    q, qd, qdd, jerk = found.trajectory(t)
    tau = inverse_dynamics(task.model, q, qd, qdd)
    broken = [f'{name}: {np.abs(x).max(axis=0)} over {bound}' for name, x, bound in (
        ('velocity', qd, limits.max_velocity), ('acceleration', qdd, limits.max_acceleration),
        ('jerk', jerk, limits.max_jerk), ('torque', tau, limits.max_effort))
        if (np.abs(x) > bound * (1.0 + LIMIT_TOLERANCE)).any()]
    outside = np.maximum(limits.min_position - q, q - limits.max_position).max()
    if outside > ANGLE_TOLERANCE:
        broken.append(f'position: {outside:.3g} rad outside its range')
    if np.abs([*qd[[0, -1]], *qdd[[0, -1]]]).max() > REST:
        broken.append('not at rest at an end')
    return broken


def _points_missed(task: Task, found: Plan) -> list[str]:
    """Return by how much via points are missed, in joint space."""
    q = found.trajectory(found.via_times)[0]
    wanted = np.array([inverse_kinematics(task.model, p, task.request.elbow)
                       for p in task.request.via_points])
    turns = (q - wanted) / (2.0 * np.pi)
    missed = 2.0 * np.pi * np.abs(turns - np.round(turns)).max()
    broken = [f'via point missed by {missed:.3g} rad'] if missed > ANGLE_TOLERANCE else []
    if task.request.start is not None:
        off = np.abs(found.trajectory(0.0)[0] - task.request.start).max()
        broken += [f'start missed by {off:.3g} rad'] if off > ANGLE_TOLERANCE else []
    return broken


def _path_left(task: Task, found: Plan, t: np.ndarray) -> list[str]:
    """Return where the tip leaves the path or the polyline, goes back or is too fast."""
    motion = found.trajectory
    s, sd = motion.progress(t)[:2]
    path, request = motion.arm_path.path, task.request
    q, qd, _, _ = motion(t)
    tip = forward_kinematics(task.model, q)
    broken = []
    off = np.linalg.norm(tip - path(np.clip(s, 0.0, path.length))[0], axis=1).max()
    if off > PLACE_TOLERANCE:
        broken.append(f'{off:.3g} m off its path')
    nearest = np.min([_distance_to_leg(tip, a, b)
                      for a, b in zip(path.points[:-1], path.points[1:])], axis=0).max()
    if nearest > request.max_deviation + PLACE_TOLERANCE:
        broken.append(f'{nearest:.6g} m from the polyline, {request.max_deviation:.6g} m allowed')
    if (np.diff(s) < -ROUNDING * path.length).any() or (sd < -REST).any():
        broken.append('goes back')
    speed = np.linalg.norm(np.einsum('nij,nj->ni', jacobian(task.model, q), qd), axis=1)
    if speed.max() > request.max_tip_speed * (1.0 + LIMIT_TOLERANCE):
        broken.append(f'tip at {speed.max():.6g} m/s over {request.max_tip_speed:.6g} m/s')
    if len(motion.via_times) > 2 and not (motion.progress(motion.via_times[1:-1])[1] > 0.0).all():
        broken.append('stops at a via point')
    return broken


def _distance_to_leg(p: np.ndarray, a: np.ndarray, b: np.ndarray) -> np.ndarray:
    along = np.clip((p - a) @ (b - a) / ((b - a) @ (b - a)), 0.0, 1.0)
    return np.linalg.norm(p - a - along[:, np.newaxis] * (b - a), axis=1)


def _jumps(task: Task, found: Plan) -> list[str]:
    """Return what jumps at a knot: nothing may but accelerations at joins of arcs, if told of."""
    motion = found.trajectory
    knots = motion.knots[1:-1]
    width = np.diff(motion.knots)
    near = np.clip(PART_OF_PIECE * np.minimum(width[1:], width[:-1]), LEAST_BESIDE, BESIDE)
    left, right = motion(knots - near), motion(knots + near)
    near = near[:, np.newaxis]
    broken, arcs = [], task.request.planner_id == 'line_arc'
    for order, name in enumerate(('position', 'velocity', 'acceleration')):
        change = right[order] - left[order] - near * (right[order + 1] + left[order + 1])
        jump = np.abs(change).max(axis=1) - ROUNDING * np.abs(right[order]).max()
        if order == 2 and arcs:
            steps = motion.join_times[:, np.newaxis] - knots
            at_join = np.abs(steps).min(axis=0, initial=np.inf) <= BESIDE
            if jump[at_join].max(initial=0.0) > TOLD and 'rad/s^2' not in found.note:
                broken.append(f'acceleration steps by {jump[at_join].max():.3g}, untold')
            jump = jump[~at_join]
        if jump.max(initial=0.0) > CONTINUOUS:
            broken.append(f'{name} jumps by {jump.max():.3g}')
    return broken


def _samples_broken(task: Task, found: Plan) -> list[str]:
    """Return what the answer's points do not keep: limits between them, via times, rest."""
    times, limits = found.points.times, task.limits
    t = (times[:-1, np.newaxis] + np.diff(times)[:, np.newaxis]
         * np.arange(PER_SAMPLE) / PER_SAMPLE).ravel()
    _, qd, qdd, _ = spline_through(found.points).at(t)
    broken = []
    for name, x, bound in (('velocity', qd, limits.max_velocity),
                           ('acceleration', qdd, limits.max_acceleration)):
        if (np.abs(x) > bound * (1.0 + POINTS_TOLERANCE)).any():
            broken.append(f'{name} between points: {np.abs(x).max(axis=0)} over {bound}')
    away = np.abs(times[:, np.newaxis] - found.via_times).min(axis=0).max()
    if away > NANOSECOND:
        broken.append(f'no point at a via time: {away:.3g} s from it')
    if np.abs([found.points.velocities[[0, -1]], found.points.accelerations[[0, -1]]]).max() > 0.0:
        broken.append('the first or the last point is not at rest')
    return broken


def report(results: list[Result]) -> str:
    """Return percentiles of planning time, notes by kind, counts, and every fault."""
    lines = []
    for kind in KINDS:
        own = [r for r in results if _kind(r) == kind]
        if own:
            values = ', '.join(f'{p} %: {v:.3f} s' for p, v in zip(
                PERCENTILES, np.percentile([r.seconds for r in own], PERCENTILES)))
            lines.append(f'planning time, {kind}: {values}')
    early = Counter(_kind(r) for r in results if 'before it converged' in r.note)
    lines.append(f'{sum(early.values())} ended before they converged: '
                 + ', '.join(f'{kind} {count}' for kind, count in early.items()))
    for k, planner_id in enumerate(PLANNERS):
        own = [r for r in results if r.seed % 2 == k]
        lines.append(f'{planner_id}: {len(own)} paths, {sum(bool(r.failure) for r in own)} '
                     f'failures, {sum(bool(r.violations) for r in own)} with violations')
    return '\n'.join(lines)


def _kind(result: Result) -> str:
    return KINDS[result.seed // 2 % len(KINDS)]


def main() -> int:
    """Run the tasks of consecutive seeds and print what came of them."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('tasks', type=int, help='how many')
    parser.add_argument('seed', type=int, help='of the first; the others follow')
    parser.add_argument('--jobs', type=int, default=1, help='processes')
    parser.add_argument('--limit', type=float, default=1.0, help='planning time [s]')
    options = parser.parse_args()
    print(setting(), flush=True)
    seeds = range(options.seed, options.seed + options.tasks)
    with ProcessPoolExecutor(options.jobs) as pool:
        results = []
        for result in pool.map(soak, seeds, [options.limit] * len(seeds)):
            results.append(result)
            if len(results) % PROGRESS == 0:
                print(f'{len(results)} of {options.tasks}', flush=True)
            if result.failure or result.violations:
                print(f'seed {result.seed} ({PLANNERS[result.seed % 2]}, {_kind(result)}, '
                      f'{result.points} points): {result.failure or "; ".join(result.violations)}',
                      flush=True)
    print(report(results))
    return int(any(r.failure or r.violations for r in results))


if __name__ == '__main__':
    raise SystemExit(main())
