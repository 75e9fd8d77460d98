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

"""Recording: what the reference reader makes of a bag is what was sent."""

from __future__ import annotations

from pathlib import Path as File
import sys
from threading import Event

from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from geometry_msgs.msg import PoseStamped
from helpers.bag_reading import messages_by_topic, plain, summary
from mcap_ros2._dynamic import generate_dynamic
from nav_msgs.msg import Path
import numpy as np
import pytest
from rclpy.serialization import deserialize_message, serialize_message
from rosgraph_msgs.msg import Clock
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.kinematics.link_positions import link_positions
from rrr_traj_planner.nodes.output.marker_messages import arm_markers
from rrr_traj_planner.nodes.process.entry import StartError
from rrr_traj_planner.nodes.recording.bag import Bag, NO_MCAP
from rrr_traj_planner.nodes.recording.message_definitions import definition
from rrr_traj_planner.nodes.recording.recorder import LATCHED as LATCHED_QOS
from rrr_traj_planner.nodes.recording.recorder import Recorder, type_name
from rrr_traj_planner.nodes.recording.recorder import VOLATILE as VOLATILE_QOS
from rrr_traj_planner.nodes.runs.recording import LATCHED, VOLATILE
from sensor_msgs.msg import JointState
from std_msgs.msg import Header, String
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint
from visualization_msgs.msg import MarkerArray
import yaml

DEADLINE = 20.0  # s
TYPES = sorted({kind for kind, _ in (*VOLATILE, *LATCHED)}, key=type_name)

RNG = np.random.default_rng(1)
HEADER = Header(stamp=Time(sec=12, nanosec=999_999_999), frame_id='bäse')


def numbers(count=3):
    return RNG.normal(size=count).tolist()


def trajectory(count):
    message = JointTrajectory(header=HEADER, joint_names=['a', 'b', 'c'], points=[
        JointTrajectoryPoint(positions=numbers(), velocities=numbers(), effort=numbers(i % 3))
        for i in range(count)])
    for i, point in enumerate(message.points):
        point.time_from_start.sec, point.time_from_start.nanosec = i, 5 * i
    return message


def path(count):
    message = Path(header=HEADER, poses=[PoseStamped(header=HEADER) for _ in range(count)])
    for pose in message.poses:
        pose.pose.position.x, pose.pose.orientation.w = numbers(2)
    return message


SAMPLES = {
    JointState: [JointState(), JointState(header=HEADER, name=['one', 'twelve', ''],
                                          position=numbers(), effort=numbers(2))],
    JointTrajectory: [trajectory(0), trajectory(1), trajectory(7)],
    Path: [path(0), path(5)],
    MarkerArray: [arm_markers(RobotModel(), 'odd', link_positions(RobotModel(), q), [tuple(q)] * n)
                  for n, q in ((0, numbers()), (3, numbers()))],
    String: [String(), String(data='<robot name="ä"/>' * 1000)],
    Clock: [Clock(clock=Time(sec=7, nanosec=1))],
    DiagnosticArray: [DiagnosticArray(header=HEADER, status=[DiagnosticStatus(
        level=DiagnosticStatus.WARN, name='x', values=[KeyValue(key='k', value='v')] * 2)])]}


def test_samples_are_of_every_type_that_is_recorded():
    assert set(SAMPLES) == set(TYPES)


@pytest.mark.parametrize('kind', TYPES, ids=type_name)
def test_definition_has_the_type_s_own_fields_and_reads_its_messages(kind):
    decoders = generate_dynamic(type_name(kind), definition(type_name(kind)))
    for sample in SAMPLES[kind]:
        data = serialize_message(sample)
        decoded = decoders[type_name(kind)](data)
        assert plain(decoded) == plain(deserialize_message(data, kind))


def test_definition_names_each_inner_type_once_after_its_user():
    text = definition('trajectory_msgs/msg/JointTrajectory')
    sections = text.split('=' * 80 + '\nMSG: ')
    assert [s.split('\n')[0] for s in sections[1:]] == [
        'std_msgs/Header', 'trajectory_msgs/JointTrajectoryPoint', 'builtin_interfaces/Time',
        'builtin_interfaces/Duration']


