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

"""`demo --record`: a bag of what went on, also where it ends early."""

from __future__ import annotations

import os
import signal
import warnings
from xml.etree import ElementTree

from helpers.bag_reading import messages_by_topic, plain, summary
from helpers.scripts import Script, script
import numpy as np
import pytest
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arm.urdf import urdf
from rrr_traj_planner.nodes.output.message_times import nanoseconds
from std_msgs.msg import String

NO_PLOT = ('--plot', '')
RUNNING = {'/joint_states', '/desired_joint_states', '/simulated_arm/tracking_error',
           '/simulated_arm/controller_state', '/diagnostics', '/tf'}
LATE = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
LATCHED = {'/planned_trajectory', '/planned_path', '/markers', '/robot_description', '/tf_static'}


def by_stamp(found):
    return {nanoseconds(m.header.stamp): m.position for _, m in found}


def test_bag_contains_what_was_planned_sent_and_executed(ros, tmp_path):
    with Script(script('demo'), '--record', 'demo.mcap', *NO_PLOT, cwd=tmp_path) as demo:
        demo.read_until('executing:')
        publisher = ros.publisher(String, '/odd/late', LATE)  # that the recorder has found
        while not demo.is_over_in(0.1):  # nothing is sent twice to who has not found it yet
            publisher.publish(String(data='late'))
        code, output, errors = demo.ended()
    assert code == 0, errors
    file = tmp_path / 'demo.mcap'
    found = messages_by_topic(file)
    assert set(found) - {'/parameter_events'} == RUNNING | LATCHED | {
        '/joint_trajectory', '/rosout', '/odd/late'}
    assert {m.data for _, m in found['/odd/late']} == {'late'}
    for name, text in (('trajectory_planner', 'cycloid planned 3 via points'),
                       ('simulated_arm', 'following 286 points')):
        assert any(text in m.msg for _, m in found['/rosout'] if m.name == name), text
    count = sum(map(len, found.values()))
    assert f'recording: demo.mcap, {count} messages\n' in output
    assert summary(file)[1].statistics.message_count == count
    (_, planned), = found['/planned_trajectory']
    (_, sent), = found['/joint_trajectory']
    assert plain(sent.points) == plain(planned.points)
    assert nanoseconds(planned.header.stamp) == 0 < nanoseconds(sent.header.stamp)
    (_, path), = found['/planned_path']
    assert len(path.poses) == len(planned.points)
    assert [m.data for _, m in found['/robot_description']] == [urdf(RobotModel(), JointLimits())]
    # What a viewer needs to draw the arm by its URDF: a transform to every link but the first.
    frames = {t.child_frame_id for topic in ('/tf', '/tf_static') for _, m in found[topic]
              for t in m.transforms}
    links = [link.get('name') for link in ElementTree.fromstring(
        found['/robot_description'][0][1].data).iter('link')]
    assert frames == set(links[1:])
    assert {m.ns for _, array in found['/markers'] for m in array.markers} == {
        'arm', 'executed_path', 'planned_path', 'via_points'}

    # The arm, over the whole motion: no state is missing, and their difference is the third.
    stamps = np.array([nanoseconds(m.header.stamp) for _, m in found['/joint_states']])
    end = nanoseconds(sent.header.stamp) + nanoseconds(sent.points[-1].time_from_start)
    assert stamps[0] < nanoseconds(sent.header.stamp) < end < stamps[-1]
    assert (np.diff(stamps) > 0).all()
    q, q_des, error = (by_stamp(found[topic]) for topic in (
        '/joint_states', '/desired_joint_states', '/simulated_arm/tracking_error'))
    common = sorted(set(q) & set(q_des) & set(error))
    assert len(common) > len(q) - 10  # the recording may begin and end between the three
    for stamp in common:
        np.testing.assert_array_equal(np.subtract(q_des[stamp], q[stamp]), error[stamp])
    np.testing.assert_allclose(q[common[-1]], planned.points[-1].positions, rtol=0.0, atol=1e-4)


def test_reader_s_one_call_reads_the_bag_of_a_refusal(tmp_path):
    with warnings.catch_warnings():  # it recommends the longer form, which the others use
        warnings.simplefilter('ignore', DeprecationWarning)
        from mcap_ros2.reader import read_ros2_messages
    (tmp_path / 'far.yaml').write_text('via_points: [[1.02, 0.59, 0.97], [3.0, 0.0, 0.5]]\n')
    with Script(script('demo'), 'far.yaml', '--record', 'far.mcap', cwd=tmp_path) as demo:
        code, _, errors = demo.ended()
    assert code == 1
    assert 'the planner refuses (-31)' in errors
    topics = {m.channel.topic for m in read_ros2_messages(tmp_path / 'far.mcap')}
    assert '/joint_states' in topics
    assert '/planned_trajectory' not in topics


def test_interrupted_demo_leaves_a_whole_bag(tmp_path):
    with Script(script('demo'), '--record', 'demo.mcap', cwd=tmp_path) as demo:
        demo.read_until('executing:')
        demo.process.send_signal(signal.SIGINT)
        code, _, errors = demo.ended()
    assert code == 0
    assert 'Traceback' not in errors
    assert {'/joint_trajectory', '/planned_path'} <= set(messages_by_topic(tmp_path / 'demo.mcap'))


@pytest.mark.parametrize(('arguments', 'text'), [
    (('--record', 'old.mcap'), 'demo: old.mcap exists already: choose another file, or remove it'),
    (('--record', 'there'), 'demo: cannot write there: Is a directory\n'),
    (('--record', 'demo.mcap'), 'demo: recording needs the Python package mcap: ')])
def test_impossible_recording_is_refused_before_anything_starts(
        tmp_path, monkeypatch, arguments, text):
    (tmp_path / 'there').mkdir()
    (tmp_path / 'old.mcap').write_text('kept')
    if 'mcap:' in text:
        (tmp_path / 'mcap.py').write_text('raise ImportError\n')
        monkeypatch.setenv('PYTHONPATH', f'{tmp_path}:{os.environ.get("PYTHONPATH", "")}')
    with Script(script('demo'), *arguments, cwd=tmp_path) as demo:
        code, output, errors = demo.ended()
    assert (code, output) == (1, '')
    assert errors.startswith(text)
    assert errors.count('\n') == 1
    assert not (tmp_path / 'demo.mcap').exists()
    assert (tmp_path / 'old.mcap').read_text() == 'kept'
