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

"""What the processes cost: import and start, memory of a large request, processor when idle."""

from __future__ import annotations

import argparse
import math
from pathlib import Path
import subprocess
import sys
import time

from measuring import compared, in_turns, REPETITIONS, Row, setting, table, timed
import numpy as np
from ros_processes import Client, MISSING, node, plan_request, Process, until
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from tasks import ARM, TIPS

if not MISSING:
    from sensor_msgs.msg import JointState
    from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

IMPORT, START, MEMORY = 0.5, 2.0, 300.0    # s, s, MB
IDLE_CPU, ARM_CPU = 0.01, 0.25             # of one core
WINDOW = 20.0                              # s in which processor time is counted
MANY = 1000                                # via points
PATIENCE = 60.0                            # s for an answer
MIDDLE, AMPLITUDE = (0.8, 1.1, 0.5), (0.6, 0.2, 0.5)  # rad, of a curve that the arm can follow
TURNS, PHASES = (3.0, 5.0, 7.0), (0.0, 1.0, 2.0)      # of each joint along it; rad
BARE = Path(__file__).with_name('bare_node.py')

TIMED_IMPORT = """
import time
begin = time.perf_counter()
{imports}
print(time.perf_counter() - begin)
"""
ALL_OF_CORE = """
from importlib import import_module
from pkgutil import iter_modules
import rrr_traj_planner.core as core
for module in iter_modules(core.__path__):
    import_module(f'rrr_traj_planner.core.{module.name}')
"""


def imports(repetitions: int = REPETITIONS) -> list[Row]:
    """Return how long all of the core takes to be imported, beside what is allowed and NumPy."""
    medians = in_turns(ALL_OF_CORE, 'import numpy', repetitions=repetitions,
                       measure=_import_seconds)
    return [compared('import of all of the core / 0.5 s', 1.0, medians.times[0], IMPORT,
                     count=medians.count),
            timed('import of all of the core / of NumPy', None, medians)]


def starts(repetitions: int = REPETITIONS) -> list[Row]:
    """Return how long the planner takes from its start to an answer's arrival."""
    def taken(command: tuple[object, ...]) -> float:
        with Client() as client:  # a fresh one, which no earlier process has met
            begin = time.perf_counter()
            with Process(*command) as process:
                client.service(process)(plan_request(TIPS['6.1']))
                return time.perf_counter() - begin

    medians = in_turns(('planner', '--ros-args', '--log-level', 'error'),
                       (sys.executable, BARE), repetitions=repetitions, measure=taken)
    return [compared('start of the planner to its first answer / 2 s', 1.0, medians.times[0],
                     START, count=medians.count),
            timed('start of the planner to its first answer / of a bare node', None, medians)]


def memory() -> list[Row]:
    """Return the memory that a request of 1,000 via points takes at most, over idle."""
    share = np.linspace(0.0, 2.0 * np.pi, MANY)[:, np.newaxis]
    tips = forward_kinematics(ARM, MIDDLE + AMPLITUDE * np.sin(TURNS * share + PHASES))
    rows = []
    for planner_id in ('cycloid', 'time_optimal'):
        with Client() as client, node(
                'planner', f'planning_time_limit:={PATIENCE}') as planner:
            call = client.service(planner)
            call(plan_request(TIPS['6.1']))
            idle = planner.memory()
            planner.forget_peak()
            try:
                answer = call(plan_request(tips, planner_id=planner_id), PATIENCE)
                what = f'{len(answer.trajectory.points):,} points'
                peak = planner.memory('VmHWM') - idle
            except TimeoutError:
                what, peak = f'NO ANSWER in {PATIENCE:.0f} s', math.inf
            rows.append(compared(f'memory, {planner_id}, {MANY:,} via points, {what} / 300 MB',
                                 1.0, peak, MEMORY, 'MB'))
    return rows


def processor(window: float = WINDOW) -> list[Row]:
    """Return processor time over time: of the idle planner, of the arm that follows a motion."""
    with Client() as client, node('planner') as planner, node('simulated_arm') as arm:
        states: list[JointState] = []
        client.node.create_subscription(JointState, 'joint_states', states.append, 10)
        publisher = client.node.create_publisher(JointTrajectory, 'joint_trajectory', 10)
        client.service(planner)
        until(lambda: states and publisher.get_subscription_count() > 0, arm, 'joint_states')
        publisher.publish(_slow_motion(states[-1], 2.0 * window))
        until(lambda: abs(states[-1].velocity[0]) > 0.0, arm, 'motion')
        processes, begin, count = (planner, arm), time.perf_counter(), len(states)
        before = [p.cpu() for p in processes]
        time.sleep(window)
        taken = [p.cpu() - b for p, b in zip(processes, before)]
        elapsed = time.perf_counter() - begin
        rate = (len(states) - count) / elapsed
    return [compared('processor, idle planner / time', IDLE_CPU, taken[0], elapsed),
            compared(f'processor, arm at {rate:.0f} Hz, following / time', ARM_CPU, taken[1],
                     elapsed)]


def rows(repetitions: int = REPETITIONS, window: float = WINDOW) -> list[Row]:
    """Return every row."""
    found = imports(repetitions)
    if MISSING:
        print(MISSING, flush=True)
        return found
    return [*found, *starts(repetitions), *memory(), *processor(window)]


def _import_seconds(code: str) -> float:
    """Return how long an import takes in a fresh interpreter, by its own clock [s]."""
    output = subprocess.run([sys.executable, '-c', TIMED_IMPORT.format(imports=code)],
                            check=True, capture_output=True, text=True).stdout
    return float(output)


def _slow_motion(state: JointState, duration: float) -> JointTrajectory:
    """Return a trajectory to a pose nearby [s]."""
    point = JointTrajectoryPoint(
        positions=[q + 0.1 for q in state.position], velocities=[0.0] * 3,
        accelerations=[0.0] * 3)
    point.time_from_start.sec = round(duration)
    return JointTrajectory(joint_names=list(state.name), points=[point])


def main() -> None:
    """Print every ratio."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--repetitions', type=int, default=REPETITIONS)
    parser.add_argument('--window', type=float, default=WINDOW,
                        help='seconds in which processor time is counted')
    options = parser.parse_args()
    found = rows(options.repetitions, options.window)
    print(setting())
    print(table(found))


if __name__ == '__main__':
    main()
