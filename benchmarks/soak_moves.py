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
Whether every goal of the motion server ends as it should, whenever it is interrupted.

    python benchmarks/soak_moves.py [GOALS [SEED]]

Planner, simulated arm and motion server run as processes. At a random instant, each goal is
canceled, replaced by the next goal, or disturbed by a goal that is refused; or nothing happens; or
somebody else moves the arm before the next goal. What is judged is how the client is told that the
goal ended, where the arm is then, and the command on the way, as in `soak_goals.py`. Every failure
is printed; the exit code is 1 if there was any.
"""

from __future__ import annotations

from collections import Counter
import signal
import subprocess
import sys
from threading import Thread
from time import sleep
from typing import Any

from geometry_msgs.msg import Point, Pose
import numpy as np
import rclpy
from rclpy.action import ActionClient
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.dynamics.rigid_body import gravity_torque
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner_interfaces.action import MoveThrough
from sensor_msgs.msg import JointState
from soak_goals import answer, DEADLINE, pursued, spun, steps, trajectory
from trajectory_msgs.msg import JointTrajectory

KINDS = ('cancel', 'next goal', 'refused goal', 'nothing', 'other motion')
LOW, HIGH = (0.1, 0.6, -0.6), (1.4, 1.8, 0.6)  # rad, of via points
NEAR = 1e-3   # m, of the tip from the last via point when the goal is reached
Result = MoveThrough.Result
SUCCEEDED, CANCELED, ABORTED = 4, 5, 6
REACHED = SUCCEEDED, Result.SUCCESS
ENDS = {'cancel': (CANCELED, Result.PREEMPTED), 'next goal': (ABORTED, Result.PREEMPTED),
        'refused goal': REACHED, 'nothing': REACHED, 'other motion': REACHED}
MODEL, LIMITS = RobotModel(), JointLimits()


class Client:
    """A client of the motion server, spun in the background."""

    def __init__(self) -> None:
        rclpy.init()
        self.node, self.states, self.measured = Node('soak'), [], []
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(self.node)
        Thread(target=self._executor.spin, daemon=True).start()
        self.action = ActionClient(self.node, MoveThrough, 'move_through')
        self.topic = self.node.create_publisher(JointTrajectory, 'joint_trajectory', 10)
        self.node.create_subscription(
            JointState, 'desired_joint_states', self.states.append, 1000)
        self.node.create_subscription(JointState, 'joint_states', self._measure, 10)
        if not self.action.wait_for_server(DEADLINE):
            raise SystemExit('no motion server')
        while not (self.topic.get_subscription_count() and self.states and self.measured):
            sleep(0.01)

    def _measure(self, message: JointState) -> None:
        self.measured[:] = [message]

    def close(self) -> None:
        """End the client."""
        self._executor.shutdown(timeout_sec=5.0)
        self.action.destroy()
        self.node.destroy_node()
        rclpy.try_shutdown()

    def move(self, places: Any) -> tuple[Any, Any]:
        """Return the handle of a new goal, and the future of its result."""
        goal = MoveThrough.Goal()
        goal.via_points.poses = [Pose(position=Point(x=x, y=y, z=z)) for x, y, z in places]
        return pursued(self._executor, self.action, goal)

    def cancel(self, handle: Any) -> None:
        """Cancel a goal."""
        answer(spun(self._executor, handle.cancel_goal_async))

    def tip(self) -> Any:
        """Return where the arm's tip is [m]."""
        return forward_kinematics(MODEL, np.array(self.measured[0].position))


def places(rng: np.random.Generator) -> Any:
    """Return one to three tip positions that the arm can reach and hold."""
    while True:
        q = rng.uniform(LOW, HIGH, (rng.integers(1, 4), 3))
        if (np.abs(gravity_torque(MODEL, q)) < 0.9 * LIMITS.max_effort).all():
            return forward_kinematics(MODEL, q).tolist()


def soak(client: Client, goals: int, rng: np.random.Generator) -> list[str]:
    """Send goals, interrupt each, and return what went wrong."""
    failures: list[str] = []
    counts: Counter[tuple[str, int, int]] = Counter()
    ways = places(rng)
    handle, result = client.move(ways)
    for number in range(goals):
        kind = KINDS[rng.integers(len(KINDS))]
        following = None
        sleep(float(rng.uniform(0.0, 2.5)))
        if kind == 'cancel':
            client.cancel(handle)
        elif kind == 'next goal':
            following = places(rng)
            following = following, *client.move(following)
        elif kind == 'refused goal':
            _, refused = client.move([(9.0, 9.0, 9.0)])
            found = answer(refused).result
            if found.error_code != Result.NO_IK_SOLUTION:
                failures.append(f'goal {number}: a goal out of reach ended with '
                                f'{found.error_code}: {found.message}')
        response = answer(result)
        end = response.status, response.result.error_code
        counts[(kind, *end)] += 1
        if end not in (ENDS[kind], REACHED):  # it may have ended before
            failures.append(f'goal {number}, {kind}: ended with {end}: {response.result.message}')
        if following is None:
            if end == REACHED and (off := np.linalg.norm(client.tip() - ways[-1])) > NEAR:
                failures.append(f'goal {number}: reached, but {off:.4f} m off')
            if kind == 'other motion':
                client.topic.publish(trajectory(rng, 3.0)[0])
                sleep(float(rng.uniform(0.0, 1.0)))
            following = places(rng)
            following = following, *client.move(following)
        ways, handle, result = following
    answer(result)
    print('endings by interruption, status and code:', dict(sorted(counts.items())))
    return failures + steps(list(client.states))


def main() -> int:
    """Run the soak."""
    goals, seed = (int(x) for x in (*sys.argv[1:], *('200', '0')[len(sys.argv) - 1:]))
    nodes = [subprocess.Popen([sys.executable, '-m', f'rrr_traj_planner.nodes.scripts.{name}',
                               '--ros-args', '--log-level', 'error'])
             for name in ('planner', 'simulated_arm', 'motion_server')]
    client = Client()
    try:
        failures = soak(client, goals, np.random.default_rng(seed))
    finally:
        client.close()
        for node in nodes:
            node.send_signal(signal.SIGINT)
        codes = [node.wait(10.0) for node in nodes]
    print(*failures, f'{goals} goals, {len(client.states)} states, {len(failures)} failures, '
          f'exit codes of the nodes {codes}', sep='\n')
    return 1 if failures or any(codes) else 0


if __name__ == '__main__':
    raise SystemExit(main())
