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

"""Processes that are killed and come back, floods, and clocks that jump."""

from __future__ import annotations

from contextlib import suppress
import os
from pathlib import Path
import re
import signal
from threading import Event
from time import monotonic, sleep

from builtin_interfaces.msg import Duration, Time
from helpers.arm_in_ros import Arm, at, GOAL, moving, NAMES, rest_to_rest, SECOND, stamp, START
from helpers.plan_requests import NEAR, plan_request
from helpers.scripts import python, Script, script
import numpy as np
import pytest
from rcl_interfaces.srv import GetParameters
from rosgraph_msgs.msg import Clock
from rrr_traj_planner_interfaces.srv import PlanTrajectory
from sensor_msgs.msg import JointState
from std_srvs.srv import Trigger
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

CODES = PlanTrajectory.Response
QUIET = ('--ros-args', '--log-level', 'fatal')

# How long a client waits for a node that has ended [s], and by how much more the call may take.
TIMEOUT, SLACK = 1.0, 4.0
DEADLINE = 30.0

FLOOD_SECONDS, FLOOD_RATE = 4.0, 1000.0

# Shared memory that one participant writes; that of ports is used by all, whatever their domain.
OF_ONE_PROCESS = re.compile('fastrtps_[0-9a-f]{16}(_el)?')

# A planner that never ends, and says that it has begun.
ENDLESS = """
import sys, threading
from rrr_traj_planner.planners.registration import register
@register('endless')
def endless(task): print('begun', flush=True); threading.Event().wait()
from rrr_traj_planner.nodes.scripts.planner import main
sys.exit(main())
"""


def killed(running):
    running.process.kill()
    assert running.process.wait(20.0) == -signal.SIGKILL


def plan(ros, client=None):
    """Return an answer's code; ask again where the server that was found is one just killed."""
    client = client or ros.node.create_client(PlanTrajectory, 'plan_trajectory')
    deadline = monotonic() + DEADLINE
    while monotonic() < deadline:
        if client.wait_for_service(DEADLINE):
            answer = client.call(plan_request(NEAR), timeout_sec=TIMEOUT)
            if answer is not None:
                return answer.error_code
    raise AssertionError('no answer')


def long_motion():
    """Return a trajectory that takes long."""
    return trajectory([(15.0, START + (0.5, 0.3, 0.3))])


def trajectory(points):
    message = JointTrajectory(joint_names=NAMES)
    for time, q in points:
        sec, nanosec = divmod(round(time * SECOND), SECOND)
        message.points.append(JointTrajectoryPoint(
            positions=[float(x) for x in q], time_from_start=Duration(sec=sec, nanosec=nanosec)))
    return message


def shared_memory(pid):
    """Return the files in shared memory that a process has open."""
    place = Path('/proc', str(pid))
    names = re.findall(r'/dev/shm/\S+', (place / 'maps').read_text())
    for number in (place / 'fd').iterdir():
        with suppress(FileNotFoundError):  # closed meanwhile
            names.append(os.readlink(number))
    return {Path(name) for name in names if name.startswith('/dev/shm/')}


def remove_unused(files):
    """Remove what dead participants have left; a process also reads that of others, alive ones."""
    used = set()
    for place in Path('/proc').glob('[0-9]*'):
        with suppress(OSError):  # ended meanwhile, or another user's
            used |= shared_memory(place.name)
    for file in files - used:
        if OF_ONE_PROCESS.fullmatch(file.name):
            file.unlink(missing_ok=True)


# Killed


def test_client_of_a_planner_killed_while_planning_times_out_and_the_next_one_serves(ros):
    client = ros.node.create_client(PlanTrajectory, 'plan_trajectory')
    with Script(python(ENDLESS), *QUIET) as planner:
        assert client.wait_for_service(20.0)
        future = client.call_async(plan_request(planner_id='endless'))
        planner.read_until('begun')
        killed(planner)
    began = monotonic()
    assert client.call(plan_request(NEAR), timeout_sec=TIMEOUT) is None
    assert monotonic() - began < TIMEOUT + SLACK
    assert not future.done()
    with Script(script('planner'), *QUIET):
        assert plan(ros, client) == CODES.SUCCESS  # the same client finds the new planner


