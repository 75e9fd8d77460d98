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

"""Points as people have them: messages, mappings and joint positions in YAML files."""

from __future__ import annotations

from math import pi

from geometry_msgs.msg import Point, PointStamped, Pose, PoseArray, PoseStamped
from nav_msgs.msg import Path
import numpy as np
import pytest
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.nodes.point_files.reading import read_task
from sensor_msgs.msg import JointState
import yaml

TIPS = [[1.02, 0.59, 0.97], [0.46, 0.55, 1.44]]
Q = [[0.5, 0.9, 0.2], [0.1, 1.2, -0.3]]
NAMES = ('shoulder', 'upper', 'elbow')
ECHO_END = '---\n'  # after every message that ros2 topic echo prints


@pytest.fixture
def read(tmp_path):
    """Return a function that reads a file of a given content."""
    def of(content, name='points.yaml', **options):
        file = tmp_path / name
        file.write_text(content)
        return read_task(str(file), **options)

    return of


def refusal(read, content, name='points.yaml'):
    """Return why a content is refused, without the file's path."""
    with pytest.raises(InvalidInputError) as caught:
        read(content, name)
    return str(caught.value).partition(f'{name}: ')[2]


def pose(x, y, z):
    return Pose(position=Point(x=x, y=y, z=z))


def framed(message, frame='camera'):
    message.header.frame_id, message.header.stamp.sec = frame, 1234
    return message


def plain(value):
    """Return a message as plain values."""
    if hasattr(value, 'get_fields_and_field_types'):
        return {name: plain(getattr(value, name)) for name in value.get_fields_and_field_types()}
    return list(map(plain, value)) if hasattr(value, '__iter__') and not isinstance(
        value, str) else value


def printed(message):
    """Return a message as rosidl_runtime_py and `ros2 topic echo` print it."""
    return yaml.safe_dump(plain(message), sort_keys=False)


def echoed(*messages):
    """Return what `ros2 topic echo` prints."""
    return ''.join(printed(message) + ECHO_END for message in messages)


def indented(text, by='  '):
    return ''.join(by + line + '\n' for line in text.splitlines())


MESSAGES = {
    'Pose': [pose(*p) for p in TIPS],
    'Point': [Point(x=x, y=y, z=z) for x, y, z in TIPS],
    'PoseStamped': [framed(PoseStamped(pose=pose(*p))) for p in TIPS],
    'PointStamped': [framed(PointStamped(point=Point(x=x, y=y, z=z))) for x, y, z in TIPS],
    'PoseArray': [framed(PoseArray(poses=[pose(*p) for p in TIPS]))],
    'Path': [framed(Path(poses=[framed(PoseStamped(pose=pose(*p))) for p in TIPS]))]}


@pytest.mark.parametrize('kind', MESSAGES)
def test_a_file_of_echoed_messages_is_read(read, kind):
    task = read(echoed(*MESSAGES[kind]))
    assert task.via_points.tolist() == TIPS
    assert task.frame == ('' if kind in ('Pose', 'Point') else 'camera')
    assert (task.arm.name, task.planner_id) == ('thesis_arm.yaml', '')


@pytest.mark.parametrize('kind', MESSAGES)
def test_messages_are_read_as_via_points(read, kind):
    messages = [printed(message) for message in MESSAGES[kind]]
    content = (f'via_points:\n{indented(messages[0])}' if len(messages) == 1 else
               'via_points:\n' + ''.join(
                   f'- {indented(message)[2:]}' for message in messages))
    task = read(f'planner_id: gauss\n{content}dwell: [0.5, 0]\n')
    assert task.via_points.tolist() == TIPS
    assert (task.planner_id, task.dwell.tolist()) == ('gauss', [0.5, 0.0])


