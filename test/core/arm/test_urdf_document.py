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

"""The text of a URDF: every fault is named by line, link or joint."""

from __future__ import annotations

from helpers.urdf_texts import arm, axis, inertial, joint, limit, link, robot, texts
import numpy as np
import pytest
from rrr_traj_planner.core.arm.urdf_document import read_document
from rrr_traj_planner.core.errors import InvalidInputError


def refused(text):
    with pytest.raises(InvalidInputError) as error:
        read_document(text)
    return str(error.value)


def test_an_inertia_s_axes_are_turned_into_the_link_s():
    body = inertial(2.0, (1.0, 0.0, 0.0, 2.0, 0.0, 3.0), (0.1, 0.2, 0.3), (0.0, 0.0, np.pi / 2))
    part, = read_document(robot(link('a', body))).links
    assert part.inertia == pytest.approx(np.diag((2.0, 1.0, 3.0)))
    assert (part.mass, part.centre.tolist()) == (2.0, [0.1, 0.2, 0.3])


def test_roll_pitch_and_yaw_are_about_fixed_axes_one_after_the_other():
    # roll takes y to z, pitch leaves y, yaw takes x to y
    found = read_document(robot(link('a'), link('b'), joint(
        'j', 'fixed', 'a', 'b', '', (1, 2, 3), (np.pi / 2, 0.0, np.pi / 2)))).joints[0].pose
    assert found == pytest.approx(np.array(
        ((0.0, 0.0, 1.0, 1.0), (1.0, 0.0, 0.0, 2.0), (0.0, 1.0, 0.0, 3.0), (0, 0, 0, 1))))


def test_what_may_be_missing_has_the_specification_s_default():
    bare = ('<joint name="j" type="continuous"><parent link="a"/><child link="b"/>'
            '<mimic joint="k"/><dynamics/><limit/></joint>')
    found, = read_document(robot(link('a'), link('b'), bare)).joints
    assert found.axis.tolist() == [1.0, 0.0, 0.0]
    assert found.pose.tolist() == np.eye(4).tolist()
    assert found.mimic == ('k', 1.0, 0.0)
    assert found[6:12] == (None, None, None, None, 0.0, 0.0)


def test_a_mass_without_inertia_is_a_point_mass():
    part, = read_document(robot(link('a', '<inertial><mass value="3"/></inertial>'))).links
    assert part.mass == 3.0
    assert not part.inertia.any()


@pytest.mark.parametrize(('text', 'message'), [
    ('\n\n<robot name="r">\n<link name="a">\n</robot>',
     'line 5, column 2: not well-formed XML, mismatched tag'),
    ('<robot', 'line 1, column 0: not well-formed XML, unclosed token'),
    ('<robot name="\ud800"/>', "not well-formed XML, 'utf-8' codec can't encode character"),
    ('<robot name="r"><xacro:macro/></robot>',
     'line 1, column 16: not well-formed XML, unbound prefix'),
    ('<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:macro/></robot>',
     'this is a xacro file, must be expanded: xacro FILE > FILE.urdf'),
    ('<sdf version="1.6"/>', 'the root element is <sdf>, must be <robot>'),
    ('<robot/>', 'the robot: <robot> has no name'),
    ('<robot name="r" version="2.0"/>', 'no URDF: Invalid version; only 1.0 is supported'),
    (robot('<link/>'), "link '': <link> has no name"),
    (robot('<joint name="j" type="fixed"><parent link="a"/></joint>'),
     "joint 'j': <joint> has no child"),
    (robot('<joint name="j" type="fixed"><parent/><child link="a"/></joint>'),
     "joint 'j': <parent> has no link"),
    (robot(joint('j', 'revolved', 'a', 'b')),
     "joint 'j' is of type 'revolved', must be revolute, continuous, prismatic, fixed, floating "
     'or planar'),
    (robot(joint('j', 'revolute', 'a', 'b', '<axis/>')), "joint 'j': <axis> has no xyz"),
    (robot(joint('j', 'revolute', 'a', 'b', axis(0, 0))),
     "joint 'j': xyz of <axis> is '0.0 0.0', must be 3 finite numbers"),
    (robot(joint('j', 'revolute', 'a', 'b', limit(effort='strong'))),
     "joint 'j': effort of <limit> is 'strong', must be a finite number"),
    (robot(joint('j', 'revolute', 'a', 'b', limit(upper='nan'))),
     "joint 'j': upper of <limit> is 'nan', must be a finite number"),
    (robot(joint('j', 'revolute', 'a', 'b', limit(velocity=''))),
     "joint 'j': velocity of <limit> is '', must be a finite number"),
    (robot(joint('j', 'fixed', 'a', 'b', '', (1, np.inf, 0))),
     "joint 'j': xyz of <origin> is '1.0 inf 0.0', must be 3 finite numbers"),
    (robot(link('a', inertial('1e400'))),
     "link 'a': value of <mass> is '1e400', must be a finite number"),
    (robot(link('a', inertial('1_0'))),
     "link 'a': value of <mass> is '1_0', must be a finite number"),
    (robot(link('a', inertial('\u0663'))),
     "link 'a': value of <mass> is '\u0663', must be a finite number"),
    (robot(link('a', inertial('-1e200'))),
     "link 'a': value of <mass> is '-1e200', must be at most 1e+50"),
    (robot(link('a', '<inertial/>')), "link 'a': <inertial> has no mass"),
    (robot(link('a', '<inertial><mass value="1"/><inertia ixx="1"/></inertial>')),
     "link 'a': <inertia> has no ixy"),
    (robot(joint('j', 'fixed', 'a', 'b').replace('rpy', 'quat_xyzw')),
     "joint 'j': <origin> has quat_xyzw, must have rpy")])
def test_what_is_wrong_is_named(text, message):
    assert refused(text).startswith(message)


def test_of_an_element_that_repeats_the_first_counts():
    twice = joint('j', 'fixed', 'a', 'b', '<origin xyz="9 9 9"/>', (1, 2, 3))
    found = read_document(robot(link('a'), link('b'), twice))
    assert found.joints[0].pose[:3, 3].tolist() == [1.0, 2.0, 3.0]
    assert texts(found) == ("joint 'j': the first <origin> counts, it has more than one",)


def test_what_others_read_is_not_looked_at(capfd):
    found = read_document(arm('<transmission name="t"><type/></transmission>', '<!-- a -->',
                              a=link('a', '<visual><geometry/></visual><collision x="y"/>')))
    assert len(found.links) == 5
    assert capfd.readouterr() == ('', '')
