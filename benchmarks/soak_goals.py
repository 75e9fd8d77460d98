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

"""
Whether every goal of the arm's action ends as it should, whenever it is interrupted.

    python benchmarks/soak_goals.py [GOALS [SEED]]

The simulated arm runs as a process of its own. At a random instant, each goal is canceled,
replaced by the next goal or by a trajectory on the topic, or stopped by `~/hold`; or nothing
happens. What is judged is how the client is told that the goal ended, and the command on the way:
no step of position or velocity beyond what the limits allow, and none outside the ranges. Every
failure is printed; the exit code is 1 if there was any.
"""

from __future__ import annotations

from collections import Counter
from functools import partial
import os
import signal
import subprocess
import sys
from threading import Event, Thread
from time import sleep
from typing import Any

os.environ.setdefault('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
os.environ.setdefault('ROS_DOMAIN_ID', str(1 + os.getpid() % 101))

from builtin_interfaces.msg import Duration  # noqa: E402
from control_msgs.action import FollowJointTrajectory  # noqa: E402
import numpy as np  # noqa: E402
import rclpy  # noqa: E402
from rclpy.action import ActionClient  # noqa: E402
from rclpy.executors import SingleThreadedExecutor  # noqa: E402
from rclpy.node import Node  # noqa: E402
from rrr_traj_planner.core.arm.limits import JointLimits  # noqa: E402
from rrr_traj_planner.nodes.parameters.table import START  # noqa: E402
from sensor_msgs.msg import JointState  # noqa: E402
from std_srvs.srv import Trigger  # noqa: E402
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint  # noqa: E402

DEADLINE = 20.0   # s for any answer
REACH = 0.25      # rad from the first position within which goals are
SLACK = 1.02      # of what the limits allow between two states
ROUNDING = 1e-9   # rad, rad/s
KINDS = ('cancel', 'next goal', 'topic', 'hold', 'nothing')
SUCCEEDED, CANCELED, ABORTED = 4, 5, 6

# How a goal that is interrupted in time may end: status, code, beginning of the text.
ENDS = {
    'cancel': (CANCELED, 0, ''), 'topic': (SUCCEEDED, 0, 'Goal successfully reached!'),
    'next goal': (ABORTED, -1, 'Current goal preempted by new incoming action.'),
    'hold': (ABORTED, -1, 'Current goal aborted: the arm is told to hold its position.'),
    'nothing': (SUCCEEDED, 0, 'Goal successfully reached!')}


class Client:
    """A client of the arm, spun in the background."""

    def __init__(self) -> None:
        rclpy.init()
        self.node, self.states = Node('soak'), []
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(self.node)
        Thread(target=self._executor.spin, daemon=True).start()
        self.action = ActionClient(
            self.node, FollowJointTrajectory, 'simulated_arm/follow_joint_trajectory')
        self.hold = self.node.create_client(Trigger, 'simulated_arm/hold')
        self.topic = self.node.create_publisher(JointTrajectory, 'joint_trajectory', 10)
        self.node.create_subscription(
            JointState, 'desired_joint_states', self.states.append, 1000)
        if not self.action.wait_for_server(DEADLINE) or not self.hold.wait_for_service(DEADLINE):
            raise SystemExit('no arm')
        while not (self.topic.get_subscription_count() and self.states):
            sleep(0.01)

    def close(self) -> None:
        """End the client."""
        self._executor.shutdown(timeout_sec=5.0)
        self.action.destroy()
        self.node.destroy_node()
        rclpy.try_shutdown()

    def pursue(self, trajectory: JointTrajectory) -> Any:
        """Return the handle of a new goal, and the future of its result."""
        return pursued(self._executor, self.action, FollowJointTrajectory.Goal(
            trajectory=trajectory))

    def cancel(self, handle: Any) -> None:
        """Cancel a goal."""
        answer(spun(self._executor, handle.cancel_goal_async))


def spun(executor: SingleThreadedExecutor, function: Any, *args: Any) -> Any:
    """Return what a function returns in the thread that spins: action clients are for that."""
    return answer(executor.create_task(function, *args))


def pursued(executor: SingleThreadedExecutor, action: ActionClient, goal: Any) -> tuple[Any, Any]:
    """Return the handle of a new goal, and the future of its result."""
    handle = answer(spun(executor, action.send_goal_async, goal))
    return handle, spun(executor, handle.get_result_async)


def answer(future: Any) -> Any:
    """Return what a future brings."""
    done = Event()
    future.add_done_callback(lambda _: done.set())
    if not done.wait(DEADLINE):
        raise SystemExit('no answer')
    return future.result()


def trajectory(rng: np.random.Generator, slower: float = 1.0
               ) -> tuple[JointTrajectory, float]:
    """Return a trajectory to rest at a random position, and its duration [s]."""
    seconds = slower * float(rng.uniform(0.3, 1.5))
    point = JointTrajectoryPoint(
        positions=rng.uniform(-REACH, REACH, 3) + START, velocities=[0.0] * 3,
        accelerations=[0.0] * 3, time_from_start=Duration(
            sec=int(seconds), nanosec=int(seconds % 1.0 * 1e9)))
    return JointTrajectory(joint_names=['joint_1', 'joint_2', 'joint_3'], points=[point]), seconds


def begun(client: Client, rng: np.random.Generator) -> tuple[Any, Any, float]:
    """Return a new goal, its result to come, and its duration [s]; slower after each refusal."""
    slower = 1.0
    while True:
        message, seconds = trajectory(rng, slower)
        handle, result = client.pursue(message)
        if handle.accepted:
            return handle, result, seconds
        slower *= 1.5


def steps(states: list[JointState]) -> list[str]:
    """Return where the command goes further between two states than the limits allow."""
    limits, found = JointLimits(), []
    t = np.array([s.header.stamp.sec + 1e-9 * s.header.stamp.nanosec for s in states])
    q, qd = (np.array([getattr(s, name) for s in states]) for name in ('position', 'velocity'))
    for name, values, limit in (('position', q, limits.max_velocity),
                                ('velocity', qd, limits.max_acceleration)):
        excess = np.abs(np.diff(values, axis=0)) - SLACK * np.diff(t)[:, None] * limit - ROUNDING
        found += [f'{name} steps by {excess[i].max():.3g} too much at {t[i]:.3f} s'
                  for i in np.flatnonzero(excess.max(axis=1) > 0.0)]
    if ((q < limits.min_position - ROUNDING) | (q > limits.max_position + ROUNDING)).any():
        found.append('a command is outside the ranges')
    return found


def soak(client: Client, goals: int, rng: np.random.Generator) -> list[str]:
    """Send goals, interrupt each, and return what went wrong."""
    failures: list[str] = []
    counts: Counter[tuple[str, int]] = Counter()
    handle, result, seconds = begun(client, rng)
    for number in range(goals):
        kind = KINDS[rng.integers(len(KINDS))]
        sleep(float(rng.uniform(0.0, 1.1 * seconds)))
        following = None
        message, _ = trajectory(rng)
        act = {'cancel': partial(client.cancel, handle),
               'topic': partial(client.topic.publish, message),
               'hold': partial(client.hold.call, Trigger.Request(), timeout_sec=DEADLINE)}
        if kind in act:
            act[kind]()
        if kind == 'next goal':
            following = begun(client, rng)
        response = answer(result)
        end = (response.status, response.result.error_code, response.result.error_string)
        counts[kind, end[0]] += 1
        if end not in (ENDS[kind], ENDS['nothing']):  # it may have ended before
            failures.append(f'goal {number}, {kind}: ended with {end}')
        if following is None:
            following = begun(client, rng)
        handle, result, seconds = following
    answer(result)
    print('endings by interruption and status:', dict(sorted(counts.items())))
    return failures + steps(list(client.states))


def main() -> int:
    """Run the soak."""
    goals, seed = (int(x) for x in (*sys.argv[1:], *('200', '0')[len(sys.argv) - 1:]))
    arm = subprocess.Popen([sys.executable, '-m', 'rrr_traj_planner.nodes.scripts.simulated_arm',
                            '--ros-args', '--log-level', 'error'])
    client = Client()
    try:
        failures = soak(client, goals, np.random.default_rng(seed))
    finally:
        client.close()
        arm.send_signal(signal.SIGINT)
        code = arm.wait(10.0)
    print(*failures, f'{goals} goals, {len(client.states)} states, {len(failures)} failures, '
          f'exit code of the arm {code}', sep='\n')
    return 1 if failures or code else 0


if __name__ == '__main__':
    raise SystemExit(main())