def test_fields_of_the_file_may_follow_a_message(read):
    task = read(printed(MESSAGES['PoseArray'][0])
                + 'stop_at: [true, true]\narm: table_6_1.yaml\n')
    assert task.via_points.tolist() == TIPS
    assert task.stop_at.tolist() == [True, True]
    assert task.arm.name == 'table_6_1.yaml'


def test_fields_of_the_file_may_stand_in_a_document_of_their_own(read):
    task = read(echoed(*MESSAGES['PoseStamped']) + 'dwell: [0.5, 0]\nplanner_id: septic\n')
    assert task.via_points.tolist() == TIPS
    assert (task.planner_id, task.dwell.tolist()) == ('septic', [0.5, 0.0])


def test_a_point_may_take_over_parts_of_another(read):
    task = read('via_points:\n  - &low {x: 1.0, y: 0.5, z: 1.0}\n  - {<<: *low, z: 1.2}\n'
                '  - *low\n')
    assert task.via_points.tolist() == [[1.0, 0.5, 1.0], [1.0, 0.5, 1.2], [1.0, 0.5, 1.0]]


def test_lists_and_mappings_may_be_mixed(read):
    assert read('via_points:\n  - [1.02, 0.59, 0.97]\n  - {z: 1.44, x: 0.46, y: 0.55}\n'
                ).via_points.tolist() == TIPS
    assert read('via_points: {poses: [[1.02, 0.59, 0.97], [0.46, 0.55, 1.44]], '
                'header: {frame_id: map}}\n').frame == 'map'


def test_stops_and_dwells_are_read(read):
    task = read(f'via_points: {TIPS}\nstop_at: [false, true]\ndwell: [0.5, 1]\n')
    assert task.stop_at.tolist() == [False, True]
    assert task.dwell.tolist() == [0.5, 1.0]
    plain = read(f'via_points: {TIPS}\n')
    assert len(plain.stop_at) == len(plain.dwell) == 0


@pytest.mark.parametrize('content', [
    'joint_via_points:\n  - [0.5, 0.9, 0.2]\n  - [0.1, 1.2, -0.3]\n',
    'joint_via_points:\n  - {upper: 0.9, elbow: 0.2, shoulder: 0.5}\n'
    '  - {shoulder: 0.1, upper: 1.2, elbow: -0.3, gripper: 4}\n',
    'joint_via_points:\n' + ''.join(f'- {indented(printed(JointState(name=n, position=p)))[2:]}'
                                    for n, p in ((NAMES, Q[0]), (NAMES, Q[1]))),
    echoed(framed(JointState(name=NAMES[::-1], position=Q[0][::-1], velocity=[0.0] * 3)),
           framed(JointState(name=['gripper', *NAMES], position=[0.1, *Q[1]])))])
def test_joint_positions_are_read_in_the_arm_s_order(read, content):
    task = read(content)
    assert len(task.via_points) == 0
    assert task.joint_via_points(NAMES).tolist() == Q


@pytest.mark.parametrize('content', [
    'shoulder,upper,elbow\n0.5,0.9,0.2\n0.1,1.2,-0.3\n',
    't [s];elbow [rad];shoulder;upper;note\n0;0,2;0,5;0,9;home\n1;-0,3;0,1;1,2;\n',
    'time [s],shoulder position [rad],upper position [rad],elbow position [rad],shoulder '
    'velocity [rad/s]\n0.0,0.5,0.9,0.2,0.0\n0.1,0.1,1.2,-0.3,x\n'])
def test_joint_positions_are_read_from_a_table(read, content):
    assert read(content, 'points.csv').joint_via_points(NAMES).tolist() == Q


def test_units_of_a_table_s_header_are_converted(read):
    degrees = read('shoulder [deg],upper (°),elbow\n180,90,0.2\n', 'points.csv', started=True)
    assert degrees.joint_via_points(NAMES) == pytest.approx(np.array([[pi, pi / 2.0, 0.2]]))
    assert read('x [mm],y [cm],z [m],dwell [ms]\n1020,59,0.97,250\n', 'points.csv',
                started=True).via_points == pytest.approx(np.array([TIPS[0]]))


