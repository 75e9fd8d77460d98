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

"""What is wrong with answers that start moving: their first point, and their limits."""

from __future__ import annotations

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.dynamics.motor_torque import motor_torque
from rrr_traj_planner.planners.plan import Plan
from rrr_traj_planner.planners.request import PlanningRequest

STATE, RANGE = 1e-9, 1e-6  # rad (and its derivatives), rad
ALLOWED = 1.001            # times a limit: what a start may need


def other_start(answer: Plan, request: PlanningRequest) -> str:
    """Return how far an answer begins from the start state, nothing if it is near."""
    first = answer.points
    beside = np.max([np.abs(found[0] - asked).max() for found, asked in (
        (first.positions, request.start), (first.velocities, request.start_velocity),
        (first.accelerations, request.start_acceleration))])
    return f'begins {beside:.3g} beside the state' if beside > STATE else ''


def broken_limit(answer: Plan, limits: JointLimits, model: RobotModel, samples: int) -> str:
    """Return a limit that an answer's motion breaks at equally spaced times, nothing if none."""
    q, qd, qdd, jerk = answer.trajectory(np.linspace(0.0, answer.trajectory.duration, samples))
    if (q < limits.min_position - RANGE).any() or (q > limits.max_position + RANGE).any():
        return 'leaves a range'
    for name, found in (('max_velocity', qd), ('max_acceleration', qdd), ('max_jerk', jerk),
                        ('max_effort', motor_torque(model, q, qd, qdd))):
        ratio = (np.abs(found).max(axis=0) / getattr(limits, name)).max()
        if ratio > ALLOWED:
            return f'{name} times {ratio:.6f}'
    return ''
