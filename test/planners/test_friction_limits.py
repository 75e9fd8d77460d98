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

"""Plans of an arm with friction, and of one without masses: limits, paths, notes."""

from __future__ import annotations

from dataclasses import replace

from helpers.friction_arms import torques
from helpers.random_chains import random_arm
import numpy as np
import pytest
from rrr_traj_planner.core.arm.friction import Friction
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.dynamics.rigid_body import gravity_torque
from rrr_traj_planner.core.errors import InvalidInputError, LimitViolationError
from rrr_traj_planner.planners.effort_limits import torque_note
from rrr_traj_planner.planners.joint_timing.feasible_path import (
    gravity_ratio,
    statically_feasible_path,
)
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.posed_problem import planning_problem
from rrr_traj_planner.planners.registry import planner_ids
from rrr_traj_planner.planners.request import PlanningRequest
from rrr_traj_planner.planners.tasks import JointTask

PROMISED = 1e-6   # of an effort limit
POINTS = [(1.02, 0.59, 0.97), (0.46, 0.55, 1.44), (0.45, 0.38, 1.45)]
ARM = RobotModel(friction=Friction([25.0, 30.0, 15.0], [12.0, 15.0, 8.0]))
LIMITS = JointLimits(max_velocity=[2.0] * 3, max_acceleration=[8.0] * 3, max_jerk=[80.0] * 3,
                     max_effort=np.array([90.0, 240.0, 110.0]))


@pytest.mark.parametrize('planner_id', planner_ids())
def test_plans_keep_torque_with_friction_within_its_limits(planner_id):
    found = plan(ARM, LIMITS, PlanningRequest(POINTS, planner_id=planner_id))
    t = np.arange(0.0, found.trajectory.duration, 0.01 / 20)
    dense = np.abs(torques(ARM, *found.trajectory(t)[:3]))
    assert (dense <= LIMITS.max_effort * (1.0 + PROMISED)).all()
    assert (found.effort >= dense.max(axis=0) * (1.0 - PROMISED)).all()
    assert (found.effort <= LIMITS.max_effort * (1.0 + PROMISED)).all()
    sampled = np.stack([found.columns()[f'{name} effort [N m]'] for name in ARM.joint_names], 1)
    p = found.points
    np.testing.assert_allclose(sampled, torques(ARM, p.positions, p.velocities, p.accelerations),
                               atol=1e-6)


@pytest.mark.parametrize('planner_id', ['line_arc', 'line_polynomial', 'time_optimal'])
def test_limits_that_friction_takes_bind_in_the_optimum(planner_id):
    request = PlanningRequest(POINTS, planner_id=planner_id)
    slow, fast = (plan(model, LIMITS, request) for model in (ARM, RobotModel()))
    assert fast.trajectory.duration < slow.trajectory.duration < 3.0 * fast.trajectory.duration
    assert (slow.effort / LIMITS.max_effort).max() > 0.9


@pytest.mark.parametrize('planner_id', planner_ids())
def test_limit_below_friction_is_refused_by_name(planner_id):
    weak = replace(LIMITS, max_effort=np.array([11.5, 240.0, 110.0]))
    with pytest.raises(LimitViolationError, match='joint_1 has a Coulomb friction of 12 N m, '
                                                  'limit 11.5 N m'):
        plan(ARM, weak, PlanningRequest(POINTS, planner_id=planner_id))


def massless():
    chain = RobotModel().chain
    return RobotModel(replace(chain, mass=np.zeros(3), inertia=np.zeros((3, 3, 3))))


@pytest.mark.parametrize('planner_id', planner_ids())
def test_arm_without_masses_is_planned_for_without_torque(planner_id):
    arm = massless()
    request = PlanningRequest(POINTS, planner_id=planner_id)
    assert planning_problem(arm, LIMITS, request).note == (
        'torque is not checked: no link has a mass')
    found = plan(arm, LIMITS, request)
    assert (found.effort == 0.0).all()
    assert (found.peaks.velocity <= LIMITS.max_velocity * (1.0 + PROMISED)).all()