def test_stops_and_dwells_are_columns_of_a_table(read):
    task = read('x,y,z,stop_at,dwell [s]\n1,0,1,,\n1,0,1,true,0.5\n1,0,1,0,\n1,0,1\n',
                'points.csv')
    assert task.stop_at.tolist() == [False, True, False, True]  # the motion ends at the last
    assert task.dwell.tolist() == [0.0, 0.5, 0.0, 0.0]


@pytest.mark.parametrize(('content', 'text'), [
    ('via_points:\n  - [1, 2, 3]\n  - {x: 1.0, z: 2.0}\n',
     'line 3: via_points[1] has x, z, must have x, y and z: y is missing'),
    ('via_points:\n  - {x: 1.0, y: 1.0, w: 2.0, z: 1.0}\n', 'line 2: unknown w; known are '),
    ('via_points:\n  - position: {x: 1.0, y: 1.0, z: 1.0}\n    orientatoin: {}\n',
     'line 3: unknown orientatoin (did you mean "orientation"?); known are x, y, z, position'),
    ('via_points:\n  - position: {x: 1.0, y: .nan, z: 1.0}\n',
     'line 2: via_points[0].position.y is nan, must be finite'),
    ('via_points:\n  - position: [1.0, 2.0, 3.0]\n',
     'line 2: via_points[0].position is [1.0, 2.0, 3.0], must be a mapping with x, y and z'),
    ('via_points:\n  - position: {x: 1.0, y: 1.0, z: 1.0}\n    orientation: {x: a}\n',
     "line 3: via_points[0].orientation.x is 'a', must be a number"),
    ('via_points:\n  - {x: 1.0, y: 1.0, z: 1.0}\n  - {x: 1.0, y: 1.0,\n     z: 1.0, x: 2.0}\n',
     'line 4: x is repeated (first in line 3)'),
    ("via_points:\n  - [1, 2, 3]\n  - '...'\n", "line 3: via_points[1] is '...', must be three "
     'numbers, [x, y, z] in m, a mapping with x, y and z, or a Point, Pose or PoseStamped '
     'message: ros2 topic echo leaves out what is long, but for --full-length'),
    ('via_points: {header: {frame_id: map}, poses: 3}\n', 'line 1: via_points.poses is 3, must '),
    ('via_points: {header: 5, poses: []}\n', 'line 1: via_points.header is 5, must be a mapping'),
    ('header: {frame_id: map}\nposes: []\n', 'line 2: poses is empty, must have a pose'),
    (echoed(framed(PoseStamped(), 'map'), framed(PoseStamped(), 'odom')),
     "via point 1 is in frame 'odom', via point 0 in frame 'map': must be in one frame"),
    (echoed(Pose()) + 'planer_id: gauss\n', "line 11: a document is {'planer_id': 'gauss'}, mu"),
    (echoed(Pose()) + 'arm: a\n---\nstop_at: [true]\n',
     'line 13: a second document has stop_at, must be one with those of line 11'),
    (echoed(Pose(), JointState(name=['a'], position=[1.0])),
     'some messages have poses, others joint positions: must be of one kind'),
    (f'via_points: {TIPS}\njoint_via_points: {Q}\n',
     'line 2: via_points and joint_via_points are both given, must be one of the two'),
    ('joint_via_points:\n', 'line 1: no joint_via_points, the list is empty: must have'),
    ('joint_via_points: {a: 1}\n', "line 1: joint_via_points is {'a': 1}, must be a list"),
    ('joint_via_points:\n  - 3\n', 'line 2: joint_via_points[0] is 3, must be a list of joint '),
    ('joint_via_points:\n  - {a: 1, b: x}\n',
     "line 2: joint_via_points[0].b is 'x', must be a number"),
    ('joint_via_points:\n  - {name: [a, b], position: [1.0]}\n',
     'line 2: joint_via_points[0].name has 2 names for 1 position'),
    ('via_point: [[1, 2, 3]]\n', "no via_points, its fields are 'via_point': must have "
     'via_points: [[x, y, z], ...] in m, or joint_via_points in rad; did you '
     'mean "via_points" by "via_point"?'),
    (f'via_points: {TIPS}\nstop_at: true\n', 'line 2: stop_at is True, must be a list of '),
    (f'via_points: {TIPS}\nstop_at: [1, 0]\n', 'line 2: stop_at[0] is 1, must be true or false'),
    (f'via_points: {TIPS}\ndwell: [0.0,\n  x]\n', "line 3: dwell[1] is 'x', must be a number"),
    (f'via_points: {TIPS}\nstopp_at: [true]\n', 'line 2: unknown stopp_at (did you mean '
     '"stop_at"?)')])
