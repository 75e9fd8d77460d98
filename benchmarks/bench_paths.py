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

"""How fast the tip is led along a path, and how long that takes to plan, beside TOPP-RA."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from dataclasses import replace
from itertools import count, islice
import math

from measuring import compared, in_turns, REPETITIONS, Row, setting, table, timed
import numpy as np
from path_tasks import followed, path_task, PLANNERS, task_path
from peers import both, GRID_POINTS, torque_of
from rrr_traj_planner.core.cancellation import never
from rrr_traj_planner.core.errors import RrrPlannerError
from rrr_traj_planner.core.path.arm_path import ArmPath
from rrr_traj_planner.planners.path_timing.least_time import fastest_along
from rrr_traj_planner.planners.path_timing.task import PathTask
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.sampling_jerk_limit import acceleration_scale, limits_for_sampling
from tasks import gentle, NONE, STRONG, Task, WEAK
from tasks import table as thesis_table
from toppra import algorithm, constraint
from toppra.interpolator import AbstractGeometricPath

PATHS = 24                    # random ones for each planner
RANDOM_REPETITIONS = 3        # of planning each of them
MOTION = 1.08                 # the target, at most
TIMING = {'line_arc': 1.0, 'line_polynomial': 2.0}  # of timing a path that is ready,
RANDOM_TIMING = 2.0                                 # and a random one
PLAIN = 20                    # from the seed of one plain task to the next

Pair = tuple[float, float]    # of ours and theirs


class PathInJointSpace(AbstractGeometricPath):
    """An arm's path as TOPP-RA takes it, by arc length."""

    def __init__(self, arm_path: ArmPath) -> None:
        self._arm_path, self._ends = arm_path, np.array([0.0, arm_path.path.length])

    def __call__(self, s: float | np.ndarray, order: int = 0) -> np.ndarray:
        """Return joint positions or a derivative of them."""
        found = self._arm_path(np.clip(np.atleast_1d(s), *self._ends))[order]
        return found if np.ndim(s) else found[0]

    @property
    def dof(self) -> int:
        """Return the number of joints."""
        return 3

    @property
    def path_interval(self) -> np.ndarray:
        """Where the path begins and ends [m]."""
        return self._ends

    @property
    def waypoints(self) -> None:
        """None: it is no spline."""
        return None


def toppra_duration(task: Task, arm_path: ArmPath) -> float:
    """Return how long TOPP-RA's motion along a path takes [s]; its jerk has no limit."""
    limits = task.limits
    wanted = [constraint.JointVelocityConstraint(both(limits.max_velocity)),
              constraint.JointAccelerationConstraint(both(limits.max_acceleration)),
              constraint.JointTorqueConstraint(
                  torque_of(task.model), both(limits.max_effort), np.zeros(3))]
    grid = np.union1d(np.linspace(0.0, arm_path.path.length, GRID_POINTS + 1),
                      arm_path.path.joins)
    solver = algorithm.TOPPRA(wanted, PathInJointSpace(arm_path), gridpoints=grid,
                              solver_wrapper='seidel')
    trajectory = solver.compute_trajectory(0.0, 0.0)
    return math.nan if trajectory is None else float(trajectory.duration)


def tables(repetitions: int = REPETITIONS) -> list[Row]:
    """Return times of motions and of planning for the thesis's tables."""
    return [row for planner_id in PLANNERS for name, effort in (('6.1', WEAK), ('6.3', STRONG))
            for row in _table(planner_id, name, effort, repetitions)]


def _table(planner_id: str, name: str, effort: object, repetitions: int) -> list[Row]:
    task = thesis_table(name, replace(gentle(effort), max_jerk=NONE), 'v 1, a 1, torque')
    task = replace(task, request=replace(task.request, planner_id=planner_id, elbow='up'))
    arm_path, label = _arm_path(task), f'{task.name}: {planner_id} / TOPP-RA'
    medians = in_turns(
        lambda: _timed(task, arm_path), lambda: toppra_duration(task, arm_path),
        lambda: _own(task), repetitions=repetitions)
    return [compared(label, MOTION, _own(task), toppra_duration(task, arm_path)),
            timed(f'planning, {label}, the path ready', TIMING[planner_id], medians),
            timed(f'planning, {label}, plan()', None, medians, ours=2)]


