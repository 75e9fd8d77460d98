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

"""How fast the simulated arm runs without ROS: control and physics at 1 kHz."""

from __future__ import annotations

import argparse
from dataclasses import replace

from measuring import compared, in_turns, REPETITIONS, Row, setting, table
import numpy as np
from rrr_traj_planner.core.arm.friction import Friction
from rrr_traj_planner.core.arm.payload import Payload
from rrr_traj_planner.core.control.computed_torque import ControllerGains
from rrr_traj_planner.core.simulation.arm_settings import ArmSettings
from rrr_traj_planner.core.simulation.controlled_arm import ControlledArm
from rrr_traj_planner.core.simulation.encoder import EncoderSettings
from rrr_traj_planner.core.trajectory.trajectory_points import TrajectoryPoints
from rrr_traj_planner.planners.planning import plan
from tasks import ARM, gentle, WEAK
from tasks import table as thesis_table

TARGET = 1.0 / 50.0  # s for each simulated second
STEP = 0.001         # s


def rows(repetitions: int = REPETITIONS) -> list[Row]:
    """Return how long a motion takes to be simulated over how long it lasts."""
    task = thesis_table('6.1', gentle(WEAK), '')
    points = plan(task.model, task.limits, task.request).points
    every = np.ones(len(points.times), bool)
    motion = TrajectoryPoints(points.times, points.positions, points.velocities,
                              points.accelerations, every, every)
    plain = ArmSettings(ARM, task.limits, ControllerGains(), STEP)
    real = replace(
        plain, payload=Payload(2.0),
        model=replace(plain.model, friction=Friction((5.0, 5.0, 5.0), (2.0, 2.0, 2.0))),
        encoder=EncoderSettings(resolution=1e-5, noise=1e-5))
    steps = round(float(points.times[-1]) / STEP)
    simulated = STEP * steps
    arms = [ControlledArm(settings, points.positions[0]) for settings in (plain, real)]

    def run(arm: ControlledArm) -> None:
        arm.reset(points.positions[0])
        arm.follow(motion, arm.now)
        arm.advance(steps)

    medians = in_turns(*(lambda arm=arm: run(arm) for arm in arms), repetitions=repetitions)
    return [compared(f'simulated arm{what}, 1 kHz: time taken / time simulated', target, 1e3 * t,
                     1e3 * simulated, 'ms', medians.count)
            for what, target, t in zip(('', ' with friction, payload, noise'), (TARGET, None),
                                       medians.times)]


def main() -> None:
    """Print every ratio."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--repetitions', type=int, default=REPETITIONS)
    found = rows(parser.parse_args().repetitions)
    print(setting())
    print(table(found))
    print(f'simulated seconds per second: {1.0 / found[0].ratio:.0f}')


if __name__ == '__main__':
    main()
