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

"""The planning request."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from rrr_traj_planner.core.arrays import (
    Array,
    BoolArray,
    finite_array,
    IntArray,
    number_array,
    truth_array,
)
from rrr_traj_planner.core.cancellation import never, ShouldStop
from rrr_traj_planner.core.errors import counted, InvalidInputError, shown
from rrr_traj_planner.core.kinematics.postures import Elbow, ELBOWS, Shoulder, SHOULDERS
from rrr_traj_planner.core.read_only import ReadOnlyArrays
from rrr_traj_planner.core.rounding import JOINT_ROUNDING
from rrr_traj_planner.core.scalars import (
    not_negative,
    one_of,
    positive,
    positive_fraction,
    text,
    truth,
    whole_number,
)
from rrr_traj_planner.core.trajectory.sampling import check_size, MOST_POINTS, NANOSECOND
from rrr_traj_planner.planners.rests import Rests, rests_at_via_points
from rrr_traj_planner.planners.tasks import LEAST_JERK_RISE, StartRates, T_ACC

# The check of each field that is not an array: a function of its name and its value.
CHECKS: dict[str, Callable[[str, Any], Any]] = {
    'planner_id': text,
    'velocity_scaling': positive_fraction, 'acceleration_scaling': positive_fraction,
    'sample_period': partial(positive, unit='s'), 'max_deviation': partial(positive, unit='m'),
    'max_tip_speed': partial(positive, unit='m/s', may_be_infinite=True), 'steady_zones': truth,
    'half_transition': partial(positive, unit='s', least=NANOSECOND),
    'least_jerk_rise': partial(positive, unit='s', least=NANOSECOND),
    'max_points': partial(whole_number, least=1),
    'start_state_tolerance': partial(not_negative, unit='rad')}


@dataclass(frozen=True, eq=False)
class PlanningRequest(ReadOnlyArrays):
    """
    Via points and how to pass them.

    Parameters
    ----------
    via_points : array_like, shape (n, 3), optional
        Tip positions in the base frame [m]; at least two, or one with a start. None:
        `joint_via_points` are given.
    start : array_like, shape (3,), optional
        Joint positions [rad] where the motion starts; None: at the first via point.
    planner_id : str
        The method.
    segment_durations : array_like, optional
        Durations [s], one for each segment, without rests; NaN leaves a segment free, if the
        planner supports that. None: as fast as the limits allow.
    velocity_scaling, acceleration_scaling : float
        Factors in (0, 1] on the limits.
    sample_period : float
        Time between the points of the answer [s].
    elbow : {'up', 'down'}, optional
        Branch of the inverse kinematics at all via points. None: with a start, its own if that is
        possible; else those of the least estimated time.
    shoulder : {'front', 'back'}, optional
        Likewise.
    max_deviation : float
        Largest distance of a Cartesian path from the polyline [m].
    max_tip_speed : float
        Bound on the tip's speed along a Cartesian path [m/s]; infinite: none.
    steady_zones : bool
        Whether the tip keeps its speed on the curved zones of a Cartesian path.
    half_transition : float
        Half the length of a transition of `poly_414` [s], its t_acc.
    least_jerk_rise : float
        Shortest time in which jerk goes from zero to its limit [s]; used by `time_optimal`. Where
        a joint has no jerk limit it is at most the sample period.
    should_stop : callable
        Cancellation callback, called repeatedly; once it returns True, the best motion so far is
        the answer.
    max_points : int
        Largest number of points of the answer; a request that needs more is rejected.
    start_state_tolerance : float
        Distance by which the start may be outside a joint's range [rad]: the motion then starts
        at the end of the range.
    start_velocity, start_acceleration : array_like, shape (3,), optional
        With which the motion starts [rad/s], [rad/s^2]; None: zero.
    joint_via_points : array_like, shape (n, 3), optional
        Via points as joint positions [rad], in place of `via_points`. Their postures are their
        own: `elbow` and `shoulder` must be None.
    stop_at : array_like of bool, shape (n,), optional
        Whether the arm stops at each via point; it must at the last. Without a start it rests at
        the first in any case, where the motion starts. None: only at the last.
    dwell : array_like, shape (n,), optional
        Rest at each via point where the arm rests [s], 0 elsewhere; the one at the last is held
        after the motion. None: none.

    Raises
    ------
    InvalidInputError
        If a value is malformed.

    """

    via_points: Array | None = None
    start: Array | None = None
    planner_id: str = 'cycloid'
    segment_durations: Array | None = None
    velocity_scaling: float = 1.0
    acceleration_scaling: float = 1.0
    sample_period: float = 0.01
    elbow: Elbow | None = None
    shoulder: Shoulder | None = None
    max_deviation: float = 0.05
    max_tip_speed: float = np.inf
    steady_zones: bool = False
    half_transition: float = T_ACC
    least_jerk_rise: float = LEAST_JERK_RISE
    should_stop: ShouldStop = never
    max_points: int = MOST_POINTS
    start_state_tolerance: float = JOINT_ROUNDING
    start_velocity: Array | None = None
    start_acceleration: Array | None = None
    joint_via_points: Array | None = None
    stop_at: BoolArray | None = None
    dwell: Array | None = None

    def __post_init__(self) -> None:
        """Check every value and make the arrays read-only."""
        self._check_points()
        for name in ('start', 'start_velocity', 'start_acceleration'):
            if getattr(self, name) is not None:
                object.__setattr__(self, name, finite_array(name, getattr(self, name), (3,)))
        if self.start is None and self.start_rates is not None:
            raise InvalidInputError('start_velocity and start_acceleration need a start')
        needed = 2 if self.start is None else 1
        if self.number < needed:
            raise InvalidInputError(
                f'{counted(self.number, "via point")} given, at least {needed} needed')
        for name, checked in CHECKS.items():
            object.__setattr__(self, name, checked(name, getattr(self, name)))
        if self.elbow is not None:
            one_of('elbow', self.elbow, ELBOWS)
        if self.shoulder is not None:
            one_of('shoulder', self.shoulder, SHOULDERS)
        if not callable(self.should_stop):
            raise InvalidInputError(f'should_stop is {shown(self.should_stop)}, must be callable')
        if self.segment_durations is not None:
            self._check_durations()
        self._check_rests()

    def _check_points(self) -> None:
        given = [name for name in ('via_points', 'joint_via_points')
                 if getattr(self, name) is not None]
        if len(given) != 1:
            raise InvalidInputError(
                'via_points and joint_via_points are both given, must be one of the two' if given
                else 'via_points or joint_via_points must be given')
        object.__setattr__(self, given[0], finite_array(
            given[0], getattr(self, given[0]), (-1, 3)))
        if self.joint_via_points is not None:
            for name in ('elbow', 'shoulder'):
                if getattr(self, name) is not None:
                    raise InvalidInputError(
                        f'{name} is {shown(getattr(self, name))}, must be None: '
                        'joint_via_points have postures of their own')

    def _check_rests(self) -> None:
        dwell = self.rests.dwell
        if self.stop_at is not None:
            object.__setattr__(
                self, 'stop_at', truth_array('stop_at', self.stop_at, (self.number,)))
        if self.dwell is not None:
            object.__setattr__(self, 'dwell', dwell)
        durations = np.zeros(0) if self.segment_durations is None else self.segment_durations
        with np.errstate(over='ignore'):  # infinite is long enough
            check_size(float(np.nansum(durations) + dwell.sum()), self.sample_period,
                       self.max_points)

    def _check_durations(self) -> None:
        durations = number_array('segment_durations', [] if self.segment_durations is None
                                 else self.segment_durations, (-1,))
        object.__setattr__(self, 'segment_durations', durations)
        if len(durations) != self.segments:
            raise InvalidInputError(
                f'{len(durations)} segment_durations given for '
                f'{counted(self.segments, "segment")}')
        wrong = (durations < NANOSECOND) | np.isinf(durations)
        if wrong.any():
            k = int(wrong.argmax())
            raise InvalidInputError(
                f'segment_durations[{k}] is {durations[k]} s, must be finite and at least '
                f'{NANOSECOND} s')

    @property
    def number(self) -> int:
        """Return the number of via points."""
        points = self.joint_via_points if self.via_points is None else self.via_points
        return 0 if points is None else len(points)

    @property
    def rests(self) -> Rests:
        """Return where and how long the arm rests, for each via point."""
        return rests_at_via_points(self.stop_at, self.dwell, self.number, self.start is not None)

    @property
    def rest_points(self) -> IntArray:
        """Return where a part of the motion begins or ends: points, counted from the start."""
        started = self.start is not None
        return np.flatnonzero(np.concatenate(([True] * started, self.rests.at)))

    @property
    def segments(self) -> int:
        """Return the number of segments: between via points, and from the start to the first."""
        return self.number - (self.start is None)

    @property
    def start_rates(self) -> StartRates | None:
        """Return how the joints move at the start, None if they rest."""
        rates = StartRates(*(np.zeros(3) if f is None else f
                             for f in (self.start_velocity, self.start_acceleration)))
        return rates if any(f.any() for f in rates) else None