def recorded(ros, file, topic, kind, qos, samples):
    """Record samples, and return how the bag was left."""
    arrived = Event()
    with Bag(file) as bag:
        recorder = Recorder(ros.node, bag, *(
            [(kind, topic)] if qos is wanted else [] for wanted in (VOLATILE_QOS, LATCHED_QOS)))
        write = bag.write

        def noted(*arguments):
            write(*arguments)
            if bag.count == len(samples):
                arrived.set()

        bag.write = noted
        publisher = ros.publisher(kind, topic, qos)
        for sample in samples:
            publisher.publish(sample)
        assert arrived.wait(DEADLINE)
        assert recorder.is_connected()
        return bag


@pytest.mark.parametrize('kind', TYPES, ids=type_name)
def test_reference_reader_reads_what_was_sent(ros, tmp_path, kind):
    file, samples = tmp_path / 'new folder' / 'bag.mcap', SAMPLES[kind]
    recorded(ros, file, 'here', kind, VOLATILE_QOS, samples)
    (topic, found), = messages_by_topic(file).items()
    assert topic == '/here'
    expected = [plain(deserialize_message(serialize_message(s), kind)) for s in samples]
    assert [plain(message) for _, message in found] == expected
    assert [r.sequence for r, _ in found] == list(range(1, len(samples) + 1))
    assert all(0 <= r.log_time - r.publish_time < DEADLINE * 1e9 for r, _ in found)
    # Byte for byte, once more by ROS itself.
    assert [deserialize_message(r.data, kind) for r, _ in found] == [
        deserialize_message(serialize_message(s), kind) for s in samples]


@pytest.mark.parametrize(('qos', 'durability'), [
    (VOLATILE_QOS, 'volatile'), (LATCHED_QOS, 'transient_local')])
def test_bag_contains_profile_types_and_quality_of_service(ros, tmp_path, qos, durability):
    file = tmp_path / 'bag.mcap'
    bag = recorded(ros, file, 'here', String, qos, [String(data='x')] * 3)
    assert (bag.count, bag.file) == (3, file)
    header, found = summary(file)
    assert header.profile == 'ros2'
    assert found.statistics.message_count == 3
    channel, = found.channels.values()
    assert channel.message_encoding == 'cdr'
    schema = found.schemas[channel.schema_id]
    assert (schema.name, schema.encoding) == ('std_msgs/msg/String', 'ros2msg')
    offered, = yaml.safe_load(channel.metadata['offered_qos_profiles'])
    assert (offered['reliability'], offered['durability']) == ('reliable', durability)
    assert offered['deadline'] == {'sec': 9223372036, 'nsec': 854775807}  # none
    assert offered['avoid_ros_namespace_conventions'] is False


def test_bag_without_messages_is_a_bag(tmp_path):
    with Bag(tmp_path / 'bag.mcap'):
        pass
    assert summary(tmp_path / 'bag.mcap')[1].statistics.message_count == 0


def test_nothing_is_written_after_the_end(tmp_path):
    with Bag(tmp_path / 'bag.mcap') as bag:
        bag.add_topic('/here', 'std_msgs/msg/String', definition('std_msgs/msg/String'), '')
    bag.write('/here', serialize_message(String()), 1, 1)
    assert bag.count == 0


def test_missing_package_is_reported_with_what_to_do(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, 'mcap.writer', None)
    with pytest.raises(StartError) as caught:
        Bag(tmp_path / 'bag.mcap')
    assert str(caught.value) == NO_MCAP
    assert not list(tmp_path.iterdir())


def test_file_that_cannot_be_written_is_reported(tmp_path):
    with pytest.raises(StartError, match=r'cannot write .*: Is a directory'):
        Bag(tmp_path)


def test_full_disk_ends_the_recording_alone(capsys):
    with Bag(File('/dev/full')) as bag:
        bag.add_topic('/here', 'std_msgs/msg/String', definition('std_msgs/msg/String'), '')
        for _ in range(40):  # more than a chunk, which random text keeps large
            noise = RNG.integers(33, 126, 100_000).astype(np.uint8).tobytes().decode()
            bag.write('/here', serialize_message(String(data=noise)), 1, 1)
    assert bag.count < 40
    assert capsys.readouterr().err == '/dev/full is incomplete: No space left on device\n'
