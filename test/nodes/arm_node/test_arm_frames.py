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

"""The arm's frames on /tf and /tf_static: those of robot_description, where the arm is."""

from __future__ import annotations

from functools import reduce
from xml.etree import ElementTree

from helpers.arm_in_ros import ALL, Arm, rest_to_rest, SECOND, stamp
from helpers.urdf_texts import arm as urdf_arm
from helpers.urdf_texts import axis, joint, limit, link
import numpy as np
import pytest
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arm.urdf_arm import read_urdf
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.nodes.output.latched import LATCHED
from rrr_traj_planner.nodes.output.message_times import nanoseconds
from scipy.spatial.transform import Rotation
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage

HAND = urdf_arm(link('world'), link('finger'),
                joint('stand', 'fixed', 'world', 'base', '', (0.0, 0.0, 1.0)),
                joint('grip', 'prismatic', 'tip', 'finger', axis(1, 0, 0) + limit(0.01, 0.05)))
DOCUMENTS = {'of the parameters': ('', 'base_link', 'tip'), 'given': (HAND, 'base', 'tip')}


def links(text):
    return {x.get('name') for x in ElementTree.fromstring(text).iter('link')}


def matrix(transform):
    found, r, p = np.eye(4), transform.rotation, transform.translation
    found[:3, :3] = Rotation.from_quat((r.x, r.y, r.z, r.w)).as_matrix()
    found[:3, 3] = (p.x, p.y, p.z)
    return found


def pose(transforms, frame, above):
    """Return the pose of a frame in one above it, as a listener of TF composes it."""
    chain = []
    while frame != above:
        chain.insert(0, matrix(transforms[frame].transform))
        frame = transforms[frame].header.frame_id
    return reduce(np.matmul, chain, np.eye(4))


@pytest.mark.parametrize(('text', 'base', 'tip'), DOCUMENTS.values(), ids=DOCUMENTS)
def test_frames_are_those_of_the_published_document_where_the_arm_is(ros, text, base, tip):
    model = read_urdf(text, base, tip).model() if text else RobotModel()
    options = {'robot_description': text} if text else {}
    moving = ros.listen(TFMessage, '/tf', ALL)
    arm = Arm(ros, publish_tf=True, base_frame=base, tip_frame=tip, **options)
    fixed = ros.listen(TFMessage, '/tf_static', LATCHED).wait_for()  # a late listener gets it
    described = ros.listen(String, 'robot_description', LATCHED).wait_for()
    arm.send(rest_to_rest(arm.actual.wait_for().position + np.array((0.05, -0.04, 0.06)), 0.5),
             names=model.joint_names)
    since = arm.now() + SECOND // 4
    m = moving.wait_for(lambda m: nanoseconds(m.transforms[0].header.stamp) > since)
    transforms = {t.child_frame_id: t for t in (*fixed.transforms, *m.transforms)}
    root, = links(described.data) - transforms.keys()
    assert transforms.keys() | {root} == links(described.data)
    assert {t.child_frame_id for t in m.transforms} == set(
        ('a', 'b', 'c') if text else ('link_1', 'link_2', 'link_3'))
    now = {nanoseconds(t.header.stamp) for t in m.transforms}
    assert len(now) == 1
    state = arm.actual.wait_for(lambda s: stamp(s) in now)
    np.testing.assert_allclose(
        pose(transforms, tip, base)[:3, 3], forward_kinematics(model, state.position), atol=1e-12)
    if text:  # the gripper's joint is locked at the end of its range
        assert pose(transforms, 'finger', 'tip')[:3, 3].tolist() == [0.01, 0.0, 0.0]
        assert pose(transforms, 'base', 'world')[:3, 3].tolist() == [0.0, 0.0, 1.0]


def test_nobody_s_frames_are_published_unless_asked(ros):
    arm = Arm(ros)
    arm.actual.wait_for()
    assert ros.node.count_publishers('/tf') == ros.node.count_publishers('/tf_static') == 0
