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

"""A motion made of its parts, each from one stop to the next, and the rests at the stops."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array, BoolArray, IntArray
from rrr_traj_planner.core.motion_laws import cycloid
from rrr_traj_planner.core.trajectory.joined import joined
from rrr_traj_planner.core.trajectory.joint_profile import JointProfile
from rrr_traj_planner.core.trajectory.paused import PausedTrajectory
from rrr_traj_planner.core.trajectory.piecewise import PiecewiseTrajectory
from rrr_traj_planner.core.trajectory.trajectory import Trajectory
from rrr_traj_planner.planners.parts.spans import Span
from rrr_traj_planner.planners.request import PlanningRequest


class Part(NamedTuple):
    """A part of the motion, and its points."""

    span: Span
    motion: Trajectory | None  # through the points that do not repeat the one before, if it moves
    same: BoolArray            # which points, from the part's second on, repeat the one before

    @property
    def via_index(self) -> IntArray:
        """Return the index of each point, but the first, in the motion's via times."""
        return np.cumsum(~self.same)


class Whole(NamedTuple):
    """The whole motion."""

    trajectory: Trajectory
    via_index: IntArray  # of each via point in its via times


def whole_motion(request: PlanningRequest, parts: Sequence[Part], q: Array) -> Whole:
    """
    Return the motion of all parts, with rests where the arm dwells.

    Parameters
    ----------
    request : PlanningRequest
        Via points, and where the arm rests for how long.
    parts : sequence of Part
        One after another.
    q : ndarray, shape (3,)
        Where the motion begins [rad].

    Returns
    -------
    Whole
        If nothing moves: rest for all dwells, or for a sample period where there is none.

    """
    at, dwell = request.rests
    index = [0]  # of each point in the via times of the motion without rests
    for part in parts:
        index += (index[-1] + part.via_index).tolist()
    via_index = np.array(index[-request.number:], dtype=np.intp)
    moving = [part for part in parts if part.motion is not None]
    if not moving:
        duration = float(dwell.sum()) or request.sample_period
        times = np.concatenate(([0.0], np.cumsum(dwell)[:-1]))
        return Whole(_rest(q, duration, times), np.arange(request.number))
    motion = joined([part.motion for part in moving if part.motion is not None],
                    _note(request, moving))
    if request.stop_at is None and not dwell.any():
        return Whole(motion, via_index)
    return Whole(PausedTrajectory(motion, via_index, at, dwell), np.arange(request.number))


def _note(request: PlanningRequest, moving: Sequence[Part]) -> str:
    """Return the notes of all parts."""
    notes = [(part.span, part.motion.note) for part in moving if part.motion is not None]
    if len(notes) == 1:
        return notes[0][1]
    return '; '.join(f'{_named(request, span)}: {note}' for span, note in notes if note)


def _named(request: PlanningRequest, span: Span) -> str:
    """Return the name of a part, for notes."""
    started = request.start is not None
    first = 'the start' if started and span.first == 0 else f'via point {span.first - started}'
    return f'from {first} to via point {span.last - started}'


def _rest(q: Array, duration: float, via_times: Array) -> Trajectory:
    """Return a rest [s]."""
    return PiecewiseTrajectory([JointProfile(cycloid.cruise(
        np.array([duration]), np.array([position]), np.zeros(1))) for position in q], via_times)
