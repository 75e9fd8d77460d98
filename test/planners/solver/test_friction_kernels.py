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

"""Torque with viscous friction in the kernels: values and derivatives by differences."""

from __future__ import annotations

from helpers.friction_arms import with_friction
from helpers.random_cases import central_difference
from helpers.random_chains import random_arm
from helpers.spline_cases import LIMITS, random_motion
from helpers.timing_cases import BARRIER, path_problem
import numpy as np
import pytest
from rrr_traj_planner.core.dynamics.rigid_body import inverse_dynamics
from rrr_traj_planner.planners.joint_timing.constraints import JointConstraints
from rrr_traj_planner.planners.path_timing.constraints import limited_quantities, TORQUE, VELOCITY
from rrr_traj_planner.planners.solver.library import KERNELS
from rrr_traj_planner.planners.solver.limits import DurationConstraints

SEEDS = range(4)


def smooth_torque(arm, z):
    """Return torque without Coulomb friction at states (..., 12)."""
    q, qd, qdd, _ = np.split(z, 4, axis=-1)
    return inverse_dynamics(arm, q, qd, qdd) + arm.friction.viscous * qd


def linearised(seed):
    """Return an arm with friction, its limits on a motion, and the problem linearised there."""
    arm = with_friction(random_arm(seed), seed, viscous=50.0)
    mesh, points, m = random_motion(seed)
    zero = np.zeros((len(m.T), 2 * mesh.n + 1, 3))
    constraints = JointConstraints(
        arm, LIMITS, mesh, points, np.stack((zero, zero)), zero, zero, zero)
    problem = constraints.problem
    problem.begin(m, DurationConstraints.all_free(len(m.T), 3))
    problem.arrays['slack'][:] = problem.slacks(m)
    problem.arrays['dual'][:] = 1.0
    KERNELS.timing_linearise(problem.address, BARRIER)
    return arm, constraints, problem.arrays


@pytest.mark.parametrize('seed', SEEDS)
def test_joint_torques_and_their_gradients_contain_viscous_friction(seed):
    arm, _, arrays = linearised(seed)
    z = arrays['states'][:, 1:].copy()
    np.testing.assert_allclose(arrays['values'][:, 1:], smooth_torque(arm, z), rtol=1e-10,
                               atol=1e-9)
    expected = np.stack([central_difference(
        lambda x, unit=unit: smooth_torque(arm, z + x * unit), 0.0, 1e-3)
        for unit in np.eye(12)], axis=-1)
    np.testing.assert_allclose(arrays['jacobian'][:, 1:], expected, rtol=1e-6,
                               atol=1e-7 * np.abs(expected).max())


@pytest.mark.parametrize('seed', SEEDS)
def test_coulomb_friction_is_taken_off_both_limits(seed):
    arm, constraints, _ = linearised(seed)
    limits = constraints.problem.limits
    left = LIMITS.max_effort - arm.friction.coulomb
    np.testing.assert_allclose(limits.general_upper[:, 1:], np.broadcast_to(
        left, limits.general_upper[:, 1:].shape))
    assert (limits.general_lower == -limits.general_upper).all()


@pytest.mark.parametrize('seed', SEEDS)
def test_torque_along_a_path_has_viscous_friction(seed):
    (rubbing, m), (plain, _) = (path_problem(seed, rubbing) for rubbing in (True, False))
    z = rubbing.mesh.samples(rubbing.points, m, 8)[..., 0]
    (found, gravity), (without, same) = (
        limited_quantities(p, z, at_points=False) for p in (rubbing, plain))
    viscous = np.array([60.0, 90.0, 40.0])
    np.testing.assert_allclose(found[..., TORQUE], without[..., TORQUE]
                               + viscous * found[..., VELOCITY], rtol=1e-10, atol=1e-10)
    assert (gravity == same).all()
    assert np.abs(found - without)[..., TORQUE].max() > 1.0