def test_arm_with_masses_or_rotors_has_no_note():
    assert torque_note(ARM, LIMITS) == ''
    assert torque_note(replace(massless(), rotor_inertia=np.ones(3)), LIMITS) == ''


def peak_torque_of(arm, found):
    t = np.linspace(0.0, found.trajectory.duration, 4001)
    return np.abs(torques(arm, *found.trajectory(t)[:3])).max(axis=0)


def with_light_link_3(where):
    """Return an arm whose link 3 has no inertia about joint axis 3: its matrix is singular."""
    chain = RobotModel().chain
    mass, centre, inertia = chain.mass.copy(), chain.centre.copy(), chain.inertia.copy()
    inertia[2] = 0.0
    centre[2] = chain.point[2] + 0.3 * chain.axis[2]
    mass[2] = {'massless': 0.0, 'on its axis': 3.0}[where]
    return RobotModel(replace(chain, mass=mass, centre=centre, inertia=inertia))


@pytest.mark.parametrize('where', ['massless', 'on its axis'])
@pytest.mark.parametrize('planner_id', planner_ids())
def test_arm_with_a_link_without_inertia_keeps_its_torque_limits(planner_id, where):
    arm = with_light_link_3(where)
    assert arm.singular_inertia_reason
    found = plan(arm, LIMITS, PlanningRequest(POINTS, planner_id=planner_id))
    assert 'not checked' not in found.note
    peak = peak_torque_of(arm, found)
    assert (peak <= LIMITS.max_effort * (1.0 + PROMISED)).all()
    below = replace(LIMITS, max_effort=(0.7 * peak[0], *LIMITS.max_effort[1:]))
    slower = plan(arm, below, PlanningRequest(POINTS, planner_id=planner_id))
    assert slower.trajectory.duration > found.trajectory.duration
    assert (peak_torque_of(arm, slower) <= below.max_effort * (1.0 + PROMISED)).all()


def test_joint_whose_effort_limit_bounds_no_acceleration_needs_a_limit_of_it():
    free = replace(LIMITS, max_acceleration=np.full(3, np.inf))
    for where in ('massless', 'on its axis'):
        with pytest.raises(InvalidInputError, match='joint_3 has an effort limit only, and no '
                                                    'inertia in some pose'):
            plan(with_light_link_3(where), free,
                 PlanningRequest(POINTS, planner_id='time_optimal'))


# Poses that can be held, where gravity depends on joint 1 too


def blocked_tasks(count=6):
    """Return tasks of legs that can hold both ends, but not the straight line between."""
    found, rng = [], np.random.default_rng(5)
    for seed in range(400):
        arm = random_arm(seed % 20)
        ends = rng.uniform(-2.5, 2.5, (2, 3))
        holding = np.abs(gravity_torque(arm, ends)).max(axis=0)
        limits = JointLimits([-3.0] * 3, [3.0] * 3, max_effort=1.3 * holding + 3.0)
        straight = gravity_ratio(arm, limits, np.linspace(*ends, 200)).max()
        if straight > 1.1 and len(found) < count:
            found.append(JointTask(arm, limits, ends, None, 0.01))
    return found


def test_paths_that_can_be_held_are_found_where_gravity_depends_on_every_joint():
    paths = 0
    for task in blocked_tasks():
        assert task.model.tables.potential[1:].any()
        path = statically_feasible_path(task, *task.points, 8)
        if path is None:
            continue
        paths += 1
        assert (path[[0, -1]] == task.points).all()
        dense = np.concatenate(np.linspace(path[:-1], path[1:], 500, axis=1))
        assert gravity_ratio(task.model, task.limits, dense).max() < 1.0
    assert paths >= 3


def test_paths_are_found_between_infinite_ranges_too():
    for task in blocked_tasks(2):
        endless = replace(task, limits=replace(
            task.limits, min_position=np.full(3, -np.inf), max_position=np.full(3, np.inf)))
        path = statically_feasible_path(endless, *task.points, 8)
        bounded = statically_feasible_path(task, *task.points, 8)
        assert path is not None or bounded is None
