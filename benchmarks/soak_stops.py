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
Whether the arm comes to rest inside its ranges, whenever it is stopped.

    python benchmarks/soak_stops.py [MOTIONS [INSTANTS [SEED]]]

Motions of all planners in turn, with and without limits on acceleration and jerk, with and
without torque that binds, all of which end with joints at the ends of their ranges. Each is
followed by the simulated arm and stopped at random instants (`ControlledArm.hold`). What is judged
is where the arm comes to rest, the torques that it then has beside those of gravity, and what was
commanded on the way. Every failure is printed with its seed; the exit code is 1 if there was any.
"""

from __future__ import annotations

from collections import Counter
import sys
from time import perf_counter

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.control.computed_torque import ControllerGains
from rrr_traj_planner.core.dynamics.rigid_body import gravity_torque, inverse_dynamics
from rrr_traj_planner.core.errors import RrrPlannerError
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.simulation.arm_settings import ArmSettings
from rrr_traj_planner.core.simulation.controlled_arm import ControlledArm
from rrr_traj_planner.core.trajectory.trajectory_points import TrajectoryPoints
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.request import PlanningRequest

MODEL = RobotModel()
PLANNERS = ('cycloid', 'time_optimal', 'line_arc', 'time_optimal', 'line_polynomial', 'poly_434',
            'time_optimal', 'gauss', 'septic', 'cycloid_approach_a', 'cycloid_approach_b',
            'cycloid_approach_c', 'poly_414')
NONE = np.full(3, np.inf)
AFTER = 0.5         # s at rest before the arm is judged
BEYOND = 1e-6       # rad outside a range that count as outside
PUSHING = 0.5       # N m beside gravity that count as pushing
STILL = 1e-4        # rad/s
SLACK = 1.002       # of a limit


def random_limits(rng: np.random.Generator) -> JointLimits:
    """Return the thesis's ranges with limits of some kind."""
    kind = rng.integers(6)
    effort = np.array([150.0, 200.0, 200.0])
    if kind == 5:
        effort = np.exp(rng.uniform(np.log(60.0), np.log(400.0), 3)) * (0.5, 1.0, 0.7)
    return JointLimits(
        max_velocity=np.full(3, rng.choice([0.5, 1.0, 3.0])),
        max_acceleration=NONE if kind in (2, 3) else np.full(3, rng.choice([0.5, 1.0, 4.0])),
        max_jerk=NONE if kind in (1, 3) else np.full(3, rng.choice([5.0, 10.0, 100.0])),
        max_effort=effort)


def random_plan(rng: np.random.Generator, planner_id: str):
    """Return a plan that ends with joints at the ends of their ranges, and its limits."""
    while True:
        limits = random_limits(rng)
        q = rng.uniform((0.0, 0.0, -1.4), (np.pi / 2, 1.6, 1.4), (rng.integers(2, 5), 3))
        for row in (-1, rng.integers(len(q))):
            q[row, 0] = rng.choice([0.0, np.pi / 2, q[row, 0]], p=[0.4, 0.4, 0.2])
        if rng.random() < 0.5:
            q[-1, 1] = 0.0
        if (np.abs(gravity_torque(MODEL, q)) > 0.98 * limits.max_effort).any():
            continue
        try:
            return plan(MODEL, limits, PlanningRequest(
                forward_kinematics(MODEL, q), planner_id=planner_id, elbow='up' if (
                    q[0, 2] < np.pi / 2) else 'down')), limits
        except RrrPlannerError:
            continue


def points_of(answer) -> TrajectoryPoints:
    """Return a plan's points, as they arrive at the arm."""
    p = answer.points
    known = np.ones(len(p.times), dtype=bool)
    return TrajectoryPoints(p.times, p.positions, p.velocities, p.accelerations, known, known)


def motion_states(motion, arm: ControlledArm) -> np.ndarray:
    """Return the states that a motion still commands an arm, (n, 9)."""
    return np.array([motion(t) for t in np.arange(arm.time, motion.end, arm.settings.step)]
                    or [arm.desired])


