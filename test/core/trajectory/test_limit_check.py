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

"""The check of a motion's extremes against its limits."""

import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.trajectory.limit_check import violations
from rrr_traj_planner.core.trajectory.trajectory import Peaks

NAMES = ('base', 'shoulder', 'elbow')
LIMITS = JointLimits(
    min_position=(-1.0, -2.0, -3.0), max_position=(1.0, 2.0, 3.0), max_velocity=(1.0, 2.0, 3.0),
    max_acceleration=(4.0, 5.0, 6.0), max_jerk=(7.0, 8.0, 9.0), max_effort=(100.0, 200.0, 300.0))
AT_THE_LIMITS = {
    'velocity': (1.0, 2.0, 3.0), 'acceleration': (4.0, 5.0, 6.0), 'jerk': (7.0, 8.0, 9.0),
    'min_position': (-1.0, -2.0, -3.0), 'max_position': (1.0, 2.0, 3.0),
    'effort': (100.0, 200.0, 300.0)}


def check(limits=LIMITS, **changes):
    """Return violations of a motion that is at every limit but for changes."""
    extremes = {k: np.array(v) for k, v in {**AT_THE_LIMITS, **changes}.items()}
    effort = extremes.pop('effort')
    return violations(limits, Peaks(**extremes), effort)


def test_motion_exactly_at_every_limit_is_within_them():
    assert check() == []


@pytest.mark.parametrize(('name', 'values', 'text'), [
    ('velocity', (0.0, 2.1, 0.0), 'shoulder velocity reaches 2.1 rad/s, limit 2 rad/s'),
    ('acceleration', (4.5, 0.0, 0.0), 'base acceleration reaches 4.5 rad/s^2, limit 4 rad/s^2'),
    ('jerk', (0.0, 0.0, 123.456789), 'elbow jerk reaches 123.457 rad/s^3, limit 9 rad/s^3'),
    ('effort', (0.0, 218.9, 0.0), 'shoulder effort reaches 218.9 N m, limit 200 N m'),
    ('min_position', (0.0, 0.0, -3.25), 'elbow position reaches -3.25 rad, limit -3 rad'),
    ('max_position', (1.5, 0.0, 0.0), 'base position reaches 1.5 rad, limit 1 rad')])
def test_violation_tells_joint_quantity_value_limit_and_unit(name, values, text):
    found = check(**{name: values})
    assert [violation.text(NAMES) for violation in found] == [text]


def test_violation_holds_value_and_limit():
    violation, = check(jerk=(0.0, 8.5, 0.0))
    assert violation == (1, 'jerk', 8.5, 8.0, 'rad/s^3')


def test_all_violations_are_reported():
    found = check(velocity=(9.0, 9.0, 9.0), effort=(999.0, 0.0, 0.0),
                  min_position=(-9.0, -9.0, 0.0), max_position=(9.0, 0.0, 0.0))
    assert [(v.joint, v.quantity, v.value) for v in found] == [
        (0, 'velocity', 9.0), (1, 'velocity', 9.0), (2, 'velocity', 9.0), (0, 'effort', 999.0),
        (0, 'position', -9.0), (1, 'position', -9.0), (0, 'position', 9.0)]


@pytest.mark.parametrize('name', ['velocity', 'acceleration', 'jerk', 'effort'])
def test_tolerance_for_rounding_is_a_millionth_of_the_limit(name):
    at_limit = np.array(AT_THE_LIMITS[name])
    assert check(**{name: at_limit * (1.0 + 0.9e-6)}) == []
    assert [v.joint for v in check(**{name: at_limit * (1.0 + 1.1e-6)})] == [0, 1, 2]


@pytest.mark.parametrize(('name', 'outward'), [('min_position', -1.0), ('max_position', 1.0)])
def test_tolerance_for_rounding_of_a_position_is_a_nanoradian(name, outward):
    at_limit = np.array(AT_THE_LIMITS[name])
    assert check(**{name: at_limit + outward * 0.9e-9}) == []
    assert [v.joint for v in check(**{name: at_limit + outward * 1.1e-9})] == [0, 1, 2]


def test_infinite_limits_are_never_broken():
    none = np.full(3, np.inf)
    assert check(JointLimits(-none, none, none, none, none, none),
                 velocity=none, effort=(1e300, 1e300, 1e300)) == []
