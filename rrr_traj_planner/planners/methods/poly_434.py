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
`poly_434`: quartic lift-off, cubic cruise, quartic set-down in every segment (Lin's 4-3-4).

Approach (c) of thesis section 4.2: "each subtrajectory is composed of three segments, namely;
lift-off, cruise and set down", of polynomials as section 2.2.2 describes them. The thesis's
visiting points bound the subtrajectories: a lift-off begins and a set-down ends there, at rest;
Lin's lift-off and set-down points in between are free. All joints follow one law, so the arm moves
along straight lines in joint space. The law is the symmetric one of least time (`symmetric_434`);
where torque limits are active, the best that `torque_434` finds. Jerk steps at the joins and at
the via points.
"""

from __future__ import annotations

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.kinematics.travel_time import ViaPointBehaviour
from rrr_traj_planner.core.motion_laws.lin_434 import Lin434
from rrr_traj_planner.core.motion_laws.quartic import QUARTIC
from rrr_traj_planner.core.trajectory.piecewise import PiecewiseTrajectory
from rrr_traj_planner.core.trajectory.trajectory import Trajectory
from rrr_traj_planner.planners.registration import register
from rrr_traj_planner.planners.stops.stops_at_via_points import (
    kinematic_durations,
    may_exceed_torque,
    stopping_motion,
)
from rrr_traj_planner.planners.stops.symmetric_434 import (
    displacement_ratios,
    DisplacementRatios,
    fastest_symmetric,
    least_time,
)
from rrr_traj_planner.planners.stops.torque_434 import law_for_torque, Segment, STARTS
from rrr_traj_planner.planners.tasks import JointTask
from rrr_traj_planner.planners.torque_scaling import torque_time_scale
from rrr_traj_planner.planners.transitions.segment_motion import joint_profiles
from rrr_traj_planner.planners.transitions.via_problem import via_problem_of


@register('poly_434', some_durations=True,
          passing=ViaPointBehaviour('stop', 1.0 / QUARTIC.peak_acceleration))
def plan(task: JointTask) -> Trajectory:
    """
    Return the fastest 4-3-4 motion, or one of prescribed durations.

    Parameters
    ----------
    task : JointTask
        Via points, the arm and its limits; durations that are NaN are free.

    Returns
    -------
    Trajectory
        Within the limits.

    Raises
    ------
    InvalidInputError
        If a joint has no acceleration limit.
    TimingError
        If prescribed durations are too short; with feasible ones.
    LimitViolationError
        If gravity alone exceeds an effort limit between the via points.

    """
    ratios = displacement_ratios(via_problem_of(task, QUARTIC))
    symmetric = fastest_symmetric(ratios)
    floors = kinematic_durations(task, least_time(symmetric, ratios))
    lacking = may_exceed_torque(task, _motion(task.points, symmetric, floors))
    found = [_for_torque(task, k, DisplacementRatios(*(ratio[k] for ratio in ratios)),
                         _nth(symmetric, k), float(floors[k])) if lacking[k]
             else (_nth(symmetric, k), True) for k in range(len(floors))]
    laws = Lin434(*(np.array(field) for field in zip(*(law for law, _ in found))))
    quick = np.maximum(floors, kinematic_durations(task, least_time(laws, ratios)))
    note = _note([task.segment_number(k) for k, (_, whole) in enumerate(found) if not whole])
    return stopping_motion(task, quick, lambda own, durations: _motion(
        task.points[own.start:own.stop + 1], Lin434(*(field[own] for field in laws)), durations,
        note))


def _nth(laws: Lin434, k: int) -> Lin434:
    """Return one of several laws, fields of shape ()."""
    return Lin434(*(field[k] for field in laws))


def _motion(points: Array, laws: Lin434, durations: Array, note: str = '') -> PiecewiseTrajectory:
    """Return the motion by given laws, each of shape (n,), in given durations."""
    columns = Lin434(*(field[:, np.newaxis] for field in laws))
    pieces = columns.pieces(durations[:, np.newaxis], points[:-1], np.diff(points, axis=0))
    return PiecewiseTrajectory(
        joint_profiles(pieces), np.concatenate(([0.0], np.cumsum(durations))), note)


def _for_torque(task: JointTask, k: int, ratios: DisplacementRatios, law: Lin434,
                least_T: float) -> tuple[Lin434, bool]:
    """
    Return a segment's law of least time, and whether the search was completed.

    The given law is returned where it keeps torque limits in its least or prescribed time.
    """
    points = task.points[k:k + 2]
    task.should_stop()

    def total(law: Lin434) -> float:
        """Return the least duration of a law by all limits."""
        quick = max(least_T, float(kinematic_durations(task, least_time(law, ratios))))
        each = Lin434(*(np.array([field]) for field in law))
        motion = _motion(points, each, np.array([quick]))
        return quick * max(1.0, torque_time_scale(task, motion))

    least = total(law)
    enough = least_T if task.durations is None or np.isnan(task.durations[k]) else max(
        least_T, float(task.durations[k]))
    if least <= enough or np.isinf(least):
        return law, True
    segment = Segment(task.model, task.limits, points[0], points[1] - points[0], ratios)
    for start in (law, *STARTS):
        if task.should_stop():
            return law, False
        other = law_for_torque(segment, start, least, least_T)
        duration = np.inf if other is None else total(other)
        if other is not None and duration < least:
            law, least = other, duration
    return law, True


def _note(segments: list[int]) -> str:
    """Return the note on segments whose search was cancelled."""
    if not segments:
        return ''
    return ('planning time was over before the fastest 4-3-4 law within torque was found for '
            f'segment{"s" * (len(segments) > 1)} {", ".join(map(str, segments))}')