def test_planner_continues_when_the_arm_is_killed_while_moving_and_restarted(ros):
    states = ros.listen(JointState, 'joint_states')
    with Script(script('planner'), *QUIET) as planner:
        with Script(script('simulated_arm'), *QUIET) as arm:
            states.wait_for()
            ros.publisher(JointTrajectory, 'joint_trajectory').publish(long_motion())
            states.wait_for_next(moving)
            killed(arm)
        assert plan(ros) == CODES.SUCCESS
        since = len(states.messages)
        with Script(script('simulated_arm'), *QUIET):
            states.wait_for(at(START), since)
            assert ros.call(Trigger, 'simulated_arm/hold').success
            assert plan(ros) == CODES.SUCCESS
        assert planner.process.poll() is None


def test_arm_continues_when_the_planner_is_killed(ros):
    states = ros.listen(JointState, 'joint_states')
    with Script(script('simulated_arm'), *QUIET) as arm:
        with Script(script('planner'), *QUIET) as planner:
            assert plan(ros) == CODES.SUCCESS
            ros.publisher(JointTrajectory, 'joint_trajectory').publish(long_motion())
            states.wait_for_next(moving)
            killed(planner)
        states.wait_for_next(moving)
        assert ros.call(Trigger, 'simulated_arm/hold').success
        assert arm.process.poll() is None


def test_nodes_start_despite_what_killed_nodes_leave_in_shared_memory(ros):
    left = set()
    for _ in range(3):
        with Script(script('planner'), *QUIET) as planner:
            assert plan(ros) == CODES.SUCCESS
            left |= shared_memory(planner.process.pid)
            killed(planner)
    left = {file for file in left if file.exists()}
    assert left
    with Script(script('planner'), *QUIET) as planner:
        assert plan(ros) == CODES.SUCCESS
        planner.process.send_signal(signal.SIGINT)
        assert planner.ended()[0] == 0
    remove_unused(left)


# Floods


def test_arm_answers_and_moves_under_a_thousand_trajectories_a_second(ros):
    states = ros.listen(JointState, 'joint_states', 1000)
    with Script(script('simulated_arm'), *QUIET) as arm:
        states.wait_for()
        publisher = ros.publisher(JointTrajectory, 'joint_trajectory')
        client = ros.node.create_client(GetParameters, 'simulated_arm/get_parameters')
        assert client.wait_for_service(DEADLINE)
        message = trajectory([(0.5, GOAL), (1.0, START)])
        began, sent, slowest, since = monotonic(), 0, 0.0, len(states.messages)
        while (now := monotonic()) < began + FLOOD_SECONDS:
            while sent < (now - began) * FLOOD_RATE:
                publisher.publish(message)
                sent += 1
            called = monotonic()
            answer = client.call(GetParameters.Request(names=['publish_rate']), DEADLINE)
            slowest = max(slowest, monotonic() - called)
            assert answer.values[0].double_value == 200.0
        assert sent >= 0.9 * FLOOD_RATE * FLOOD_SECONDS
        assert slowest < TIMEOUT + SLACK
        times = [stamp(m) for m in states.messages[since:]]
        assert len(times) > FLOOD_SECONDS * 10.0
        assert np.isfinite([m.position for m in states.messages]).all()
        publisher.publish(trajectory([(0.5, GOAL)]))
        states.wait_for_next(at(GOAL, 1e-3))
        assert arm.process.poll() is None


# Clocks


