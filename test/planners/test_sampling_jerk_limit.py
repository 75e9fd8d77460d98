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

"""Limits on jerk where nothing else bounds it: from the samples that are to follow."""

from dataclasses import replace

from helpers.random_cases import random_model
import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.dynamics.rigid_body import inverse_dynamics
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.planners.sampling_jerk_limit import (
    acceleration_scale,
    limits_for_sampling,
)

NONE = np.full(3, np.inf)
PERIOD = 0.01


def random_poses(seed):
    rng = np.random.default_rng(seed)
    return random_model(rng), rng.uniform(-1.0, 1.0, (5, 3))


def bounded(model, limits, q):
    """Return limits whose jerk the sampling bounds."""
    return limits_for_sampling(limits, acceleration_scale(model, limits, q), PERIOD)


def test_a_jerk_limit_that_is_low_enough_stays():
    model, q = random_poses(0)
    limits = JointLimits(max_jerk=[10.0, 20.0, 30.0])
    jerk = bounded(model, limits, q).max_jerk
    assert jerk.tolist() == [10.0, 20.0, 30.0]


def test_a_ramp_from_one_limit_to_the_other_lasts_four_samples():
    # Half a cosine of 2 A in four periods: jerk pi A / (4 periods).
    model, q = random_poses(1)
    limits = JointLimits(max_acceleration=[1.0, 2.0, 3.0], max_jerk=NONE)
    found = bounded(model, replace(limits, max_effort=NONE), q).max_jerk
    assert found == pytest.approx(np.pi * np.array((1.0, 2.0, 3.0)) / (4.0 * PERIOD))


@pytest.mark.parametrize('seed', range(10))
def test_without_an_acceleration_limit_torque_decides_and_two_samples_are_enough(seed):
    model, q = random_poses(seed)
    limits = JointLimits(max_acceleration=NONE, max_jerk=NONE, max_effort=[90.0, 150.0, 70.0])
    scale = acceleration_scale(model, limits, q)
    assert bounded(model, limits, q).max_jerk == pytest.approx(
        np.pi * scale / (2.0 * PERIOD))
    # No joint that moves alone can be accelerated more, at any of the poses.
    for p in q:
        for j, a in enumerate(np.diag(scale)):
            for sign in (1.0, -1.0):
                torque = inverse_dynamics(model, p, np.zeros(3), sign * 1.001 * a)[j]
                gravity = inverse_dynamics(model, p, np.zeros(3), np.zeros(3))[j]
                against = np.sign(torque - gravity) * np.sign(gravity) >= 0.0
                assert abs(torque) > limits.max_effort[j] or not against


def test_all_limits_but_jerk_stay():
    model, q = random_poses(2)
    limits = JointLimits(max_jerk=NONE)
    found = bounded(model, limits, q)
    for name in ('min_position', 'max_position', 'max_velocity', 'max_acceleration', 'max_effort'):
        assert getattr(found, name).tolist() == getattr(limits, name).tolist()
    assert np.isfinite(found.max_jerk).all()


def test_a_joint_without_acceleration_and_effort_limit_is_refused_by_name():
    limits = JointLimits(max_acceleration=[1.0, np.inf, 1.0], max_effort=[9.0, np.inf, 9.0])
    with pytest.raises(InvalidInputError, match='needs an acceleration or an effort limit on '
                                                'every joint, joint_2 has neither$'):
        bounded(RobotModel(), limits, np.zeros((1, 3)))
