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

"""Seeded tasks that the benchmarks share: the thesis's tables, and random ones."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.dynamics.rigid_body import gravity_torque
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.kinematics.inverse import inverse_kinematics
from rrr_traj_planner.core.kinematics.joint_ranges import whole_turns
from rrr_traj_planner.core.kinematics.postures import ELBOWS, Posture
from rrr_traj_planner.planners.parts.posture_choice import first_possible
from rrr_traj_planner.planners.request import PlanningRequest
from rrr_traj_planner.planners.tasks import JointTask
from rrr_traj_planner.planners.via_points import joint_via_points

ARM = RobotModel()
HOLDABLE = 0.999     # of an effort limit, at a drawn via point
MOST_TRIES = 2000    # at drawing a pose
SAME_POSE = 1e-6     # rad, to which inverse kinematics must give a drawn pose back
NONE = np.full(3, np.inf)

TIPS = {  # tip positions of the thesis's tables [m]
    '6.1': ((1.02, 0.59, 0.97), (0.46, 0.55, 1.44), (0.45, 0.38, 1.45)),
    '6.3': ((0.2, 0.8, 0.5), (0.5, 1.0, 1.0), (0.8, 1.2, 0.6)),
}
WEAK, STRONG = [150.0, 200.0, 200.0], [150.0, 250.0, 200.0]  # N m; 6.3 needs the stronger joint 2


@dataclass(frozen=True, eq=False)
class Task:
    """A request, what it is made to, and a name to print."""

    name: str
    limits: JointLimits
    request: PlanningRequest
    model: RobotModel = ARM

    def joint_task(self) -> JointTask:
        """Return what a joint-space planner is given for it."""
        r = self.request
        q = first_possible(
            [Posture(elbow) for elbow in ((r.elbow,) if r.elbow else ELBOWS)],
            lambda posture: joint_via_points(self.model, self.limits, r.via_points, None, posture),
            lambda failures: failures[0])
        return JointTask(self.model, self.limits, q, None, r.sample_period)

    def asked_of(self, planner_id: str) -> PlanningRequest:
        """Return its request to a planner."""
        return replace(self.request, planner_id=planner_id)


def gentle(effort: object = NONE) -> JointLimits:
    """Return velocity 1 rad/s, acceleration 1 rad/s^2, jerk 10 rad/s^3 and given torques."""
    return JointLimits(max_effort=effort)


def full_torque(effort: object = WEAK, jerk: float = 100.0) -> JointLimits:
    """Return velocity 1 rad/s, no acceleration limit, a jerk limit and the motors' torques."""
    return JointLimits(max_acceleration=NONE, max_jerk=np.full(3, jerk), max_effort=effort)


def table(name: str, limits: JointLimits, label: str) -> Task:
    """Return the task of one of the thesis's tables."""
    return Task(f'table {name}, {label}', limits, PlanningRequest(TIPS[name]))


def thesis_tasks() -> list[tuple[Task, float]]:
    """Return the five cases whose limits are known, each with the known limit [s]."""
    return [
        (table('6.1', gentle(WEAK), 'v 1, a 1, jerk 10, torque'), 2.1285),
        (table('6.3', gentle(STRONG), 'v 1, a 1, jerk 10, torque'), 2.5815),
        (table('6.1', full_torque(WEAK), 'v 1, jerk 100, torque'), 1.0490),
        (table('6.3', full_torque(STRONG), 'v 1, jerk 100, torque'), 1.5389),
        (table('6.1', full_torque(WEAK, np.inf), 'v 1, torque'), 0.9181),
    ]


def random_task(rng: np.random.Generator, limits: JointLimits, points: int, name: str) -> Task:
    """Return a task through random poses of the thesis's arm that its own motors can hold."""
    elbow = 'up' if rng.random() < 0.5 else 'down'
    q = np.array([random_pose(rng, ARM, limits, elbow, WEAK) for _ in range(points)])
    return Task(name, limits, PlanningRequest(forward_kinematics(ARM, q), elbow=elbow))


def random_pose(rng: np.random.Generator, model: RobotModel, limits: JointLimits, elbow: str,
                effort: object) -> np.ndarray:
    """
    Return a random pose on a branch, within its range, that given torques can hold.

    Raises LookupError where none is found.
    """
    low = np.maximum(limits.min_position, (-np.pi, -np.pi, -0.5 * np.pi))
    high = np.minimum(limits.max_position, (np.pi, np.pi, 1.5 * np.pi))
    for _ in range(MOST_TRIES):
        q = rng.uniform(low, high)
        if is_usable(model, limits, q, elbow, effort):
            return q
    raise LookupError('no pose can be held')


def is_usable(model: RobotModel, limits: JointLimits, q: np.ndarray, elbow: str,
              effort: object) -> bool:
    """Return whether a pose can be held, and its tip's position gives it back."""
    if not (np.abs(gravity_torque(model, q)) <= HOLDABLE * np.asarray(effort)).all():
        return False
    back = inverse_kinematics(model, forward_kinematics(model, q), elbow, q)
    back = back + whole_turns(back[np.newaxis], limits, q)
    return bool(np.abs(back - q).max() < SAME_POSE)


def random_tasks(seed: int, count: int, limits: JointLimits) -> list[Task]:
    """Return tasks of 2 to 8 via points."""
    rng = np.random.default_rng(seed)
    return [random_task(rng, limits, 2 + k % 7, f'random {seed}/{k}') for k in range(count)]
