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

"""Masses and inertias of a URDF's links: impossible ones are named, negative ones are zero."""

from __future__ import annotations

from helpers.urdf_texts import arm, BODY, inertial, link, texts
import numpy as np
import pytest
from rrr_traj_planner.core.arm.urdf_arm import read_urdf
from rrr_traj_planner.core.arm.urdf_inertia import Body, composite_body


def read(body):
    """Return link b's mass and inertia, and the warnings."""
    found = read_urdf(arm(b=link('b', body)))
    return found.chain.mass[1], found.chain.inertia[1], texts(found)


@pytest.mark.parametrize('moments', [
    (0.1, 0.0, 0.0, 0.1, 0.0, 0.2),   # a plate
    (0.1, 0.0, 0.0, 0.1, 0.0, 0.0),   # a thin rod
    (0.12, 0.0, 0.0, 0.1, 0.0, 0.222),  # rounded to two digits
    (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)])  # a point
def test_bodies_that_there_may_be_give_no_warning(moments):
    mass, inertia, warnings = read(inertial(2.0, moments))
    assert (mass, warnings) == (2.0, ())
    assert inertia == pytest.approx(np.diag([moments[0], moments[3], moments[5]]))


def test_a_broken_triangle_inequality_is_named():
    _, inertia, warnings = read(inertial(2.0, (0.1, 0.0, 0.0, 0.1, 0.0, 0.3)))
    assert inertia == pytest.approx(np.diag((0.1, 0.1, 0.3)))
    assert warnings == (
        "link 'b' has an impossible inertia: principal moments 0.1, 0.1, 0.3 kg m^2 break the "
        'triangle inequality; used as it is',)


def test_negative_principal_moments_become_zero():
    _, inertia, warnings = read(inertial(2.0, (0.1, 0.2, 0.0, 0.1, 0.0, 0.3)))
    assert warnings == (
        "link 'b' has an impossible inertia: principal moments -0.1, 0.3, 0.3 kg m^2 break the "
        'triangle inequality; negative moments are taken for 0',)
    assert np.linalg.eigvalsh(inertia) == pytest.approx((0.0, 0.3, 0.3), abs=1e-12)
    assert inertia[0, 1] == pytest.approx(0.15)


def test_a_negative_mass_becomes_zero():
    mass, _, warnings = read(inertial(-2.0, (0.0,) * 6))
    assert mass == 0.0
    assert warnings == ("link 'b' has a mass of -2 kg; taken for 0", "1 link without mass: 'b'")


def test_a_radius_of_gyration_beyond_the_arm_is_named():
    _, _, warnings = read(inertial(1e-4, (0.1, 0.0, 0.0, 0.1, 0.0, 0.1)))
    assert len(warnings) == 1
    assert warnings[0].startswith(
        "link 'b' has an impossible inertia: a radius of gyration of 31.6 m, in an arm of 1.1")


def test_inertia_without_mass_is_named():
    _, inertia, warnings = read(inertial(0.0))
    assert inertia == pytest.approx(0.1 * np.eye(3))
    assert warnings == ("link 'b' has an impossible inertia: principal moments 0.1, 0.1, 0.1 "
                        'kg m^2 without mass; used as it is',)


def test_links_that_do_not_move_with_the_arm_are_not_judged():
    assert read_urdf(arm(base=link('base', inertial(-1.0)))).warnings == ()


def test_two_point_masses_are_a_dumb_bell():
    ends = [Body(m, np.array((x, 0.0, 0.0)), np.zeros((3, 3)))
            for m, x in ((1.0, 0.0), (3.0, 4.0))]
    found = composite_body(ends, np.zeros(3))
    assert (found.mass, found.centre.tolist()) == (4.0, [3.0, 0.0, 0.0])
    assert found.inertia == pytest.approx(np.diag((0.0, 12.0, 12.0)))  # 1 * 9 + 3 * 1


def test_bodies_without_mass_are_where_it_is_said():
    at = np.array((1.0, 2.0, 3.0))
    found = composite_body([Body(0.0, np.zeros(3), np.eye(3))] * 2, at)
    assert (found.mass, found.centre.tolist()) == (0.0, at.tolist())
    assert found.inertia == pytest.approx(2.0 * np.eye(3))


def test_masses_of_all_links_may_be_missing():
    found = read_urdf(arm(a=link('a'), b=link('b'), c=link('c')))
    assert not found.has_masses
    assert texts(found) == ('no link has a mass',)
    assert read_urdf(arm(a=link('a'), b=link('b'), tip=link('tip', BODY), c=link('c'))).has_masses
