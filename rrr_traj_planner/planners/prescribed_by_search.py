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

"""Durations that are prescribed to planners whose motion they determine: kept, or refused."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.errors import TimingError
from rrr_traj_planner.core.trajectory.piecewise import PiecewiseTrajectory
from rrr_traj_planner.core.trajectory.trajectory import Trajectory
from rrr_traj_planner.planners.request import JointTask
from rrr_traj_planner.planners.transitions.motion_law import cannot_hold, torque_stretch
from rrr_traj_planner.planners.transitions.transition_law import TransitionLaw

TORQUE_TOLERANCE = 5e-7  # of the stretch that torque asks for
ROUNDS = 12              # of trying gentler transitions
STRETCH = 1.3            # from one stretch that is tried to the next
MOST_STRETCH = 1e4
BISECTIONS = 20


def within_torque(task: JointTask, law: TransitionLaw,
                  motion_by: Callable[[TransitionLaw], PiecewiseTrajectory | None],
                  ) -> PiecewiseTrajectory | None:
    """
    Return a motion within all limits, with the fullest acceleration that torque allows.

    Parameters
    ----------
    task : JointTask
        The arm and its limits.
    law : TransitionLaw
        The fullest.
    motion_by : callable
        Returns the motion with the transitions of a law, or None where there is none.

    Returns
    -------
    PiecewiseTrajectory or None
        None where none is found.

    Raises
    ------
    LimitViolationError
        If gravity alone exceeds an effort limit on the way.

    """
    scale, too_full, too_gentle = 1.0, None, None  # of the acceleration
    for _ in range(ROUNDS):
        task.should_stop()
        motion = motion_by(TransitionLaw(law.slope / scale, law.root / scale ** 0.75))
        if motion is None:
            if too_full is None:
                return None
            too_gentle = scale
        else:
            stretch = torque_stretch(task, motion)
            if np.isinf(stretch):
                raise cannot_hold(task, motion)
            if stretch <= 1.0 + TORQUE_TOLERANCE:
                return motion
            too_full, scale = scale, scale / stretch ** 2
        if too_gentle is not None and too_full is not None:
            scale = max(float(np.sqrt(too_full * too_gentle)), scale if motion else 0.0)
    return None


def kept_or_refused(motion_in: Callable[[Array], PiecewiseTrajectory | None], durations: Array,
                    fastest: Callable[[], Array] | None = None) -> PiecewiseTrajectory:
    """
    Return the motion of given durations, or say which longer ones are feasible.

    Parameters
    ----------
    motion_in : callable
        Returns the motion of given durations, or None where there is none.
    durations : ndarray, shape (n,)
        [s].
    fastest : callable, optional
        Returns the durations of the fastest motion [s], below which, or below a multiple of
        which, none is offered; None: durations are offered in the proportion of those given.

    Returns
    -------
    PiecewiseTrajectory
        The motion.

    Raises
    ------
    TimingError
        If there is none; with feasible durations, none shorter than those given.

    """
    motion = motion_in(durations)
    if motion is not None:
        return motion
    if fastest is None:
        proportions, floor = durations, 0.0 * durations
        which = 'the least feasible in their proportion are'
    else:
        proportions, floor, which = fastest(), durations, 'feasible are'
    stretch = _least_stretch(motion_in, proportions, floor)
    if stretch is None:
        raise TimingError(
            f'segment_durations {durations.tolist()} s are too short, and no stretch of '
            'them is feasible')
    feasible = np.maximum(np.ceil(stretch * proportions * (1.0 + 1e-6) * 1e6) / 1e6, floor)
    asked, offered = ([round(float(d), 9) for d in v] for v in (durations, feasible))
    raise TimingError(f'segment_durations {asked} s are too short: {which} {offered} s',
                      tuple(offered))


def fastest_beside_stays(task: JointTask, fastest: Callable[[Array], Trajectory]) -> Array:
    """
    Return the durations of the fastest motion, of stays those that are prescribed.

    Parameters
    ----------
    task : JointTask
        With durations.
    fastest : callable
        Returns the fastest motion through points (m + 1, 3), none of which repeats.

    Returns
    -------
    ndarray, shape (n,)
        [s].

    """
    assert task.durations is not None
    stays = (np.diff(task.points, axis=0) == 0.0).all(axis=1)
    found = task.durations.copy()
    if not stays.all():
        found[~stays] = np.diff(fastest(task.points[np.append(True, ~stays)]).via_times)
    return found


def _least_stretch(motion_in: Callable[[Array], PiecewiseTrajectory | None], proportions: Array,
                   floor: Array) -> float | None:
    """Return the least factor, at least 1, on durations above a floor that makes them feasible."""
    def has_motion(factor: float) -> bool:
        return motion_in(np.maximum(factor * proportions, floor)) is not None

    low, high = 1.0, 1.0
    while not has_motion(high):
        low, high = high, STRETCH * high
        if high > MOST_STRETCH:
            return None
    for _ in range(BISECTIONS):
        middle = float(np.sqrt(low * high))
        low, high = (low, middle) if has_motion(middle) else (middle, high)
    return high
