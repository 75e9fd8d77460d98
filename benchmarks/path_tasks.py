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

"""Random paths of the tip that an arm can follow, each from a seed of its own."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from rrr_traj_planner.core.arm.chain import Chain
from rrr_traj_planner.core.dynamics.rigid_body import gravity_torque
from rrr_traj_planner.core.errors import (
    ConvergenceError,
    InvalidInputError,
    LimitViolationError,
    UnreachableError,
)
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.kinematics.inverse import inverse_kinematics
from rrr_traj_planner.core.kinematics.joint_ranges import out_of_range, whole_turns
from rrr_traj_planner.core.path import design as path_design
from rrr_traj_planner.core.path.arm_path import ArmPath
from rrr_traj_planner.core.path.cartesian_path import CartesianPath
from rrr_traj_planner.core.path.largest_radii import largest_radii
from rrr_traj_planner.core.path.workspace_check import check_workspace
from rrr_traj_planner.planners.request import PlanningRequest
from soak_tasks import random_arm, random_limits
from tasks import ARM, random_pose, Task

KINDS = ('plain', 'close pair', 'repeated point', 'collinear', 'sharp corner', 'heavy',
         'start state', 'tip speed', 'small', 'near an edge')
PLANNERS = ('line_arc', 'line_polynomial')
FAMILIES = {'line_arc': path_design.line_arc, 'line_polynomial': path_design.line_polynomial}

HELD = 0.99               # of an effort limit, that gravity takes at most on the path
CHECKS = 25               # on a leg while it is drawn
PLACES = 2000             # on the whole path
LEGS = (0.05, 0.6)        # of the arm's reach
SMALL = (0.003, 0.03)     # likewise
CLOSE = 1e-3              # m between the points of a close pair
SHARP = (2.7, 3.14)       # rad that the path turns by at a sharp corner
EDGE = (1e-4, 1e-2)       # of the reach, between a point and the edge of the workspace
DEVIATIONS = (0.005, 0.1)  # m
SPEEDS = (0.05, 1.0)      # m/s
DRAWS = 300               # of a point, before everything is drawn again


def path_task(seed: int) -> Task:
    """Return the task of a seed; its kind is KINDS[seed // 2 % len(KINDS)]."""
    rng = np.random.default_rng(seed)
    kind = KINDS[seed // 2 % len(KINDS)]
    model = ARM if rng.random() < 0.5 else random_arm(rng)
    elbow = 'up' if rng.random() < 0.5 else 'down'
    request = PlanningRequest(
        np.zeros((2, 3)), planner_id=PLANNERS[seed % 2], elbow=elbow,
        sample_period=float(rng.choice([0.005, 0.01, 0.01, 0.01, 0.02])),
        max_deviation=_between(rng, DEVIATIONS),
        max_tip_speed=_between(rng, SPEEDS) if kind == 'tip speed' else np.inf)
    task = Task(f'seed {seed}, {kind}', random_limits(rng, model, elbow), request, model)
    while True:
        task = replace(task, limits=random_limits(rng, model, elbow))
        tips = _tips(rng, kind, task, int(rng.integers(3, 9)))
        found = None if tips is None else _finished(kind, task, tips)
        if found is not None:
            return found


def gravity_share(task: Task, tips: np.ndarray) -> float:
    """
    Return the largest part of an effort limit that gravity takes on a task's path.

    UnreachableError or LimitViolationError is raised where the arm cannot follow it.
    """
    path = task_path(task, tips)
    arm_path = followed(task, path)
    knots = np.concatenate((path.via_s, path.joins))
    q = arm_path(np.union1d(np.linspace(0.0, path.length, PLACES), knots)).q
    return float((np.abs(gravity_torque(task.model, q)) / task.limits.max_effort).max())


def followed(task: Task, path: CartesianPath) -> ArmPath:
    """Return a path as a task's arm follows it, checked against workspace and ranges."""
    first = inverse_kinematics(task.model, path.points[0], task.request.elbow or 'up')
    return check_workspace(task.model, task.limits, path, first)


def task_path(task: Task, tips: np.ndarray) -> CartesianPath:
    """Return the path that a task's planner follows through distinct points."""
    return largest_radii(FAMILIES[task.request.planner_id], tips, task.request.max_deviation)


def _between(rng: np.random.Generator, bounds: tuple[float, float]) -> float:
    """Return a number between two, their logarithms equally likely."""
    return float(np.exp(rng.uniform(*np.log(bounds))))


def _finished(kind: str, task: Task, tips: np.ndarray) -> Task | None:
    """Return the task through points, None where the arm cannot follow its path."""
    try:
        share = gravity_share(task, tips)
    except (UnreachableError, LimitViolationError, InvalidInputError):
        return None
    except ConvergenceError:  # ours to answer for
        share = 0.0
    if share > HELD:
        return None
    limits, request = task.limits, replace(task.request, via_points=tips)
    if kind == 'heavy' and share > 0.0:
        limits = replace(limits, max_effort=limits.max_effort * share / HELD)
    if kind == 'repeated point':
        request = replace(request, via_points=tips[np.sort(np.append(np.arange(len(tips)), 1))])
    if kind == 'start state':
        start = inverse_kinematics(task.model, tips[0], request.elbow)
        start = start + whole_turns(start[np.newaxis], limits)
        request = replace(request, start=start, via_points=tips[1:])
    return replace(task, limits=limits, request=request)


def _tips(rng: np.random.Generator, kind: str, task: Task, n: int) -> np.ndarray | None:
    """Return points that straight lines within the limits connect, None where none are found."""
    model, limits, request = task.model, task.limits, task.request
    try:
        first = random_pose(rng, model, limits, request.elbow, HELD * limits.max_effort)
    except LookupError:
        return None
    tips = [forward_kinematics(model, first)]
    special = int(rng.integers(2, n))
    for k in range(1, n):
        for _ in range(DRAWS):
            tip = _next_tip(rng, kind if k == special else 'small' if kind == 'small' else 'plain',
                            task, tips)
            if _is_free(task, tips[-1], tip):
                tips.append(tip)
                break
        else:
            return None
    return np.array(tips)


def _shell(chain: Chain) -> tuple[np.ndarray, float, float]:
    """Return the shoulder of an arm of the thesis's kind, and what the tip reaches from there."""
    upper = float(np.linalg.norm(chain.point[2] - chain.point[1]))
    fore = float(np.linalg.norm(chain.tip - chain.point[2]))
    return chain.point[1], abs(upper - fore), upper + fore


def _next_tip(rng: np.random.Generator, kind: str, task: Task,
              tips: list[np.ndarray]) -> np.ndarray:
    """Return a point at a random distance and in a random direction, or as its kind asks."""
    shoulder, least, most = _shell(task.model.chain)
    u = _unit(rng.normal(size=3))
    length = most * _between(rng, SMALL if kind == 'small' else LEGS)
    if kind == 'close pair':
        length = CLOSE
    elif kind == 'collinear':
        u = _unit(tips[-1] - tips[-2])
    elif kind == 'sharp corner':
        before, turn = _unit(tips[-1] - tips[-2]), rng.uniform(*SHARP)
        u = np.cos(turn) * before + np.sin(turn) * _unit(u - (u @ before) * before)
    elif kind == 'near an edge':
        margin = most * _between(rng, EDGE)
        W = most - margin if rng.random() < 0.7 else least + margin
        return shoulder + W * _unit(tips[-1] + length * u - shoulder)
    return tips[-1] + length * u


def _unit(v: np.ndarray) -> np.ndarray:
    return v / np.linalg.norm(v)


def _is_free(task: Task, a: np.ndarray, b: np.ndarray) -> bool:
    """Return whether the arm can be held, within its ranges, on a straight line."""
    p = np.linspace(a, b, CHECKS)
    try:
        q = np.array([inverse_kinematics(task.model, x, task.request.elbow or 'up') for x in p])
        outside = out_of_range(q + whole_turns(q, task.limits), task.limits).any()
    except (UnreachableError, LimitViolationError):
        return False
    return not outside and bool(
        (np.abs(gravity_torque(task.model, q)) <= HELD * task.limits.max_effort).all())
