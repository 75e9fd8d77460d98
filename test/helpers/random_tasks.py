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

"""Seeded random planning tasks that are feasible by construction."""

from __future__ import annotations

from dataclasses import dataclass, replace

from helpers.random_cases import random_model
from helpers.thesis_arm import ThesisArm
import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.dynamics.rigid_body import gravity_torque
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.planners.request import PlanningRequest

HOLDABLE = 0.999    # of an effort limit, largest holding torque at a via point
CLOSE = 1e-4        # rad between the points of a close pair
HEAVY = 0.99        # of an effort limit, largest holding torque of a heavy task

KINDS = ('plain', 'close pair', 'repeated point', 'joint at rest', 'reversal', 'at a limit',
         'heavy', 'start state')


@dataclass(frozen=True, eq=False)
class Task:
    """A request with the joint positions of its via points."""

    seed: int
    kind: str
    model: RobotModel
    limits: JointLimits
    q: np.ndarray
    request: PlanningRequest

    def request_to(self, planner_id, **changes):
        """Return the request with some fields changed, such as the planner."""
        return replace(self.request, planner_id=planner_id, **changes)


def random_task(seed):
    """Return a task of 2 to 8 points; the seed determines its kind."""
    rng = np.random.default_rng(50_000 + seed)
    kind = KINDS[seed % len(KINDS)]
    model = ThesisArm() if rng.random() < 0.6 else random_model(rng)
    limits = random_limits(rng, model)
    n = int(rng.choice(np.arange(2, 9), p=[0.28, 0.3, 0.2, 0.1, 0.04, 0.04, 0.04]))
    if kind in ('reversal', 'at a limit'):
        n = max(n, 3)
    while True:
        q = np.array([_holdable_position(rng, model, limits) for _ in range(n)])
        _make_special(rng, kind, q, limits)
        if all(_is_usable(model, limits, p) for p in q):
            break
    if kind == 'heavy':
        share = (np.abs(gravity_torque(model, q)) / limits.max_effort).max()
        if share > 0.0:
            limits = replace(limits, max_effort=limits.max_effort * share / HEAVY)
    tips = forward_kinematics(model, q)
    start = q[0] if kind == 'start state' else None
    request = PlanningRequest(
        tips if start is None else tips[1:], start=start, elbow='up', shoulder='front',
        sample_period=float(rng.choice([0.005, 0.01, 0.01, 0.01, 0.02, 0.05])))
    return Task(seed, kind, model, limits, q, request)


def random_limits(rng, model):
    """Return random limits; some lack velocity, jerk or effort limits."""
    middle = rng.uniform([-1.0, 0.3, -0.3], [1.0, 1.3, 0.3])
    half = rng.uniform([0.4, 0.4, 0.4], [2.0, 1.4, 1.2])
    low, high = middle - half, middle + half
    q = rng.uniform(low, high, (200, 3))
    typical = np.abs(gravity_torque(model, q)).max(axis=0)
    effort = rng.uniform(1.1, 5.0, 3) * np.maximum(typical, 5.0)

    def bound(least, most, share):
        value = np.exp(rng.uniform(np.log(least), np.log(most), 3))
        return np.where(rng.random(3) < share, value, np.inf) if rng.random() < 0.7 else value

    return JointLimits(
        min_position=low, max_position=high, max_velocity=bound(0.4, 3.0, 0.6),
        max_acceleration=np.exp(rng.uniform(np.log(0.5), np.log(6.0), 3)),
        max_jerk=bound(3.0, 200.0, 0.5),
        max_effort=np.where(rng.random(3) < 0.8, effort, np.inf))


def _is_usable(model, limits, q):
    """Return whether the elbow is up, the tip in front, and every motor can hold the pose."""
    reach = model.a2 * np.cos(q[1]) + model.d4 * np.sin(q[1] + q[2])
    held = (np.abs(gravity_torque(model, q)) <= HOLDABLE * limits.max_effort).all()
    return bool(abs(q[2]) < 1.55 and reach > 0.02 and held)


def _holdable_position(rng, model, limits):
    while True:
        q = rng.uniform(limits.min_position, limits.max_position)
        if _is_usable(model, limits, q):
            return q


def _make_special(rng, kind, q, limits):
    """Change random points in place, according to the kind of task."""
    k, j = int(rng.integers(1, len(q))), int(rng.integers(3))
    if kind == 'close pair':
        step = rng.normal(size=3)
        q[k] = np.clip(q[k - 1] + CLOSE * step / np.linalg.norm(step),
                       limits.min_position, limits.max_position)
    elif kind == 'repeated point':
        q[k] = q[k - 1]
    elif kind == 'joint at rest':
        q[:, j] = q[0, j]
    elif kind == 'reversal':
        q[2] = q[0]
    elif kind == 'at a limit':
        q[min(k, len(q) - 2), j] = (limits.min_position, limits.max_position)[k % 2][j]
