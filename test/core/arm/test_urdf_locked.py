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

"""Joints on side branches are locked, their links parts of one body; others are left out."""

from __future__ import annotations

from helpers.pinocchio_urdf import PinocchioUrdf
from helpers.urdf_texts import arm, axis, BODY, joint, limit, link, texts, Y
import numpy as np
import pytest
from rrr_traj_planner.core.arm.urdf_arm import read_urdf
from rrr_traj_planner.core.errors import InvalidInputError

ROUNDING = 1e-12


def chains_agree(a, b):
    for name in ('axis', 'point', 'tip', 'mass', 'centre', 'inertia'):
        assert getattr(a.chain, name) == pytest.approx(getattr(b.chain, name), abs=ROUNDING)


def with_part(parent, kind, inside='', xyz=(0.1, 0.2, 0.3)):
    """Return the arm with a further link on one of its links."""
    return arm(link('part', BODY), joint('hinge', kind, parent, 'part', inside, xyz))


def combined_as_in_pinocchio(found, locked=None):
    """Compare the three links' masses, centres and inertias with those of the reduced model."""
    model = PinocchioUrdf(found.text, found.joint_names, found.base, found.tip, locked)
    for i in range(3):
        body, at = model.model.inertias[i + 1], model.from_root * model.data.oMi[i + 1]
        R = at.rotation
        assert found.chain.mass[i] == pytest.approx(body.mass)
        assert found.chain.centre[i] == pytest.approx(at.act(body.lever), abs=ROUNDING)
        assert found.chain.inertia[i] == pytest.approx(R @ body.inertia @ R.T, abs=ROUNDING)


@pytest.mark.parametrize('parent', ['a', 'b', 'c', 'tip'])
@pytest.mark.parametrize('kind', ['fixed', 'revolute', 'continuous', 'prismatic', 'floating'])
def test_a_body_on_a_moving_link_is_a_part_of_it(parent, kind):
    found = read_urdf(with_part(parent, kind, '' if kind == 'floating' else Y), tip='tip')
    fixed = read_urdf(with_part(parent, 'fixed'), tip='tip')
    chains_agree(found, fixed)
    combined_as_in_pinocchio(fixed)
    assert sum(found.chain.mass) == 8.0
    unit = 'm' if kind == 'prismatic' else 'rad'
    assert texts(found) == (
        () if kind == 'fixed' else (f"joints on side branches are locked: 'hinge' at 0 {unit}",))


@pytest.mark.parametrize('kind', ['revolute', 'prismatic'])
@pytest.mark.parametrize(('low', 'high', 'at'), [(0.3, 0.7, 0.3), (-0.7, -0.3, -0.3)])
def test_a_joint_is_locked_at_the_end_of_its_range_that_is_nearest_to_zero(kind, low, high, at):
    found = read_urdf(with_part('c', kind, axis(1, 2, 3) + limit(low, high)), tip='tip')
    combined_as_in_pinocchio(found, {'hinge': at})
    assert f"'hinge' at {at:g} " in texts(found)[0]


def test_a_gripper_beyond_the_tip_is_a_part_of_link_3():
    fingers = [part for side in (-1, 1) for part in (
        link(f'finger {side}', BODY), joint(f'slide {side}', 'prismatic', 'palm', f'finger {side}',
                                            axis(0, side, 0) + limit(0.01, 0.04)))]
    found = read_urdf(arm(link('palm', BODY), joint('wrist', 'continuous', 'tip', 'palm'),
                          *fingers), tip='tip')
    combined_as_in_pinocchio(found, {'slide -1': 0.01, 'slide 1': 0.01})
    assert found.chain.mass.tolist() == [2.0, 2.0, 8.0]
    assert texts(found) == ("joints on side branches are locked: 'wrist' at 0 rad, 'slide -1' at "
                            "0.01 m, 'slide 1' at 0.01 m",)


def test_other_branches_are_left_out():
    legs = [part for i in range(3) for part in (
        link(f'leg {i}', BODY), joint(f'hip {i}', 'revolute', 'base', f'leg {i}', Y))]
    found = read_urdf(arm(*legs), tip='tip')
    chains_agree(found, read_urdf(arm()))
    combined_as_in_pinocchio(found)
    assert texts(found) == ()


def test_what_is_fixed_to_the_base_drops_out():
    chains_agree(read_urdf(with_part('base', 'fixed'), tip='tip'), read_urdf(arm()))


def mimicking(name, factor=1.0, offset=0.0):
    """Return an arm with a joint locked at 0.2 rad, and one that mimics another."""
    mimic = f'<mimic joint="{name}" multiplier="{factor}" offset="{offset}"/>'
    return arm(link('part', BODY), link('more', BODY),
               joint('hinge', 'continuous', 'c', 'part', axis(0, 0, 1) + mimic),
               joint('other', 'revolute', 'c', 'more', axis(0, 1, 0) + limit(0.2)))


def test_a_locked_joint_that_mimics_another_follows_it():
    found = read_urdf(mimicking('other', -2.0, 0.1), tip='tip')
    assert texts(found) == (
        "joints on side branches are locked: 'hinge' at -0.3 rad, 'other' at 0.2 rad",)
    combined_as_in_pinocchio(found, {'hinge': -0.3, 'other': 0.2})


@pytest.mark.parametrize('name', ['j2', 'no_such', 'hinge'])
def test_a_joint_that_mimics_one_that_is_not_locked_is_named(name):
    found = read_urdf(mimicking(name), tip='tip')
    assert texts(found)[0] == (
        f"joint 'hinge', on a side branch, mimics '{name}', which it does not follow here: the "
        'inertia is not exact')
    combined_as_in_pinocchio(found, {'other': 0.2})


def test_a_locked_joint_of_an_empty_range_is_refused():
    with pytest.raises(InvalidInputError, match=r"joint 'hinge': lower is 1, must not be above "
                                                'upper, -1'):
        read_urdf(with_part('c', 'prismatic', limit(1, -1)), tip='tip')


def test_a_locked_joint_without_an_axis_is_refused_unless_it_is_at_zero():
    with pytest.raises(InvalidInputError, match="joint 'hinge': its axis is zero"):
        read_urdf(with_part('c', 'revolute', axis(0, 0, 0) + limit(0.1, 1)), tip='tip')
    found = read_urdf(with_part('c', 'revolute', axis(0, 0, 0) + limit()), tip='tip')
    assert np.isclose(found.chain.mass[2], 4.0)
