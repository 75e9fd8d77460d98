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

"""Limits of a URDF's joints: placeholders are none, and are named."""

from __future__ import annotations

from math import inf

from helpers.urdf_texts import arm, axis, joint, limit, texts
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.urdf_arm import read_urdf
from rrr_traj_planner.core.errors import InvalidInputError


def read(kind, inside):
    """Return limits of joint 2 and all warnings."""
    found = read_urdf(arm(j2=joint('j2', kind, 'a', 'b', axis(0, 1, 0) + inside)))
    JointLimits(found.min_position, found.max_position, found.max_velocity,
                max_effort=found.max_effort)  # does not refuse them
    return (found.min_position[1], found.max_position[1], found.max_velocity[1],
            found.max_effort[1]), texts(found)


def test_limits_that_bind_are_kept_without_a_word():
    assert read('revolute', limit(-1.5, 2.5, 999.0, 99999.0)) == ((-1.5, 2.5, 999.0, 99999.0), ())


@pytest.mark.parametrize(('inside', 'found', 'warning'), [
    (limit(0, 0), (-inf, inf, 3.0, 40.0),
     'is revolute and has the range [0, 0] rad, which is taken for none'),
    ('<limit velocity="3" effort="40"/>', (-inf, inf, 3.0, 40.0), 'is revolute and has no range'),
    (limit(velocity=0), (-2.0, 2.0, inf, 40.0), ': velocity 0 rad/s is taken for no limit'),
    (limit(velocity=1000), (-2.0, 2.0, inf, 40.0), ': velocity 1000 rad/s is taken for no limit'),
    (limit(effort=-1), (-2.0, 2.0, 3.0, inf), ': effort -1 N m is taken for no limit'),
    (limit(effort=1e5), (-2.0, 2.0, 3.0, inf), ': effort 100000 N m is taken for no limit'),
    ('<limit lower="-2" upper="2" velocity="3"/>', (-2.0, 2.0, 3.0, inf),
     'has no effort limit'),
    ('<limit lower="-2" upper="2" effort="40"/>', (-2.0, 2.0, inf, 40.0),
     'has no velocity limit'),
    (limit(upper=1.7e308), (-2.0, inf, 3.0, 40.0), ': upper 1.7e+308 rad is taken for no limit'),
    (limit(lower=-1e16), (-inf, 2.0, 3.0, 40.0), ': lower -1e+16 rad is taken for no limit')])
def test_what_stands_for_no_limit_is_none_and_named(inside, found, warning):
    assert read('revolute', inside) == (
        found, (f"joint 'j2'{' ' * (warning[0] != ':')}{warning}",))


def test_a_continuous_joint_has_no_range():
    assert read('continuous', limit(-1, 1)) == ((-inf, inf, 3.0, 40.0), ())
    assert read('continuous', '') == ((-inf, inf, inf, inf), (
        "joint 'j2' has no velocity limit", "joint 'j2' has no effort limit"))


@pytest.mark.parametrize('inside', ['', '<limit/>'])
def test_a_revolute_joint_without_limits_is_named_for_each(inside):
    assert read('revolute', inside) == ((-inf, inf, inf, inf), (
        "joint 'j2' is revolute and has no range", "joint 'j2' has no velocity limit",
        "joint 'j2' has no effort limit"))


def test_an_end_that_is_missing_beside_the_other_is_zero():
    only = '<limit {}="{}" velocity="3" effort="40"/>'
    assert read('revolute', only.format('upper', 2))[0][:2] == (0.0, 2.0)
    assert read('revolute', only.format('lower', -2))[0][:2] == (-2.0, 0.0)
    with pytest.raises(InvalidInputError, match='lower is 0 rad by default, must be below upper, '
                                                '-2 rad'):
        read('revolute', only.format('upper', -2))


def test_warnings_of_limits_say_which():
    found = read_urdf(arm(j2=joint('j2', 'revolute', 'a', 'b', axis(0, 1, 0) + limit(
        lower=-1e4, velocity=0, effort=1e6))), tip='tip')
    assert [warning[1:] for warning in found.warnings] == [
        ('j2', ('min_position',)), ('j2', ('max_velocity',)), ('j2', ('max_effort',))]
    assert [str(warning) for warning in found.warnings] == list(texts(found))


@pytest.mark.parametrize('ends', [(1.0, -1.0), (1.0, 1.0)])
def test_an_empty_range_is_refused(ends):
    with pytest.raises(InvalidInputError) as error:
        read('revolute', limit(*ends))
    assert str(error.value) == (
        f"joint 'j2': lower is 1 rad, must be below upper, {ends[1]:g} rad")
