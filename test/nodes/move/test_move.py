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

"""The script `move` with real nodes: motions, refusals, signals, exit codes."""

from __future__ import annotations

import signal

from helpers.arm_in_ros import Arm, at, GOAL, moving, stamp, START
from helpers.move_script import move, moved, seconds_to_end, via_rows
from helpers.planner_in_ros import start_planner
import numpy as np
import pytest
from rclpy.parameter import Parameter
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.nodes.arm_node.node import SimulatedArm
from rrr_traj_planner.nodes.planner_node.node import TrajectoryPlanner

FAR = START + (0.4, 0.3, -0.3)  # a second or two away
JOINTS = 'joint_1,joint_2,joint_3\n'


def line(q):
    return ','.join(f'{x:.6f}' for x in q) + '\n'


@pytest.fixture(scope='module')
def arm(module_ros):
    """Give the tests a planner and an arm."""
    start_planner(module_ros)
    return Arm(module_ros)


@pytest.fixture(autouse=True)
def at_start(arm, tmp_path):
    """Begin each test with the arm at its start, and files of via points."""
    assert arm.trigger('reset').success
    arm.actual.wait_for_next(at(START))
    (tmp_path / 'taught.csv').write_text(JOINTS + line(GOAL) + line(START + (0.1, 0.0, 0.0)))
    (tmp_path / 'far.csv').write_text(JOINTS + line(GOAL) + line(FAR))
    tips = forward_kinematics(RobotModel(), np.array([START, GOAL]))
    (tmp_path / 'from_here.yaml').write_text(f'via_points: {tips.tolist()}\n')


def test_arm_goes_through_taught_positions_from_where_it_is(arm, tmp_path):
    code, output, errors = moved('taught.csv', cwd=tmp_path)
    assert (code, errors) == (0, '')
    assert "planned 2 via points with 'cycloid' in " in output
    assert 'executing: ' in output and 'next via point 0' in output
    rows = via_rows(output)
    assert [row[0] for row in rows] == [0, 1]
    assert 0.0 < rows[0][1] < rows[1][1]
    assert f'taught: {rows[1][1]:.3f} s' in output
    assert max(row[2] for row in rows) < 1.0
    for text in ('at rest', 'velocity [rad/s]', 'jerk [rad/s^3]', ' / 10', 'executed torque'):
        assert text in output
    arm.actual.wait_for_next(at(START + (0.1, 0.0, 0.0)))


def test_one_via_point_is_enough_and_one_where_the_arm_is_too(arm, tmp_path):
    (tmp_path / 'one.csv').write_text(JOINTS + line(GOAL))
    for at_it in (False, True):
        code, output, errors = moved('one.csv', cwd=tmp_path)
        assert (code, errors) == (0, '')
        (index, time, error), = via_rows(output)
        assert (index, time > 0.0) == (0, not at_it)
        assert error < 1.0
        arm.actual.wait_for_next(at(GOAL))


def test_arm_at_the_first_via_point_starts_there(arm, tmp_path):
    code, output, errors = moved('from_here.yaml', '--planner', 'time_optimal', cwd=tmp_path)
    assert (code, errors) == (0, '')
    assert 'the arm is at via point 0: the motion starts there' in output
    assert "planned 1 via point with 'time_optimal'" in output
    assert 'next via point 1' in output
    rows = via_rows(output)
    assert [row[0] for row in rows] == [0, 1]
    assert rows[0][1] == 0.0 < rows[1][1]
    assert max(row[2] for row in rows) < 1.0
    arm.actual.wait_for_next(at(GOAL))


def test_dry_run_prints_the_answer_and_sends_nothing(arm, tmp_path):
    since = len(arm.desired.messages)
    code, output, errors = moved('taught.csv', '--dry-run', cwd=tmp_path)
    assert (code, errors) == (0, '')
    lines = {text.partition(':')[0].strip(): text.partition(':')[2].split()
             for text in output.splitlines()}
    assert lines['error_code'] == ['1', 'SUCCESS']
    times = [float(text.strip(',')) for text in lines['via_times'][:-1]]
    assert 0.0 < times[0] < times[1]
    first = next(text for text in output.splitlines() if text.strip().startswith('first at'))
    assert ', '.join(f'{x:.4f}' for x in START) in first
    last = next(text for text in output.splitlines() if text.strip().startswith('last'))
    assert f'{times[1]:.3f} s: ' in last
    assert 'acceleration [rad/s^2]' in output and ' / 1 ' in output
    arm.desired.wait_for_next()
    assert all(at(START, 0.0)(m) for m in arm.desired.messages[since:])


def test_refusal_is_told_in_a_line(tmp_path):
    (tmp_path / 'out.yaml').write_text('via_points: [[1.0, 0.6, 1.0], [3.0, 0.0, 0.5]]\n')
    code, output, errors = moved('out.yaml', '--dry-run', cwd=tmp_path)
    assert code == 1
    assert errors.startswith('move: the planner refuses (-31): via point 1: (3, 0, 0.5) m is out')
    assert errors.count('\n') == 1
    assert 'error_code:    -31 NO_IK_SOLUTION' in output


