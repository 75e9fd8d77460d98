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

"""The computed-torque law: what it does to tracking errors, and where it saturates."""

from __future__ import annotations

from math import inf

import numpy as np
import pytest
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.control.computed_torque import (
    computed_torque,
    ControllerGains,
    saturated,
)
from rrr_traj_planner.core.dynamics.arm_dynamics import ArmDynamics
from rrr_traj_planner.core.dynamics.rigid_body import (
    forward_dynamics,
    gravity_torque,
    inverse_dynamics,
)
from rrr_traj_planner.core.errors import InvalidInputError

MODEL = RobotModel()
GAINS = ControllerGains(natural_frequency=20.0, damping_ratio=0.7)

# Torques of some 1e4 N m computed by two methods.
TORQUE_TOLERANCE = 1e-9


def law(state, desired):
    t = ArmDynamics(MODEL)(state)
    return np.array(computed_torque(t, GAINS.stiffness, GAINS.damping, state, desired))


def test_torque_at_rest_on_target_equals_gravity():
    q = (0.3, 0.8, -0.4)
    np.testing.assert_allclose(
        law((*q, 0.0, 0.0, 0.0), (*q, *np.zeros(6))), gravity_torque(MODEL, q), atol=1e-12)


def test_torque_without_error_is_the_motion_s_own():
    rng = np.random.default_rng(1)
    for _ in range(50):
        q, qd, qdd = rng.uniform(-2.0, 2.0, (3, 3))
        np.testing.assert_allclose(law((*q, *qd), (*q, *qd, *qdd)),
                                   inverse_dynamics(MODEL, q, qd, qdd), atol=TORQUE_TOLERANCE)


def test_errors_obey_a_second_order_equation():
    rng = np.random.default_rng(2)
    for _ in range(50):
        state, desired = rng.uniform(-2.0, 2.0, 6), rng.uniform(-2.0, 2.0, 9)
        qdd = forward_dynamics(MODEL, state[:3], state[3:], law(state, desired))
        e, ed = desired[:3] - state[:3], desired[3:6] - state[3:]
        edd = desired[6:] - qdd
        np.testing.assert_allclose(edd + 2.0 * 0.7 * 20.0 * ed + 20.0 ** 2 * e, 0.0, atol=1e-9)


def test_saturation_cuts_each_torque_to_its_limit():
    assert saturated((200.0, -300.0, 5.0), (150.0, 200.0, inf)) == (150.0, -200.0, 5.0)


def test_saturation_leaves_what_fits():
    assert saturated((150.0, -200.0, 1e9), (150.0, 200.0, inf)) == (150.0, -200.0, 1e9)


@pytest.mark.parametrize(('gains', 'text'), [
    ({'natural_frequency': 0.0}, r'natural_frequency is 0.0 rad/s, must be positive'),
    ({'natural_frequency': inf}, r'natural_frequency is inf rad/s'),
    ({'damping_ratio': -1.0}, r'damping_ratio is -1.0, must be positive')])
def test_gains_that_do_not_damp_are_refused(gains, text):
    with pytest.raises(InvalidInputError, match=text):
        ControllerGains(**gains)