def random(paths: int = PATHS, repetitions: int = RANDOM_REPETITIONS,
           say: bool = False) -> list[Row]:
    """Return the median and the worst ratio over random paths of random arms and limits."""
    rows = []
    for first, planner_id in enumerate(PLANNERS):
        found = [_both(task, repetitions, say) for task in islice(_random_tasks(first), paths)]
        motions, timings, plans = zip(*found)
        for what, target, scale, unit, pairs in (
                ('', MOTION, 1.0, 's', motions),
                ('planning, the path ready, ', RANDOM_TIMING, 1e3, 'ms', timings),
                ('planning, plan(), ', None, 1e3, 'ms', plans)):
            pairs = sorted(pairs, key=lambda pair: pair[0] / pair[1])
            for label, pair in (('median', pairs[len(pairs) // 2]), ('worst', pairs[-1])):
                rows.append(compared(
                    f'{what}{paths} random paths, v, a, torque: {planner_id} / TOPP-RA, {label}',
                    target, *(scale * x for x in pair), unit, paths))
    return rows


def _both(task: Task, repetitions: int, say: bool) -> tuple[Pair, Pair, Pair]:
    """Return durations, ours and TOPP-RA's: of motions, of timing and of planning them [s]."""
    arm_path = _arm_path(task)
    motion = _own(task), toppra_duration(task, arm_path)
    timing, planning, theirs = in_turns(
        lambda: _timed(task, arm_path), lambda: _own(task),
        lambda: toppra_duration(task, arm_path), repetitions=repetitions).times
    if say:
        print(f'{task.request.planner_id}, {task.name}: {len(task.request.via_points)} points, '
              f'{motion[0]:.4f} s / {motion[1]:.4f} s = {motion[0] / motion[1]:.4f}; timing '
              f'{timing:.3f} s, plan() {planning:.3f} s / {theirs:.3f} s', flush=True)
    return motion, (timing, theirs), (planning, theirs)


def _random_tasks(first: int) -> Iterator[Task]:
    """Give plain tasks of a planner with acceleration and torque limits, without jerk's."""
    for seed in count(first, PLAIN):
        task = path_task(seed)
        if np.isfinite([task.limits.max_acceleration, task.limits.max_effort]).all():
            yield replace(task, limits=replace(task.limits, max_jerk=NONE))


def _arm_path(task: Task) -> ArmPath:
    """Return the path that our planner has chosen; where it fails, the one of largest radii."""
    try:
        return plan(task.model, task.limits, task.request).trajectory.arm_path
    except RrrPlannerError:
        path = task_path(task, task.request.via_points)
        return followed(task, path)


def _timed(task: Task, arm_path: ArmPath) -> float:
    """Return how long our motion along a path that is ready takes [s]."""
    scale = acceleration_scale(task.model, task.limits, arm_path(arm_path.path.via_s).q)
    limits = limits_for_sampling(task.limits, scale, task.request.sample_period)
    fresh = replace(arm_path)  # with nothing remembered
    return fastest_along(PathTask(
        fresh, limits, task.request.max_tip_speed, task.request.steady_zones,
        never)).trajectory.duration


def _own(task: Task) -> float:
    """Return how long our motion takes [s]; infinite where planning fails."""
    try:
        return plan(task.model, task.limits, task.request).trajectory.duration
    except RrrPlannerError as error:
        print(f'{task.name}: {error}', flush=True)
        return math.inf


def main() -> None:
    """Print every ratio."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--paths', type=int, default=PATHS, help='random ones for each planner')
    parser.add_argument('--repetitions', type=int, default=REPETITIONS)
    options = parser.parse_args()
    print(setting())
    print(table(tables(options.repetitions) + random(options.paths, say=True)))


if __name__ == '__main__':
    main()