def test_malformed_points_are_named_with_line_and_key(read, content, text):
    assert refusal(read, content).startswith(text)


@pytest.mark.parametrize(('content', 'name', 'text'), [
    ('joint_via_points:\n  - [1, 2, 3]\n  - [1, 2]\n', 'points.yaml', 'line 3: '
     'joint_via_points[1] is [1, 2], must have 3 numbers: the positions of shoulder, upper, '
     'elbow in rad'),
    ('joint_via_points:\n  - {shoulder: 1, uper: 2, elbow: 3}\n', 'points.yaml', 'line 2: '
     'joint_via_points[0] names shoulder, uper, elbow, must name upper once; did you mean '
     '"upper" by "uper"?'),
    ('joint_via_points:\n  - {name: [elbow, elbow, upper], position: [1, 2, 3]}\n', 'points.yaml',
     'line 2: joint_via_points[0] names elbow, elbow, upper, must name shoulder once'),
    ('t,shoulder,upper,elbo\n0,1,2,3\n', 'points.csv', 'line 1: the header is t, shoulder, upper, '
     'elbo, and must name one column elbow (or x, y and z); did you mean "elbow" by "elbo"?'),
    ('shoulder,upper,elbow\n1,2,3\n1,,3\n', 'points.csv', 'line 3: upper is missing'),
    ('shoulder [grad],upper,elbow\n1,2,3\n', 'points.csv', 'line 1: the header is shoulder '
     "[grad], upper, elbow, and shoulder is in 'grad': must be in rad, deg, °")])
def test_joints_that_are_missing_are_named_once_the_arm_is_known(read, content, name, text):
    task = read(content, name, started=True)
    with pytest.raises(InvalidInputError) as caught:
        task.joint_via_points(NAMES)
    assert str(caught.value).endswith(f'{name}: {text}')


@pytest.mark.parametrize(('content', 'text'), [
    ('x [ft],y,z\n1,2,3\n', "line 1: the header is x [ft], y, z, and x is in 'ft': must be in m"),
    ('x,y,z,stop\n1,2,3,1\n', 'line 1: the header is x, y, z, stop: unknown stop (did you mean '),
    ('x,y,z,dwells\n1,2,3,1\n', 'line 1: the header is x, y, z, dwells: unknown dwells (did '),
    ('x,y,z,stop_at\n1,2,3,maybe\n', "line 2: stop_at is 'maybe', must be true or false"),
    ('x,y,z,dwell\n1,2,3,long\n', "line 2: dwell is 'long', must be a number"),
    ('x,y,z,dwell,dwell\n1,2,3,1,1\n', 'line 1: the header is x, y, z, dwell, dwell, and must')])
def test_malformed_columns_are_named(read, content, text):
    assert refusal(read, content, 'points.csv').startswith(text)


def test_other_columns_are_nobody_s_business(read):
    assert read('x,y,z,state\n1,2,3,open\n1,2,4,\n', 'points.csv').via_points.tolist() == [
        [1.0, 2.0, 3.0], [1.0, 2.0, 4.0]]
