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

"""The arm's time: a clock that it follows, or is."""

from __future__ import annotations

from time import sleep

from builtin_interfaces.msg import Time
from helpers.arm_in_ros import ALL, Arm, at, GOAL, rest_to_rest, SECOND, stamp
import numpy as np
import pytest
from rcl_interfaces.msg import Log
from rclpy.clock import Clock as SteadyClock
from rclpy.clock import ClockType
from rosgraph_msgs.msg import Clock
from rrr_traj_planner.nodes.arm_node.node import SimulatedArm
from sensor_msgs.msg import JointState
from std_srvs.srv import SetBool

STEP = SECOND // 1000


def clock_time(message):
    return message.clock.sec * SECOND + message.clock.nanosec


def pause(ros, data):
    return ros.call(SetBool, 'simulated_arm/pause', SetBool.Request(data=data))


def test_arm_is_the_clock_at_its_factor(ros):
    arm = Arm(ros, publish_clock=True, real_time_factor=4.0)
    clock = ros.listen(Clock, '/clock', ALL)
    first, begun = clock_time(clock.wait_for()), ros.node.get_clock().now().nanoseconds
    last = clock_time(clock.wait_for(lambda m: clock_time(m) >= first + 4 * SECOND))
    wall = ros.node.get_clock().now().nanoseconds - begun
    assert wall > 0.8 * (last - first) / 4.0  # no faster; a busy machine may be slower
    for times in ([clock_time(m) for m in clock.messages],
                  [stamp(m) for m in arm.actual.messages]):
        between = np.diff(times)
        assert (between > 0).all()
        assert (between % (5 * STEP) == 0).all()
        assert np.median(between) == 5 * STEP  # some may be lost while both sides meet


def test_arm_runs_as_fast_as_it_can_and_answers_meanwhile(ros):
    arm = Arm(ros, publish_clock=True, real_time_factor=0.0)
    clock = ros.listen(Clock, '/clock')
    begun, first = ros.node.get_clock().now().nanoseconds, clock_time(clock.wait_for())
    arm.send(rest_to_rest(GOAL, 0.4))
    arm.actual.wait_for(at(GOAL))
    assert arm.trigger('hold').success
    last = clock_time(clock.wait_for(lambda m: clock_time(m) >= first + 20 * SECOND))
    assert ros.node.get_clock().now().nanoseconds - begun < last - first


