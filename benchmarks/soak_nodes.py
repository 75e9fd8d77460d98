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
Whether both nodes stay well for a long time: memory, answers, pace.

    python benchmarks/soak_nodes.py [MINUTES [SEED]]

Planner and simulated arm run as processes of their own. A client asks for plans without a pause,
good ones and refused ones of every planner, sends what is planned to the arm, changes a limit and
back, and has the arm reset now and then. Printed are the nodes' memory (resident, MiB), answers by
code and the slowest answer. The exit code is 1 if a node ended, an answer was missing, a bug was
met, or its memory's median grew by more than GROWTH from the third to the last
quarter.
"""

from __future__ import annotations

from collections import Counter
import os
from pathlib import Path
import re
import signal
import subprocess
import sys
from threading import Thread
from time import monotonic, sleep

os.environ.setdefault('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
os.environ.setdefault('ROS_DOMAIN_ID', str(1 + os.getpid() % 101))

from geometry_msgs.msg import Point, Pose  # noqa: E402
import numpy as np  # noqa: E402
from rcl_interfaces.msg import Parameter as ParameterMessage  # noqa: E402
from rcl_interfaces.srv import SetParameters  # noqa: E402
import rclpy  # noqa: E402
from rclpy.executors import SingleThreadedExecutor  # noqa: E402
from rclpy.node import Node  # noqa: E402
from rclpy.parameter import Parameter  # noqa: E402
from rrr_traj_planner.core.arm.model import RobotModel  # noqa: E402
from rrr_traj_planner.core.kinematics.forward import forward_kinematics  # noqa: E402
from rrr_traj_planner.planners.registry import planner_ids  # noqa: E402
from rrr_traj_planner_interfaces.srv import PlanTrajectory  # noqa: E402
from std_srvs.srv import Trigger  # noqa: E402
from trajectory_msgs.msg import JointTrajectory  # noqa: E402

GROWTH = 5.0          # MiB
REPORT_PERIOD = 30.0  # s
TIMEOUT = 30.0        # s for an answer
LOW, HIGH = (0.1, 0.7, -1.0), (1.4, 2.2, 1.4)  # rad; most of these can be held
REFUSED = 0.2         # of the requests


class Client:
    """A client of both nodes."""

    def __init__(self, rng: np.random.Generator) -> None:
        rclpy.init()
        self.node, self.rng, self.codes = Node('soak'), rng, Counter()
        self.slowest, self.missing = (0.0, ''), 0
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(self.node)
        self._thread = Thread(target=self._executor.spin, daemon=True)
        self._thread.start()
        self._services = {
            name: self.node.create_client(type_, name) for type_, name in (
                (PlanTrajectory, 'plan_trajectory'), (Trigger, 'simulated_arm/reset'),
                (SetParameters, 'trajectory_planner/set_parameters'))}
        self._arm = self.node.create_publisher(JointTrajectory, 'joint_trajectory', 10)
        for name, client in self._services.items():
            if not client.wait_for_service(60.0):
                raise SystemExit(f'no {name}')
        while not self._arm.get_subscription_count():  # what is published before is lost
            sleep(0.1)

    def close(self) -> None:
        """End the client."""
        self._executor.shutdown(timeout_sec=5.0)
        self._thread.join(5.0)
        self.node.destroy_node()
        rclpy.try_shutdown()

    def call(self, name: str, request):
        """Return an answer, or None after a while."""
        began = monotonic()
        answer = self._services[name].call(request, timeout_sec=TIMEOUT)
        self.slowest = max(self.slowest, (
            monotonic() - began, f'{name} {getattr(request, "planner_id", "")}'))
        self.missing += answer is None
        return answer

    def step(self, number: int) -> None:
        """Ask once, and do something with the answer."""
        answer = self.call('plan_trajectory', self._request())
        if answer is not None:
            self.codes[answer.error_code] += 1
            if answer.error_code == answer.SUCCESS:
                self._arm.publish(answer.trajectory)
        if number % 50 == 0:
            self.call('simulated_arm/reset', Trigger.Request())
        if number % 20 == 0:
            value = float(self.rng.uniform(0.5, 1.0))
            self.call('trajectory_planner/set_parameters', SetParameters.Request(parameters=[
                ParameterMessage(name='joint_limits.joint_1.max_velocity', value=Parameter(
                    'x', value=value).get_parameter_value())]))

    def _request(self) -> PlanTrajectory.Request:
        rng = self.rng
        tips = forward_kinematics(RobotModel(), rng.uniform(LOW, HIGH, (rng.integers(2, 7), 3)))
        if rng.random() < REFUSED:
            tips[0] *= rng.choice((2.0, np.nan, 0.0, -1.0))
        request = PlanTrajectory.Request(planner_id=str(rng.choice(planner_ids())))
        request.via_points.poses = [
            Pose(position=Point(x=x, y=y, z=z)) for x, y, z in tips.tolist()]
        return request


def resident(pid: int) -> float:
    """Return a process's memory [MiB], what the system has put out of the way included."""
    text = Path(f'/proc/{pid}/status').read_text()
    return sum(int(kb) for kb in re.findall(r'Vm(?:RSS|Swap):\s+(\d+) kB', text)) / 1024.0


def soak(client: Client, nodes: dict[str, subprocess.Popen], seconds: float) -> bool:
    """Run until the time is over; return whether all is well."""
    began, number, told = monotonic(), 0, 0.0
    seen = []
    while (elapsed := monotonic() - began) < seconds:
        client.step(number := number + 1)
        if any(p.poll() is not None for p in nodes.values()):
            print('a node has ended')
            return False
        memory = {name: resident(p.pid) for name, p in nodes.items()}
        seen.append((elapsed / seconds, memory))
        if elapsed - told >= REPORT_PERIOD:
            told = elapsed
            print(f'{elapsed:5.0f} s  {number} requests  ' + '  '.join(
                f'{name} {mib:.1f} MiB' for name, mib in memory.items()), flush=True)
    # a large request is large for a moment: medians of the third and of the last quarter
    third, last = ([m for part, m in seen if low <= part < low + 0.25] for low in (0.5, 0.75))
    growth = {name: float(np.median([m[name] for m in last])
                          - np.median([m[name] for m in third])) for name in nodes}
    print(f'answers by code {dict(client.codes)}, missing {client.missing}, '
          f'slowest {client.slowest[0]:.2f} s ({client.slowest[1].strip()})')
    print('growth from the third quarter to the last: ' + '  '.join(
        f'{name} {mib:+.1f} MiB' for name, mib in growth.items()))
    return (client.missing == 0 and client.codes[PlanTrajectory.Response.FAILURE] == 0
            and max(growth.values()) <= GROWTH)


def main() -> int:
    """Run the soak."""
    minutes = float(sys.argv[1]) if len(sys.argv) > 1 else 10.0
    rng = np.random.default_rng(int(sys.argv[2]) if len(sys.argv) > 2 else 0)
    nodes = {name: subprocess.Popen([
        sys.executable, '-m', f'rrr_traj_planner.nodes.scripts.{name}',
        '--ros-args', '--log-level', 'fatal']) for name in ('planner', 'simulated_arm')}
    client = Client(rng)
    try:
        good = soak(client, nodes, 60.0 * minutes)
    finally:
        client.close()
        for process in nodes.values():
            process.send_signal(signal.SIGINT)
        codes = [process.wait(10.0) for process in nodes.values()]
    return 0 if good and codes == [0, 0] else 1


if __name__ == '__main__':
    raise SystemExit(main())
