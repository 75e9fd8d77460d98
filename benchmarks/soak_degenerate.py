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

"""Whether any planner fails or breaks a promise on requests whose numbers are special."""

from __future__ import annotations

import argparse
from collections import Counter
from dataclasses import replace
import os
import sys
import time

os.environ.setdefault('OPENBLAS_NUM_THREADS', '1')  # before numpy; one process a core

from degenerate_tasks import degenerate_task  # noqa: E402
from measuring import setting  # noqa: E402
import numpy as np  # noqa: E402
from rrr_traj_planner.core.dynamics.rigid_body import inverse_dynamics  # noqa: E402
from rrr_traj_planner.core.errors import ConvergenceError, RrrPlannerError  # noqa: E402
from rrr_traj_planner.core.kinematics.forward import forward_kinematics  # noqa: E402
from rrr_traj_planner.planners.plan import Plan  # noqa: E402
from rrr_traj_planner.planners.planning import plan  # noqa: E402
from rrr_traj_planner.planners.registry import planner, planner_ids  # noqa: E402
from tasks import Task  # noqa: E402

PER_KNOT = 12            # checked points between two knots of the motion
PER_POINT = 20           # and between two points of the answer
MOST = 200_000           # of them in all
LIMIT_TOLERANCE = 1e-6   # relative, the promise of every planner
POINTS_TOLERANCE = 1e-3  # relative, of the quintics through the points
ANGLE_TOLERANCE = 1e-9   # rad
PLACE_TOLERANCE = 1e-8   # m, and rad/s of what rests
OVERSHOOT = 1e-6         # rad that a quintic may leave a range by
NANOSECOND = 1e-9        # s
NO_TORQUE = 1e-6         # N m
LEAST_GAP = 0.1          # of the period, between points, but where a joint is
NEAR_END = 0.01          # rad from the end of its range


