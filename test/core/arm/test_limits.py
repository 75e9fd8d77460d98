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

"""Joint limits: the thesis's values, infinite ones, scaling, and what is refused."""

import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.errors import InvalidInputError


def test_default_limits_are_the_thesis_s_with_joint_2_mirrored():
    limits = JointLimits()
    assert np.rad2deg(limits.min_position) == pytest.approx([0.0, 0.0, -180.0], abs=1e-12)
    assert np.rad2deg(limits.max_position) == pytest.approx([90.0, 180.0, 360.0], abs=1e-12)
    assert limits.max_velocity.tolist() == [1.0, 1.0, 1.0]
    assert limits.max_acceleration.tolist() == [1.0, 1.0, 1.0]
    assert limits.max_jerk.tolist() == [10.0, 10.0, 10.0]
    assert limits.max_effort.tolist() == [150.0, 200.0, 200.0]


def test_limits_cannot_be_changed():
    bounds = np.ones(3)
    limits = JointLimits(max_velocity=bounds)
    bounds[0] = 9.0
    assert limits.max_velocity.tolist() == [1.0, 1.0, 1.0]
    with pytest.raises(ValueError, match='read-only'):
        limits.max_velocity[0] = 5.0


def test_every_limit_may_be_infinite():
    none = np.full(3, np.inf)
    limits = JointLimits(-none, none, none, none, none, none)
    assert np.isinf(limits.min_position).all()
    assert np.isinf(limits.max_effort).all()


@pytest.mark.parametrize(('name', 'unit'), [
    ('max_velocity', 'rad/s'), ('max_acceleration', r'rad/s\^2'), ('max_jerk', r'rad/s\^3'),
    ('max_effort', 'N m')])
@pytest.mark.parametrize('bad', [0.0, -2.5])
def test_bound_that_is_not_positive_is_refused_with_its_unit(name, unit, bad):
    with pytest.raises(InvalidInputError,
                       match=rf'^{name} is \[1\.0, {bad}, 1\.0\] {unit}, must be positive$'):
        JointLimits(**{name: (1.0, bad, 1.0)})


@pytest.mark.parametrize(('low', 'high'), [(0.5, 0.5), (1.0, -1.0), (np.inf, np.inf)])
def test_empty_range_is_refused_with_both_ends(low, high):
    text = (rf'^min_position \[0\.0, {low}, 0\.0\] rad is not below '
            rf'max_position \[1\.0, {high}, 1\.0\] rad$')
    with pytest.raises(InvalidInputError, match=text):
        JointLimits(min_position=(0.0, low, 0.0), max_position=(1.0, high, 1.0))


def test_nan_and_wrong_shapes_are_refused_by_name():
    with pytest.raises(InvalidInputError, match=r'^max_jerk\[2\] is nan, must be a number$'):
        JointLimits(max_jerk=(1.0, 1.0, np.nan))
    with pytest.raises(InvalidInputError, match=r'^max_effort has shape \(2,\), must have \(3\)$'):
        JointLimits(max_effort=(1.0, 1.0))


def test_scaling_touches_velocity_and_acceleration_alone():
    limits = JointLimits(max_velocity=(1.0, 2.0, np.inf))
    scaled = limits.scaled(velocity=0.5, acceleration=0.25)
    assert scaled.max_velocity.tolist() == [0.5, 1.0, np.inf]
    assert scaled.max_acceleration.tolist() == [0.25, 0.25, 0.25]
    for name in ('min_position', 'max_position', 'max_jerk', 'max_effort'):
        assert getattr(scaled, name).tolist() == getattr(limits, name).tolist()
    assert limits.max_velocity.tolist() == [1.0, 2.0, np.inf]


def test_scaling_by_one_changes_nothing():
    assert JointLimits().scaled().max_velocity.tolist() == [1.0, 1.0, 1.0]


@pytest.mark.parametrize('factor', [0.0, -0.5, 1.0001, np.nan, np.inf])
@pytest.mark.parametrize('name', ['velocity', 'acceleration'])
def test_scaling_factor_outside_0_to_1_is_refused(name, factor):
    with pytest.raises(InvalidInputError, match=(
            rf'^{name} is {factor}, must be in \(0, 1\]$')):
        JointLimits().scaled(**{name: factor})


def test_a_motion_scaled_in_time_is_just_within_its_limits():
    rng = np.random.default_rng(3)
    for _ in range(50):
        limits = JointLimits(max_velocity=rng.uniform(0.5, 3.0, 3), max_jerk=rng.uniform(5, 50, 3),
                             max_acceleration=rng.choice([1.0, 4.0, np.inf], 3))
        v, a, j = rng.uniform(0.1, 10.0, (3, 20, 3)) * rng.choice([0.1, 1.0, 10.0], (3, 1, 1))
        z = limits.time_scale(v, a, j)
        used = np.array([(v / z / limits.max_velocity).max(),
                         (a / z ** 2 / limits.max_acceleration).max(),
                         (j / z ** 3 / limits.max_jerk).max()])
        assert used.max() == pytest.approx(1.0, rel=1e-12)
