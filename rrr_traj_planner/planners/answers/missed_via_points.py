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

"""The distances by which a motion with blends misses its via points, and the note about them."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.rounding import JOINT_ROUNDING
from rrr_traj_planner.core.trajectory.trajectory import Trajectory
from rrr_traj_planner.planners.plan import Plan


class ViaPointErrors(NamedTuple):
    """Distances from the via points at their times, shape (n,)."""

    tip: Array    # [m]
    joint: Array  # of the joint that is furthest [rad]


def via_point_errors(model: RobotModel, trajectory: Trajectory, via_times: Array,
                     q: Array) -> ViaPointErrors:
    """
    Return the distances of a motion from its via points at their times.

    Parameters
    ----------
    model : RobotModel
        The arm.
    trajectory : Trajectory
        The motion.
    via_times : ndarray, shape (n,)
        The via points' times [s]: the middle of its transition for one that is blended.
    q : ndarray, shape (n, 3)
        Joint positions at the via points [rad].

    Returns
    -------
    ViaPointErrors
        For each via point.

    """
    passed = trajectory(via_times)[0]
    difference = forward_kinematics(model, passed) - forward_kinematics(model, q)
    return ViaPointErrors(np.linalg.norm(difference, axis=1), np.abs(passed - q).max(axis=1))


def miss_note(found: ViaPointErrors) -> str:
    """
    Return the note on missed via points.

    Parameters
    ----------
    found : ViaPointErrors
        For each via point.

    Returns
    -------
    str
        Empty where every via point is reached.

    """
    missed = [f'{i} by {tip:.3g} m ({joint:.3g} rad)' for i, (tip, joint) in enumerate(
        zip(*found)) if joint > JOINT_ROUNDING]
    if not missed:
        return ''
    return f'via point{"s" * (len(missed) > 1)} missed by construction: {", ".join(missed)}'


def with_miss_note(model: RobotModel, answer: Plan, q: Array) -> Plan:
    """
    Return a plan with the distances by which it misses its via points in the note.

    Parameters
    ----------
    model : RobotModel
        The arm.
    answer : Plan
        The plan.
    q : ndarray, shape (n, 3)
        Joint positions at the via points [rad].

    Returns
    -------
    Plan
        Otherwise the same.

    """
    found = miss_note(via_point_errors(model, answer.trajectory, answer.via_times, q))
    return replace(answer, note='; '.join(filter(None, (answer.note, found))))