def violations(task: Task, found: Plan) -> list[str]:
    """Return what a plan breaks, by nothing but evaluating it on dense grids."""
    motion, limits = found.trajectory, _scaled(task)
    steps = np.arange(PER_KNOT) / PER_KNOT
    t = (motion.knots[:-1, np.newaxis] + np.diff(motion.knots)[:, np.newaxis] * steps).ravel()
    t = np.append(t[:: max(1, len(t) // MOST)], motion.duration)
    broken = _beyond(task, limits, *motion(t), LIMIT_TOLERANCE, ANGLE_TOLERANCE)
    followed = controller_motion(found.points)
    broken += [f'at the points: {text}' for text in _beyond(
        task, limits, *followed, POINTS_TOLERANCE, OVERSHOOT)]
    effort = np.abs(inverse_dynamics(task.model, *followed[:3])).max(axis=0)
    if not (effort <= found.effort * (1.0 + POINTS_TOLERANCE) + NO_TORQUE).all():
        broken.append(f'torque at the points: {effort}, told {found.effort}')
    q = found.points.positions
    inside = np.minimum(q - limits.min_position, limits.max_position - q).min(axis=1)
    # a motion of months: its times are no finer than some nanoseconds
    tick = max(NANOSECOND, 8.0 * float(np.spacing(motion.duration)))
    free = np.abs(found.points.times[:, np.newaxis] - found.via_times).min(axis=1) > 2.0 * tick
    gap = np.diff(found.points.times)[free[1:] & (inside[1:] > NEAR_END)]
    if task.request.segment_durations is None and gap.min(initial=np.inf) < (
            LEAST_GAP * task.request.sample_period - 3.0 * NANOSECOND):
        broken.append(f'points {gap.min():.3g} s apart')
    misses = planner(task.request.planner_id).misses_via_points
    inner = slice(None) if not misses else [0, -1]
    missed = np.abs(forward_kinematics(task.model, motion(found.via_times[inner])[0])
                    - task.request.via_points[inner]).max()
    if missed > PLACE_TOLERANCE:
        broken.append(f'via point missed by {missed:.3g} m')
    points, stamps = found.points, np.round(found.points.times / NANOSECOND)
    if (np.diff(stamps) <= 0.0).any() or stamps[0] != 0.0:
        broken.append('stamps do not increase from zero')
    if np.abs(np.array([points.velocities[[0, -1]], points.accelerations[[0, -1]]])).max() > 0.0:
        broken.append('not at rest at an end')
    away = np.abs(stamps[:, np.newaxis] * NANOSECOND - found.via_times).min(axis=0).max()
    if away > 1.5 * tick:
        broken.append(f'no point at a via time: {away:.3g} s from it')
    return broken


def controller_motion(points) -> tuple[np.ndarray, ...]:
    """
    Return what joint_trajectory_controller makes of an answer's points, (m, 3) each.

    Between two points with positions, velocities and accelerations it follows the polynomial of
    fifth order that meets all of them; its coefficients are solved for here.
    """
    h = np.diff(points.times)
    x = np.linspace(0.0, 1.0, PER_POINT)
    ends = np.array([[np.polyval(np.polyder(np.eye(6)[k], d), s) if d < 6 else 0.0
                      for k in range(6)] for s in (0.0, 1.0) for d in range(3)])
    states = (points.positions, points.velocities, points.accelerations)
    scale = [1.0, h[:, np.newaxis], h[:, np.newaxis] ** 2]
    wanted = np.array([s[side] * f for side in (slice(None, -1), slice(1, None))
                       for s, f in zip(states, scale)])          # (6, segments, 3)
    c = np.linalg.solve(ends, wanted.reshape(6, -1)).reshape(wanted.shape)
    out = []
    for d in range(4):
        basis = np.array([np.polyval(np.polyder(np.eye(6)[k], d), x) for k in range(6)])
        values = np.einsum('kx,ksj->sxj', basis, c) / h[:, np.newaxis, np.newaxis] ** d
        out.append(values.reshape(-1, 3))
    out[3] = np.zeros_like(out[3])  # of jerk nothing is promised
    return tuple(out)


def _scaled(task: Task):
    r = task.request
    return task.limits.scaled(r.velocity_scaling, r.acceleration_scaling)


def _beyond(task: Task, limits, q, qd, qdd, jerk, tolerance: float, angle: float) -> list[str]:
    """Return the limits that states exceed."""
    tau = inverse_dynamics(task.model, q, qd, qdd)
    broken = [f'{name}: {np.abs(x).max(axis=0)} over {bound}' for name, x, bound in (
        ('velocity', qd, limits.max_velocity), ('acceleration', qdd, limits.max_acceleration),
        ('jerk', jerk, limits.max_jerk), ('torque', tau, limits.max_effort))
        if not (np.abs(x) <= bound * (1.0 + tolerance)).all()]
    outside = np.maximum(limits.min_position - q, q - limits.max_position).max()
    return broken if outside <= angle else [
        *broken, f'position: {outside:.3g} rad outside its range']


def soak(seed: int, planner_id: str, limit: float) -> tuple[str, str, float]:
    """Plan a seed's request in a limited time [s]: what came of it, in a word and in full."""
    task = degenerate_task(seed, planner_id)
    begin = time.perf_counter()
    request = replace(task.request, should_stop=lambda: time.perf_counter() > begin + limit)
    try:
        found = plan(task.model, task.limits, request)
    except ConvergenceError as error:
        return 'FAULT', f'{type(error).__name__}: {error}', time.perf_counter() - begin
    except RrrPlannerError as error:
        return type(error).__name__, str(error), time.perf_counter() - begin
    except Exception as error:  # noqa: BLE001  whatever it is, it is counted
        return 'FAULT', f'{type(error).__name__}: {error}', time.perf_counter() - begin
    seconds = time.perf_counter() - begin
    broken = violations(task, found)
    return ('VIOLATION', '; '.join(broken), seconds) if broken else (
        'planned', found.note, seconds)


def main() -> int:
    """Run the requests of consecutive seeds and print what came of them."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('tasks', type=int, help='how many for each planner')
    parser.add_argument('seed', type=int, help='of the first; the others follow')
    parser.add_argument('--planner', choices=planner_ids(), help='one alone; else all')
    parser.add_argument('--limit', type=float, default=1.0, help='planning time [s]')
    parser.add_argument('--refusals', action='store_true', help='print their texts')
    options = parser.parse_args()
    print(setting(), flush=True)
    faults = 0
    for planner_id in [options.planner] if options.planner else planner_ids():
        counts, seconds = Counter(), []
        for seed in range(options.seed, options.seed + options.tasks):
            word, text, taken = soak(seed, planner_id, options.limit)
            counts[word] += 1
            seconds.append(taken)
            if word in ('FAULT', 'VIOLATION') or (options.refusals and word != 'planned'):
                print(f'{degenerate_task(seed, planner_id).name}: {word} {text}', flush=True)
        faults += counts['FAULT'] + counts['VIOLATION']
        print(f'{planner_id}: {dict(counts)}; slowest {max(seconds):.2f} s', flush=True)
    return int(faults > 0)


if __name__ == '__main__':
    sys.exit(main())
