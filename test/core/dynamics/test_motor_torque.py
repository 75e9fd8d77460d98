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

"""The motors' torques: friction by the direction of motion, which is one thing for all callers."""

from __future__ import annotations

from helpers.friction_arms import with_friction
from helpers.random_chains import random_arm
import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.dynamics.motor_torque import (
    AT_REST,
    direction_of,
    motor_torque,
    rest_speed_of,
    smooth_motor_torque,
)
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.trajectory.time_scaling import squared_time_scale

ARM = with_friction(random_arm(0), 0)
VELOCITIES = np.array([[0.0, 1e-13, -1e-13], [2.0, -1e-3, 1e-11], [-1e-13, 3e-12, 0.0]])
DIRECTIONS = np.array([[0.0, 0.0, 0.0], [1.0, -1.0, 1.0], [0.0, 1.0, 0.0]])


def states():
    rng = np.random.default_rng(1)
    return rng.uniform(-2.0, 2.0, (3, 3)), VELOCITIES, rng.normal(0.0, 3.0, (3, 3))


def test_up_to_the_rest_speed_a_joint_is_at_rest():
    assert rest_speed_of(VELOCITIES) == 2.0 * AT_REST
    assert rest_speed_of(np.zeros((0, 3))) == 0.0
    np.testing.assert_array_equal(direction_of(VELOCITIES, 2.0 * AT_REST), DIRECTIONS)
    np.testing.assert_array_equal(direction_of(VELOCITIES, 0.0), np.sign(VELOCITIES))


def test_coulomb_friction_goes_by_the_direction():
    speed = rest_speed_of(VELOCITIES)
    np.testing.assert_allclose(
        motor_torque(ARM, *states(), speed) - smooth_motor_torque(ARM, *states()),
        ARM.friction.coulomb * DIRECTIONS, atol=1e-12)
    np.testing.assert_allclose(
        motor_torque(ARM, *states()) - smooth_motor_torque(ARM, *states()),
        ARM.friction.coulomb * np.sign(VELOCITIES), atol=1e-12)


@pytest.mark.parametrize('rows', [[0], [2], [0, 2], [1, 2]])
def test_what_a_state_requires_does_not_depend_on_those_it_is_given_with(rows):
    speed = rest_speed_of(VELOCITIES)
    limits = JointLimits(max_effort=[60.0, 80.0, 40.0])
    some = [x[rows] for x in states()]
    for function in (lambda *state: motor_torque(ARM, *state, speed),
                     lambda *state: squared_time_scale(ARM, limits, *state, speed),
                     lambda q, qd, qdd: direction_of(qd, speed)):
        np.testing.assert_allclose(function(*some), function(*states())[rows], rtol=1e-12)


def test_a_negative_rest_speed_is_refused():
    with pytest.raises(InvalidInputError, match='^rest_speed is -1.0 rad/s, must not be negative'):
        motor_torque(ARM, *states(), -1.0)
