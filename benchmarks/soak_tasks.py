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

"""Hard random tasks that are feasible, each from a seed of its own."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from rrr_traj_planner.core.arm.lengths import ArmLengths
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.dynamics.rigid_body import gravity_torque
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.planners.request import PlanningRequest
from rrr_traj_planner.planners.tasks import JointTask
from scipy import ndimage
from tasks import ARM, is_usable, NONE, random_pose, Task

KINDS = ('plain', 'close pair', 'repeated point', 'at a limit', 'next to a limit',
         'joint at rest', 'heavy', 'reversal', 'many points', 'two points')
CLOSE = 1e-4       # rad between the points of a close pair
NEXT_TO = 1e-5     # rad from the end of a range
HEAVY = 0.99       # of an effort limit, at the heaviest via point
CELLS = 400        # of joint 2 and of joint 3, on which a way is looked for
HOLDING = 0.995    # of an effort limit, along such a way
LONG = (15, 41)


def soak_task(seed: int) -> Task:
    """Return the task of a seed; the seed's last digit is its kind."""
    rng = np.random.default_rng(seed)
    kind = KINDS[seed % len(KINDS)]
    model = ARM if rng.random() < 0.6 else random_arm(rng)
    elbow = 'up' if rng.random() < 0.5 else 'down'
    n = {'two points': 2, 'many points': int(rng.integers(*LONG))}.get(
        kind, int(rng.integers(3, 9)))
    period = float(rng.choice([0.005, 0.01, 0.01, 0.01, 0.02]))
    while True:
        limits = random_limits(rng, model, elbow)
        try:
            q = np.array([random_pose(rng, model, limits, elbow, limits.max_effort)
                          for _ in range(n)])
        except LookupError:  # limits that leave the arm nowhere to be
            continue
        _make_special(rng, kind, q, limits)
        if not all(is_usable(model, limits, p, elbow, limits.max_effort) for p in q):
            continue
        if kind == 'heavy':
            share = (np.abs(gravity_torque(model, q)) / limits.max_effort).max()
            if share > 0.0:
                limits = replace(limits, max_effort=limits.max_effort * share / HEAVY)
        task = Task(f'seed {seed}, {kind}', limits, PlanningRequest(
            forward_kinematics(model, q), elbow=elbow, sample_period=period), model)
        if has_way(task.joint_task()):
            return task


def has_way(task: JointTask) -> bool:
    """
    Return whether the motors can hold the arm all along some way through the via points.

    Gravity depends on joints 2 and 3 alone: a way exists where the cells of their plane that can
    be held connect the via points. It may then be run through as slowly as torque asks for.
    """
    if np.isinf(task.limits.max_effort).all():
        return True
    low, high = task.limits.min_position[1:], task.limits.max_position[1:]
    axes = [np.linspace(a, b, CELLS) for a, b in zip(low, high)]
    q = np.zeros((CELLS, CELLS, 3))
    q[..., 1], q[..., 2] = np.meshgrid(*axes, indexing='ij')
    torque = np.abs(gravity_torque(task.model, q))
    parts, _ = ndimage.label((torque <= HOLDING * task.limits.max_effort).all(axis=-1))
    cell = np.rint((task.points[:, 1:] - low) / (high - low) * (CELLS - 1)).astype(int)
    found = {_part_near(parts, *c) for c in cell}
    return len(found) == 1 and 0 not in found


def _part_near(parts: np.ndarray, i: int, j: int) -> int:
    """Return the part that a cell or a neighbour of it belongs to; 0: none."""
    return int(parts[max(i - 1, 0):i + 2, max(j - 1, 0):j + 2].max())


def random_arm(rng: np.random.Generator) -> RobotModel:
    """Return an arm with a geometry, masses and inertias of its own."""
    a2, d4 = rng.uniform(0.3, 1.2, 2)
    return RobotModel.from_lengths(ArmLengths(
        a2=a2, d4=d4, l2=rng.uniform(0.2, 0.8) * a2, l3=rng.uniform(0.2, 0.8) * d4,
        mass=rng.uniform(2.0, 40.0, 3), inertia=rng.uniform(0.02, 1.5, (3, 3))))


def random_limits(rng: np.random.Generator, model: RobotModel, elbow: str) -> JointLimits:
    """Return limits of which some are missing, but never acceleration and effort of one joint."""
    middle = rng.uniform([-1.0, 0.6, -0.3], [1.0, 1.6, 0.3])
    if elbow == 'down':
        middle[2] += np.pi
    half = rng.uniform([0.4, 0.4, 0.4], [1.6, 1.2, 1.2])
    low, high = middle - half, middle + half
    typical = np.abs(gravity_torque(model, rng.uniform(low, high, (200, 3)))).max(axis=0)
    effort = rng.uniform(1.05, 3.0, 3) * np.maximum(typical, 5.0)
    with_effort = rng.random() < 0.7

    def drawn(least: float, most: float) -> np.ndarray:
        return np.exp(rng.uniform(np.log(least), np.log(most), 3))

    return JointLimits(
        min_position=low, max_position=high, max_velocity=drawn(0.4, 3.0),
        max_acceleration=drawn(0.5, 8.0) if not with_effort or rng.random() < 0.5 else NONE,
        max_jerk=drawn(5.0, 200.0) if rng.random() < 0.7 else NONE,
        max_effort=effort if with_effort else NONE)


def _make_special(rng: np.random.Generator, kind: str, q: np.ndarray,
                  limits: JointLimits) -> None:
    """Change drawn poses, in place, to what their kind asks for."""
    k, j, end = int(rng.integers(1, len(q))), int(rng.integers(3)), int(rng.integers(2))
    low, high = limits.min_position, limits.max_position
    if kind == 'close pair':
        step = rng.normal(size=3)
        q[k] = np.clip(q[k - 1] + CLOSE * step / np.linalg.norm(step), low, high)
    elif kind == 'repeated point':
        q[k] = q[k - 1]
    elif kind in ('at a limit', 'next to a limit'):
        off = NEXT_TO if kind == 'next to a limit' else 0.0
        q[k, j] = (low[j] + off, high[j] - off)[end]
    elif kind == 'joint at rest':
        q[:, j] = q[0, j]
    elif kind == 'reversal':
        q[2] = q[0]
