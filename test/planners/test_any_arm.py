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

"""Every planner in joint space on random chains with friction under tilted gravity."""

from __future__ import annotations

from dataclasses import replace

from helpers.friction_arms import torques, with_friction
from helpers.random_chains import random_arm
import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.dynamics.rigid_body import gravity_torque, inverse_dynamics
from rrr_traj_planner.core.errors import LimitViolationError
from rrr_traj_planner.planners.effort_limits import effort_less_friction
from rrr_traj_planner.planners.registry import planner, planner_ids
from rrr_traj_planner.planners.tasks import JointTask

IN_JOINT_SPACE = [p for p in planner_ids() if planner(p).plan is not None]
PERIOD = 0.01     # s
PER_SAMPLE = 20
PROMISED = 1e-6   # of an effort limit


def random_task(seed, segments=3):
    """Return a task whose limits of torque bind: they leave little beside gravity and friction."""
    arm, rng = with_friction(random_arm(seed), seed), np.random.default_rng(seed)
    points = rng.uniform(-1.5, 1.5, 3) + np.cumsum(rng.uniform(-0.8, 0.8, (segments + 1, 3)), 0)
    straight = np.concatenate([np.linspace(a, b, 50) for a, b in zip(points, points[1:])])
    static = np.abs(gravity_torque(arm, straight)).max(axis=0) + arm.friction.coulomb
    moving = np.abs(inverse_dynamics(arm, straight, np.ones(3), np.ones(3))).max(axis=0)
    limits = JointLimits(np.full(3, -6.0), np.full(3, 6.0), np.full(3, 2.0), np.full(3, 4.0),
                         np.full(3, 40.0), 1.1 * static + 0.2 * moving)
    return JointTask(arm, limits, points, None, PERIOD)


def densely(trajectory):
    """Return states at 20 points a sample."""
    return trajectory(np.arange(0.0, trajectory.duration, PERIOD / PER_SAMPLE))[:3]


@pytest.mark.parametrize('seed', range(4))
@pytest.mark.parametrize('planner_id', IN_JOINT_SPACE)
def test_torque_with_friction_is_within_its_limits_by_pinocchio(planner_id, seed):
    task = random_task(seed)
    trajectory = planner(planner_id).plan(task)
    ratio = np.abs(torques(task.model, *densely(trajectory))) / task.limits.max_effort
    assert ratio.max() <= 1.0 + PROMISED
    peaks = trajectory.peaks()
    assert (peaks.velocity <= task.limits.max_velocity * (1.0 + PROMISED)).all()
    assert (peaks.acceleration <= task.limits.max_acceleration * (1.0 + PROMISED)).all()


@pytest.mark.parametrize('planner_id', IN_JOINT_SPACE)
def test_friction_makes_a_motion_slower_and_not_much_slower_than_its_torque(planner_id):
    task = random_task(1)
    plain = replace(task, model=random_arm(1))
    slow, fast = (planner(planner_id).plan(t).duration for t in (task, plain))
    assert fast <= slow * (1.0 + 1e-3)
    assert slow < 5.0 * fast


def test_limit_that_friction_takes_whole_is_refused_by_name():
    task = random_task(0)
    weak = replace(task.limits, max_effort=np.append(task.limits.max_effort[:2], 0.1))
    with pytest.raises(LimitViolationError, match=r'joint_3 has a Coulomb friction of .* N m, '
                                                  r'limit 0.1 N m, which leaves no torque'):
        effort_less_friction(task.model, weak)