def test_refusal_after_a_via_point_that_is_left_out_says_how_the_others_are_counted(tmp_path):
    tips = [*forward_kinematics(RobotModel(), np.array([START, GOAL])).tolist(), [3.0, 0.0, 0.5]]
    (tmp_path / 'out.yaml').write_text(f'via_points: {tips}\n')
    code, output, errors = moved('out.yaml', cwd=tmp_path)
    assert (code, errors.count('\n')) == (1, 1)
    assert 'executing' not in output
    assert 'via point 1: (3, 0, 0.5) m' in errors
    assert 'counted from 0 after the one that is left out' in errors


def test_what_is_not_there_is_waited_for_by_name_until_a_signal(tmp_path):
    with move('taught.csv', '--controller', '/nope', cwd=tmp_path) as process:
        process.read_until('waiting for the controller (action /nope/follow_joint_trajectory; '
                           'there is /simulated_arm/follow_joint_trajectory) ...')
        assert seconds_to_end(process, signal.SIGTERM) < 2.0
        assert process.ended()[0] == 0


def test_signal_cancels_the_goal_and_the_arm_stops(arm, tmp_path):
    with move('far.csv', cwd=tmp_path) as process:
        process.read_until('executing: ')
        arm.actual.wait_for_next(moving)
        assert seconds_to_end(process, signal.SIGINT) < 2.0
        code, output, errors = process.ended()
    assert (code, errors) == (0, '')
    assert 'the controller stops the arm' in output
    stopped = arm.actual.wait_for_next(lambda m: np.abs(m.velocity).max() < 1e-6)
    assert np.abs(np.subtract(stopped.position, FAR)).max() > 0.05
    later = arm.actual.wait_for_next(lambda m: stamp(m) > stamp(stopped) + 100_000_000)
    assert later.position == pytest.approx(stopped.position, abs=1e-5)


def test_controller_that_gives_up_is_quoted(arm, tmp_path):
    name = 'constraints.joint_1.trajectory'
    assert arm.set_parameter(name, 0.01).successful
    try:
        with move('far.csv', cwd=tmp_path) as process:
            process.read_until('executing: ')
            arm.disturb(joint_1=400.0)  # the motor has 150 N m
            code, output, errors = process.ended()
    finally:
        arm.disturb()
        assert arm.set_parameter(name, 0.0).successful
    assert code == 1
    assert errors.startswith('move: the controller has aborted the trajectory '
                             '(PATH_TOLERANCE_VIOLATED): ')
    assert 'joint_1' in errors
    assert errors.count('\n') == 1
    assert 'tip error' not in output


def test_move_works_in_a_namespace(module_ros, tmp_path):
    for kind in (TrajectoryPlanner, SimulatedArm):
        module_ros.add(kind(context=module_ros.context, namespace='left', parameter_overrides=[
            Parameter('initial_positions', value=GOAL.tolist())] if kind is SimulatedArm else []))
    code, output, errors = moved('taught.csv', '--ros-args', '-r', '__ns:=/left', cwd=tmp_path)
    assert (code, errors) == (0, '')
    assert [row[0] for row in via_rows(output)] == [0, 1]
    code, output, errors = moved('taught.csv', '--controller', '/left/simulated_arm', '--ros-args',
                                 '-r', 'plan_trajectory:=/left/plan_trajectory',
                                 '-r', 'joint_states:=/left/joint_states', '--', cwd=tmp_path)
    assert (code, errors) == (0, '')


def test_dry_run_needs_no_arm(module_ros, tmp_path):
    module_ros.add(TrajectoryPlanner(context=module_ros.context, namespace='alone'))
    code, output, errors = moved('from_here.yaml', '--dry-run', '--ros-args', '-r',
                                 '__ns:=/alone', cwd=tmp_path)
    assert (code, errors) == (0, '')
    assert 'nobody publishes where the arm is: planned from rest at the first via point' in output
    assert 'via_times:     0.000, ' in output


@pytest.mark.parametrize(('arguments', 'text'), [
    (('nowhere.yaml',), 'nowhere.yaml'),
    (('taught.csv', '--controller', 'a b'), "--controller is 'a b', must be a name such as"),
    (('taught.csv', '--controller', ''), "--controller is '', must be a name such as"),
    (('taught.csv', '--dry-run', '--record', 'a.mcap'), '--record records a motion'),
    (('taught.csv', '--record', 'taught.csv'), 'taught.csv exists already')])
def test_wrong_arguments_are_refused_in_a_line(tmp_path, arguments, text):
    code, output, errors = moved(*arguments, cwd=tmp_path)
    assert (code, output) == (1, '')
    assert errors.startswith('move: ') and text in errors
    assert errors.count('\n') == 1


def test_help_needs_no_ros(tmp_path):
    code, output, errors = moved('--help', cwd=tmp_path)
    assert (code, errors) == (0, '')
    for text in ('POINTS', '--controller NAME', '--dry-run', '--record MCAP', '--ros-args'):
        assert text in output