def at_the_end(arm: ControlledArm, state: np.ndarray, limits: JointLimits) -> list[str]:
    """Return what is wrong with an arm that should be at rest."""
    found, q = [], state[:3]
    if ((q < limits.min_position - BEYOND) | (q > limits.max_position + BEYOND)).any():
        found.append(f'rests outside, at {q}')
    if ((arm.motion.final < limits.min_position)
            | (arm.motion.final > limits.max_position)).any():
        found.append(f'is to rest outside, at {arm.motion.final}')
    if np.abs(arm.torque - gravity_torque(MODEL, q)).max() > PUSHING:
        found.append(f'pushes with {arm.torque - gravity_torque(MODEL, q)} N m')
    if np.abs(state[3:]).max() > STILL:
        found.append(f'moves at {state[3:]}')
    if arm.stop_warnings:
        found.append(f'warns: {arm.stop_warnings}')
    return found


def over_limits(commanded: np.ndarray, planned: np.ndarray, limits: JointLimits,
                before: np.ndarray) -> list[str]:
    """Return the limits that a stop exceeds, and the motion before it or its rest does not."""
    torque, own_torque = (np.abs(inverse_dynamics(MODEL, x[:, :3], x[:, 3:6], x[:, 6:])).max(
        axis=0) for x in (commanded, planned))
    step = ArmSettings(MODEL, limits, ControllerGains()).step
    found = []
    acceleration = np.abs(np.diff(commanded[:, 3:6], axis=0)).max(
        axis=0, initial=0.0) / step
    for name, value, limit, own in (
            ('velocity', np.abs(commanded[:, 3:6]).max(axis=0), limits.max_velocity,
             before[3:6]),
            ('acceleration', acceleration, limits.max_acceleration, before[6:]),
            ('torque', torque, limits.max_effort, own_torque)):
        share = value / np.maximum(limit, own)
        if (share > SLACK).any():
            found.append(f'{name} at {share.max():.4f} of the limit')
    return found


class Judge:
    """What has become of the stops."""

    def __init__(self) -> None:
        self.counts: Counter[str] = Counter()
        self.seconds: list[float] = []
        self.durations: list[float] = []
        self.measured: list[float] = []

    def stop(self, label: str, points: TrajectoryPoints, limits: JointLimits,
             instant: float) -> None:
        """Follow a motion, stop it, and see."""
        arm = ControlledArm(ArmSettings(MODEL, limits, ControllerGains()), points.positions[0])
        arm.follow(points, 0)
        arm.advance(int(instant / arm.settings.step))
        before = np.abs(np.array(arm.desired))
        followed = arm.motion
        started = perf_counter()
        arm.hold()
        self.seconds.append(perf_counter() - started)
        self.durations.append(arm.motion.end - arm.time)
        commanded = motion_states(arm.motion, arm)
        exceeded = over_limits(commanded, motion_states(followed, arm), limits, before)
        states = [arm.state]
        for _ in range(int((self.durations[-1] + AFTER) / arm.settings.step)):
            arm.advance(1)
            states.append(arm.state)
        states = np.array(states)
        self.measured.append((np.abs(np.diff(states[:, 3:], axis=0)).max(axis=0) / (
            arm.settings.step * np.maximum(limits.max_acceleration, before[6:]))).max())
        for text in (*at_the_end(arm, states[-1], limits), *exceeded):
            self.counts[text.split()[0]] += 1
            print(f'{label}, stopped at {instant:.3f} s: {text}', flush=True)


def main() -> int:
    """Run the soak."""
    motions, instants, first = (int(x) for x in (*sys.argv[1:], *('200', '5', '0')[
        len(sys.argv) - 1:]))
    judge = Judge()
    for seed in range(first, first + motions):
        rng = np.random.default_rng(seed)
        planner_id = PLANNERS[seed % len(PLANNERS)]
        answer, limits = random_plan(rng, planner_id)
        points = points_of(answer)
        for instant in rng.uniform(0.0, points.times[-1], instants):
            judge.stop(f'seed {seed}, {planner_id}', points, limits, float(instant))
    print(f'{motions} motions, {len(judge.seconds)} stops, failures: {dict(judge.counts)}')
    for name, values in (('time to rest [s]', judge.durations), ('search [s]', judge.seconds),
                         ('measured acceleration / limit', judge.measured)):
        print(f'{name}, percentiles 50, 90, 99, 100: '
              + ', '.join(f'{x:.4g}' for x in np.percentile(values, (50, 90, 99, 100))))
    return 1 if judge.counts else 0


if __name__ == '__main__':
    raise SystemExit(main())