@pytest.mark.parametrize(('rate', 'spread'), [(1.0, 0), (5.0, 0), (333.3, STEP), (1000.0, 0)])
def test_any_rate_keeps_an_outside_clock_s_time(ros, rate, spread):
    """At 20 times real time: 4 s of the clock take 0.2 s."""
    publisher = ros.node.create_publisher(Clock, '/clock', 10)
    arm = Arm(ros, use_sim_time=True, publish_rate=rate)
    now = [100 * SECOND]

    def joined():
        return arm.actual.messages and stamp(arm.actual.messages[-1]) >= 100 * SECOND

    def advance():
        if joined():
            now[0] = min(now[0] + SECOND // 10, 104 * SECOND)
        publisher.publish(Clock(clock=Time(sec=now[0] // SECOND, nanosec=now[0] % SECOND)))

    ros.node.create_timer(0.005, advance)
    arm.actual.wait_for(lambda m: stamp(m) > 103 * SECOND - SECOND // 10)
    gaps = np.diff([stamp(m) for m in arm.actual.messages[1:]])
    whole = gaps[gaps < 1.5 * SECOND / rate]  # an arm that is late publishes only the last states
    assert whole.size
    assert np.abs(whole - SECOND / rate).max() <= spread + 1


def test_time_begins_when_the_node_is_first_spun(ros):
    """However long it took to get there: an arm is not late when it starts."""
    actual = ros.listen(JointState, 'joint_states', ALL)
    node = SimulatedArm(context=ros.context)
    sleep(0.3)  # loading of other nodes, say
    spun = node.get_clock().now().nanoseconds
    ros.add(node)
    assert stamp(actual.wait_for()) >= spun


def test_seldom_published_states_are_on_time(ros):
    arm = Arm(ros, publish_rate=5.0)
    first = stamp(arm.actual.wait_for())
    arm.actual.wait_for(lambda m: stamp(m) >= first + SECOND // 2)
    gaps = np.diff([stamp(m) for m in arm.actual.messages])
    assert gaps.size >= 3
    assert (gaps == SECOND // 5).all()


def test_clock_is_published_often_however_seldom_states_are(ros):
    clock = ros.listen(Clock, '/clock', ALL)
    Arm(ros, publish_clock=True, publish_rate=1.0, real_time_factor=4.0)
    clock.wait_for(lambda m: clock_time(m) >= SECOND)
    gaps = np.diff([clock_time(m) for m in clock.messages])
    assert (gaps % (SECOND // 100) == 0).all()
    assert np.median(gaps) == SECOND // 100


def test_rate_above_that_of_the_steps_is_warned_of(ros):
    log = ros.listen(Log, '/rosout')
    Arm(ros, publish_rate=200.0, physics_step=0.01)
    text = log.wait_for(lambda m: 'publish_rate' in m.msg).msg
    assert 'publish_rate is 200 Hz' in text and 'at 100 Hz' in text


def test_time_is_paused_and_advances_in_single_steps(ros):
    arm = Arm(ros, publish_clock=True)
    arm.actual.wait_for()
    assert not arm.trigger('step').success  # time is not paused
    answer = pause(ros, True)
    assert answer.success and answer.message.startswith('time paused at ')
    before = arm.trigger('step').message  # 'stepped to 0.123 s'
    after = arm.trigger('step').message
    reached = [float(text.split()[2]) for text in (before, after)]
    assert abs(reached[1] - reached[0] - 0.001) < 1e-9
    stepped = round(reached[1] * SECOND)
    arm.actual.wait_for(lambda m: stamp(m) == stepped)
    assert pause(ros, False).success
    arm.actual.wait_for_next(lambda m: stamp(m) > stepped + SECOND // 10)


def test_arm_that_follows_a_clock_refuses_to_pause_it(ros):
    arm = Arm(ros)
    answer, step = pause(ros, True), arm.trigger('step')
    assert not answer.success and not step.success
    assert 'publish_clock' in answer.message and 'publish_clock' in step.message


def test_factor_changes_at_run_time(ros):
    arm = Arm(ros, publish_clock=True, real_time_factor=0.5)
    arm.actual.wait_for()
    assert arm.set_parameter('real_time_factor', 20.0).successful
    since = stamp(arm.actual.wait_for_next())
    arm.actual.wait_for_next(lambda m: stamp(m) > since + 10 * SECOND)


def test_stamped_trajectory_is_followed_on_the_arm_s_own_clock(ros):
    arm = Arm(ros, publish_clock=True, real_time_factor=2.0)
    start = stamp(arm.actual.wait_for()) + SECOND
    arm.send(rest_to_rest(GOAL, 0.1), stamp=start)
    due = arm.desired.wait_for(lambda m: stamp(m) >= start + SECOND // 10)
    np.testing.assert_allclose(due.position, GOAL, atol=1e-12)


def test_arm_lives_in_simulated_time(ros):
    publisher = ros.node.create_publisher(Clock, '/clock', 10)
    arm = Arm(ros, use_sim_time=True)
    now = [100 * SECOND]

    def advance():
        now[0] += SECOND // 100
        publisher.publish(Clock(clock=Time(sec=now[0] // SECOND, nanosec=now[0] % SECOND)))

    ros.node.create_timer(0.005, advance)
    at_once = arm.actual.wait_for(lambda m: stamp(m) >= 100 * SECOND)
    arm.actual.wait_for(lambda m: stamp(m) > stamp(at_once) + SECOND // 2)
    assert stamp(arm.actual.messages[-1]) <= now[0]
    arm.send(rest_to_rest(GOAL, 0.2))
    arm.actual.wait_for(at(GOAL))


def test_standing_clock_is_published_once(ros):
    publisher = ros.node.create_publisher(Clock, '/clock', 10)
    arm = Arm(ros, use_sim_time=True)
    times = iter([100 * SECOND] * 20 + [100 * SECOND + SECOND // 10] * 20)

    def tell():
        now = next(times, None)
        if now is not None:
            publisher.publish(Clock(clock=Time(sec=now // SECOND, nanosec=now % SECOND)))

    ros.node.create_timer(0.01, tell)
    arm.actual.wait_for(lambda m: stamp(m) == 100 * SECOND + SECOND // 10)
    stamps = [stamp(m) for m in arm.actual.messages]
    assert len(stamps) == len(set(stamps))


def test_states_that_a_delay_has_made_due_are_all_published(ros):
    now = [100 * SECOND]
    publisher = ros.node.create_publisher(Clock, '/clock', 10)
    ros.node.create_timer(0.01, lambda: publisher.publish(Clock(clock=Time(
        sec=now[0] // SECOND, nanosec=now[0] % SECOND))), clock=SteadyClock(
            clock_type=ClockType.STEADY_TIME))
    arm = Arm(ros, use_sim_time=True)
    since = now[0]
    arm.actual.wait_for(lambda m: stamp(m) == since)
    now[0] += 2 * SECOND // 5  # as if the arm's process had stood still for so long
    arm.actual.wait_for(lambda m: stamp(m) == now[0])
    assert np.diff([stamp(m) for m in arm.actual.messages if stamp(m) >= since]).tolist() == (
        [5 * STEP] * 80)
