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
Linear motions with blends around the via points: approach (b) of thesis 4.2, after Paul.

The thesis cites Paul [42], in a list of references that we do not have: see Paul, Robot
Manipulators, MIT Press 1981, chapter 5; Siciliano et al., Robotics, 4.2.2 (linear polynomials with
blends).

In joint space the arm follows the lines between the via points. A transition, centred on the time
at which two lines meet in a via point, leads from the velocity of one to that of the other: it
cuts the corner, and the via point is missed. The first transition begins at the start and the last
ends at the end: these two points are reached. A via point's time is the middle of its transition.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.trajectory.pieces import TransitionFunction
from rrr_traj_planner.core.trajectory.piecewise import PiecewiseTrajectory
from rrr_traj_planner.planners.transitions.segment_motion import joint_profiles
from rrr_traj_planner.planners.transitions.transition_law import TransitionLaw
from rrr_traj_planner.planners.transitions.via_problem import ViaProblem

ROUNDING = 1e-9  # part of a limit, or of a line, up to which exceeding it is rounding; chosen

# Uncertainty of a change of velocity, as a part of the slower line's velocity (much more than
# 2^-52). The difference of two nearly equal velocities is rounding only: a transition that is just
# long enough for it would be of nearly zero duration, and of arbitrary jerk.
VELOCITY_UNCERTAINTY = 1e-9


class BlendTimes(NamedTuple):
    """Times of a motion with blends [s]."""

    lines: Array        # from one via point's corner to the next, shape (n,)
    transitions: Array  # around each via point, shape (n + 1,)


def changes_of_velocity(displacements: Array, lines: Array) -> Array:
    """
    Return the change of velocity at each via point, start and end included.

    Parameters
    ----------
    displacements : ndarray, shape (n, 3)
        From point to point [rad].
    lines : ndarray, shape (n,)
        Times from corner to corner [s].

    Returns
    -------
    ndarray, shape (n + 1, 3)
        [rad/s].

    """
    rest = np.zeros((1, 3))
    return np.diff(np.concatenate((rest, displacements / lines[:, np.newaxis], rest)), axis=0)


def shortest_transitions(law: TransitionLaw, displacements: Array, lines: Array) -> Array:
    """
    Return the shortest transitions that the limits allow, common to all joints.

    They keep the limits also if changes of velocity are larger by `VELOCITY_UNCERTAINTY`.

    Parameters
    ----------
    law : TransitionLaw
        Transitions' least durations.
    displacements : ndarray, shape (n, 3)
        From point to point [rad].
    lines : ndarray, shape (n,)
        Times from corner to corner [s].

    Returns
    -------
    ndarray, shape (n + 1,)
        [s].

    """
    changes = np.abs(changes_of_velocity(displacements, lines))
    speeds = np.abs(displacements) / lines[:, np.newaxis]
    changes[1:-1] += VELOCITY_UNCERTAINTY * np.minimum(speeds[:-1], speeds[1:])
    return np.asarray(law.least_time(changes).max(axis=1))


def excess(problem: ViaProblem, timing: BlendTimes) -> Array:
    """
    Return the largest ratios of a motion's quantities to their limits, torques not considered.

    Parameters
    ----------
    problem : ViaProblem
        The via points.
    timing : BlendTimes
        Times of the motion.

    Returns
    -------
    ndarray, shape (3,)
        Of velocity to its limit, of change of velocity to the largest that its transition allows,
        and of half of both transitions to the line that they share; feasible if at most 1.

    """
    lines, transitions = timing
    velocity = np.abs(problem.displacements) / lines[:, np.newaxis] / problem.max_velocity
    change = np.abs(changes_of_velocity(problem.displacements, lines))
    most = problem.law.largest_change(transitions[:, np.newaxis])
    with np.errstate(divide='ignore', invalid='ignore'):
        by_change = np.where(change > 0.0, change / most, 0.0)
    halves = 0.5 * (transitions[:-1] + transitions[1:])
    return np.array([velocity.max(), by_change.max(), (halves / lines).max()])


def is_within_limits(problem: ViaProblem, timing: BlendTimes) -> bool:
    """
    Return whether a motion keeps its limits, torques not considered.

    Parameters
    ----------
    problem, timing
        As in `excess`.

    Returns
    -------
    bool
        Within rounding.

    """
    return bool((timing.lines > 0.0).all() and (excess(problem, timing) <= 1.0 + ROUNDING).all())


def trajectory(points: Array, timing: BlendTimes,
               function: TransitionFunction) -> PiecewiseTrajectory:
    """
    Return the motion.

    Parameters
    ----------
    points : ndarray, shape (n + 1, 3)
        Joint positions at the via points [rad].
    timing : BlendTimes
        Its times; no line shorter than half of both its transitions, but for rounding.
    function : TransitionFunction
        The velocity function of transitions.

    Returns
    -------
    PiecewiseTrajectory
        Its via times are the start, the middles of the transitions between, and the end.

    """
    transitions = timing.transitions[:, np.newaxis]
    halves = 0.5 * (transitions[:-1] + transitions[1:])
    lines = np.maximum(timing.lines[:, np.newaxis], halves)
    rest = np.zeros((1, 3))
    v = np.concatenate((rest, np.diff(points, axis=0) / lines, rest))
    begin = points - 0.5 * v[:-1] * transitions
    leave = points + 0.5 * v[1:] * transitions
    cruises = np.append(lines - halves, [[0.0]], axis=0)
    with np.errstate(divide='ignore', invalid='ignore'):
        pieces = (function.transition(np.tile(transitions, 3), begin, v[:-1], v[1:]),
                  function.cruise(np.tile(cruises, 3), leave, v[1:]))
    corners = 0.5 * transitions[0, 0] + np.cumsum(lines)
    via_times = np.concatenate(([0.0], corners))
    via_times[-1] += 0.5 * transitions[-1, 0]
    return PiecewiseTrajectory(joint_profiles(pieces), via_times)