def test_arm_survives_a_clock_that_jumps_back_and_forth(ros):
    publisher = ros.node.create_publisher(Clock, '/clock', 10)
    arm = Arm(ros, use_sim_time=True)
    now, ticks, steady = [1000 * SECOND], [0], Event()
    jumps = iter([3600, -1800, 10 ** 9, -10 ** 9, 50, -1000])

    def advance():
        ticks[0] += 1
        now[0] += SECOND // 100
        if ticks[0] % 20 == 0:
            jump = next(jumps, None)
            if jump is None:
                steady.set()
            else:
                now[0] += jump * SECOND
        publisher.publish(Clock(clock=Time(sec=now[0] // SECOND, nanosec=now[0] % SECOND)))

    ros.node.create_timer(0.005, advance)
    arm.actual.wait_for(lambda m: stamp(m) >= 1000 * SECOND)
    arm.send(rest_to_rest(GOAL, 1.0))
    assert steady.wait(20.0)
    q = np.array([m.position for m in arm.actual.messages])
    assert np.isfinite(q).all()
    assert np.abs(np.diff(q, axis=0)).max() < 0.05  # time may jump, the arm may not
    arm.actual.wait_for(at(GOAL))
    arm.actual.wait_for_next(lambda m: abs(stamp(m) - now[0]) < SECOND)


# Hostile trajectories


@pytest.mark.parametrize('values', [
    (1e300,) * 3, (-1e300, 0.5, 1e308), (1e7, 0.0, 0.0), (float('nan'),) * 3,
    (float('inf'), 0.0, 0.0)])
def test_values_that_no_arm_reaches_are_refused_and_change_nothing(ros, values):
    arm = Arm(ros)
    arm.actual.wait_for(at(START))
    for field in range(3):
        given = [GOAL, np.zeros(3), np.zeros(3)]
        given[field] = values
        arm.send((0.2, *given), (0.4, GOAL, np.zeros(3), np.zeros(3)))
    arm.actual.wait_for(at(START), len(arm.actual.messages) + 20)
    assert arm.trigger('hold').success
    arm.send(rest_to_rest(GOAL, 0.2))
    arm.actual.wait_for(at(GOAL))


def test_violent_but_possible_values_leave_an_arm_that_resets(ros):
    arm = Arm(ros)
    arm.send((1e-9, (1e6, -1e6, 1e6), (1e6,) * 3, (-1e6,) * 3), (2e-9, (-1e6, 1e6, 0.0)),
             (0.1, GOAL), (1e9, (5e-324,) * 3))
    sleep(0.2)
    assert arm.trigger('hold').success
    assert arm.trigger('reset').success
    since = len(arm.actual.messages)
    arm.actual.wait_for(at(START), since)
    assert np.isfinite([m.position for m in arm.actual.messages]).all()
    arm.send(rest_to_rest(GOAL, 0.2))
    arm.actual.wait_for(at(GOAL))


def test_hundred_thousand_points_are_followed_or_refused_and_the_arm_answers(ros):
    arm = Arm(ros)
    times = 1e-3 * np.arange(1, 100_001)
    arm.send(*((t, GOAL) for t in times))
    arm.desired.wait_for(at(GOAL))
    assert arm.trigger('hold').success


def test_bytes_that_are_no_message_are_survived(ros):
    arm = Arm(ros)
    arm.actual.wait_for(at(START))
    header = b'\x00\x01\x00\x00'  # little-endian CDR
    stamps, empty = b'\0' * 8, (1).to_bytes(4, 'little') + b'\0\0\0\0'
    for body in (b'', b'\xff' * 64, stamps + b'\xff' * 8, stamps + empty + b'\xff\xff\xff\x7f',
                 # one joint, whose name is no UTF-8
                 stamps + empty + (1).to_bytes(4, 'little') + (4).to_bytes(4, 'little')
                 + b'\xff\xfe\xc0\0' + (0).to_bytes(4, 'little')):
        arm._publisher.publish(header + body)
    arm.send(rest_to_rest(GOAL, 0.2))
    arm.actual.wait_for(at(GOAL))
