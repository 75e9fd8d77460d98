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

"""Log and diagnostics of the arm: warnings, refusals, throttling."""

from __future__ import annotations

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from helpers.arm_in_ros import Arm, at, GOAL, NAMES, rest_to_rest, START
import numpy as np
import pytest
from rcl_interfaces.msg import Log

WARN, ERROR, INFO = 30, 40, 20


class Output:
    """An arm, its log and its diagnostics."""

    def __init__(self, ros, **options):
        self.log = ros.listen(Log, '/rosout', 100)
        self.diagnostics = ros.listen(DiagnosticArray, 'diagnostics')
        self.arm = Arm(ros, **options)
        self.arm.actual.wait_for()

    def line(self, *parts, level=WARN):
        return self.log.wait_for(lambda m: all(part in m.msg for part in parts)
                                 and m.level == level).msg

    def lines(self, *parts, level):
        return [m.msg for m in self.log.messages
                if m.level == level and all(part in m.msg for part in parts)]

    def status(self, wanted):
        message = self.diagnostics.wait_for(
            lambda m: m.status[0].name == 'simulated_arm: arm' and wanted(m.status[0]))
        status, = message.status
        return status, {v.key: v.value for v in status.values}


@pytest.mark.parametrize(('options', 'send', 'parts'), [
    ({}, ((2.0, (34.0, 57.0, 17.0)),), (
        'end with joint_1 at 34 rad, range [0, 1.5708] rad (in degrees?): holding position',
        'end with joint_3 at 17 rad')),
    ({}, ((1.0, GOAL, (0.9, 0.0, 0.0)), (3.0, GOAL, (0.0, 0.0, 0.0)), (3.1, START)), (
        'joint_1 goes to', 'range [0, 1.5708] rad')),
    ({}, ((0.1, START + (0.0, 0.0, 0.4)),), (
        'the lead-in segment exceeds joint limits: joint_3 reaches 4 rad/s, limit 1 rad/s; '
        'the last point is reached ', ' s late'))])
def test_trajectory_that_leaves_ranges_or_limits_is_warned_of(ros, options, send, parts):
    if len(send) == 3:  # a cubic that swings out by 4/27 v T
        send = ((1.0, (1.5, *START[1:]), (0.9, 0.0, 0.0)), (3.0, (1.5, *START[1:]), (0.0,) * 3))
    output = Output(ros, **options)
    output.arm.send(*send)
    output.line(*parts)


def test_partial_goal_in_degrees_is_warned_of(ros):
    output = Output(ros, allow_partial_joints_goal=True)
    output.arm.send((2.0, (-90.0,)), names=['joint_3'])
    text = output.line('joint_3 at -90 rad', '(in degrees?)')
    assert 'joint_1' not in text and 'joint_2' not in text


@pytest.mark.parametrize('q', [(-0.5, *START[1:]), (34.0, 57.0, 17.0)])
def test_trajectory_that_ends_out_of_reach_has_one_line(ros, q):
    output = Output(ros)
    output.arm.send((0.1, q))
    output.line('the trajectory would end with joint_1 at')
    output.arm.send((1.0, START), names=NAMES[:2])  # a later line
    output.line("don't match the controller joints", level=ERROR)
    assert len(output.lines('joint_1', level=WARN)) == 1


def test_points_that_the_arm_misses_have_a_line(ros):
    output = Output(ros)
    output.arm.send((0.0, START + 0.1), (1.0, START + 0.11), (3.0, START + 0.12))
    text = output.line('missed')
    assert text == '1 point is missed: point 2 of 3 is the first that can be reached in time'


def test_sound_trajectory_is_not_warned_of(ros):
    output = Output(ros)
    output.arm.send(rest_to_rest(GOAL, 0.7))
    output.arm.actual.wait_for(at(GOAL))
    assert output.lines('joint_', level=WARN) == output.lines(level=ERROR) == []


def test_stream_has_a_line_in_a_while(ros):
    output = Output(ros)
    for i in range(40):
        output.arm.send((0.05, START + 1e-4 * i))
    output.arm.actual.wait_for(at(START + 39e-4))
    assert len(output.lines('following', level=INFO)) < 5


def test_stream_of_refusals_has_one_too_and_names_the_parameter(ros):
    output = Output(ros)
    for i in range(1, 41):
        output.arm.send((0.05, START, (0.01 * i, 0.0, 0.0)))
    text = output.line('Velocity of last trajectory point of joint joint_1 is not zero: 0.',
                       level=ERROR)
    assert 'allow_nonzero_velocity_at_trajectory_end' in text
    output.arm.send((1.0, START), names=NAMES[:2])  # another refusal is logged at once
    output.line("don't match the controller joints", level=ERROR)
    assert len(output.lines('Velocity of last', level=ERROR)) < 5


def test_saturated_motor_and_pressed_stop_are_warned_of(ros):
    output = Output(ros)
    output.arm.disturb(joint_1=-2000.0)  # its motor has 150 N m
    output.line('joint_1 needs', 'its motor is saturated at 150 N m')
    output.line('joint_1 hit its lower stop (0 rad) at', 'rad/s')
    output.line('joint_1 is pressed against its lower stop (0 rad) with 1850 N m')
    # From here on for a whole period: the motor pulls with all that it has.
    status, values = output.status(lambda s: s.message.startswith('joint_1 saturated 100 %'))
    assert status.level == DiagnosticStatus.WARN
    assert float(values['joint_1 saturated [share]']) == 1.0
    assert float(values['joint_1 pressed against stop [N m]']) == pytest.approx(-1850.0, abs=0.5)
    assert float(values['joint_1 tracking error [rad]']) == pytest.approx(START[0], abs=1e-3)


def test_diagnostics_of_an_arm_without_problems_are_ok(ros):
    output = Output(ros, publish_clock=True, real_time_factor=2.0)
    status, values = output.status(lambda s: s.level == DiagnosticStatus.OK)
    assert status.message == 'holds its position'
    assert 0.0 < float(values.pop('real-time factor')) < 2.5
    assert float(values.pop('behind the clock [s]')) < 0.1
    assert len(values) == 15 and max(abs(float(x)) for x in values.values()) < 1e-9


def test_arm_outside_a_range_made_smaller_is_warned_of(ros):
    output = Output(ros)
    output.arm.send(rest_to_rest(START + (0.3, 0.0, 0.0), 1.2))
    output.arm.actual.wait_for(at(START + (0.3, 0.0, 0.0)))
    high = float(START[0] + 0.1)
    assert output.arm.set_parameter('joint_limits.joint_1.max_position', high).successful
    status, values = output.status(lambda s: 'outside its range' in s.message)
    assert status.level == DiagnosticStatus.WARN and 'joint_1' in status.message
    assert 0.0 < float(values['joint_1 outside range [rad]']) < np.nextafter(0.2, 1.0) + 1e-6
