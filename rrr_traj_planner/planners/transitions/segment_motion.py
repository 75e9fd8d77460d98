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
The transitions and the cruise of a segment, from end velocities, displacement and duration.

Thesis 4.2.3 and figure 4.5: transition, two transitions, or two transitions with a cruise between.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.kernels import contiguous
from rrr_traj_planner.core.motion_laws.cycloid_transitions import CYCLOID
from rrr_traj_planner.core.trajectory.joint_profile import JointProfile
from rrr_traj_planner.core.trajectory.pieces import Pieces, TransitionFunction
from rrr_traj_planner.core.trajectory.piecewise import PiecewiseTrajectory
from rrr_traj_planner.planners.solver.library import KERNELS
from rrr_traj_planner.planners.transitions.largest_displacement import largest_cruise
from rrr_traj_planner.planners.transitions.transition_law import SegmentLimits, TransitionLaw


class Segments(NamedTuple):
    """What the motions of consecutive segments are to meet."""

    v0: Array  # velocities at the beginning [rad/s], (n, 3)
    v1: Array  # and at the end
    T: Array   # durations [s], (n, 1)
    D: Array   # displacements [rad], (n, 3), within reach


class Parts(NamedTuple):
    """Durations of both transitions and the velocity between them, shapes (n, 3)."""

    first: Array   # [s]
    cruise: Array  # [rad/s]
    last: Array    # [s]


def low_acceleration_parts(limits: SegmentLimits, segments: Segments) -> Parts:
    """
    Return parts that cover a displacement in a given time, with long transitions where possible.

    Two transitions of half the segment each where the limits allow; else one at its limits and the
    other in the time that is left; else both as short as the limits allow, with a cruise between.

    Parameters
    ----------
    limits : SegmentLimits
        Transitions' least durations and the largest velocity.
    segments : Segments
        End velocities, durations and displacements.

    Returns
    -------
    Parts
        Within the limits.

    """
    def parts(given: Segments) -> Parts:
        found = _limited(limits, given)
        for share in (_share_of_last(limits.law, given), np.full_like(given.D, 0.5)):
            found = _where_allowed(limits, _split(share, given), found, given)
        return found

    return _mirrored(parts, segments)


def quick_parts(law: TransitionLaw, segments: Segments) -> Parts:
    """
    Return parts with both transitions as short as the limits allow (section 4.2.3).

    Parameters
    ----------
    law : TransitionLaw
        Transitions' least durations.
    segments : Segments
        End velocities, durations and displacements.

    Returns
    -------
    Parts
        As in the thesis a joint is slowed: at full acceleration, with a lower cruise velocity.

    """
    unlimited = SegmentLimits(law, np.full(3, np.inf))
    return _mirrored(lambda given: _limited(unlimited, given), segments)


def trajectory(points: Array, v0: Array, v1: Array, T: Array, parts: Parts,
               function: TransitionFunction = CYCLOID) -> PiecewiseTrajectory:
    """
    Return the motion composed of the parts of all segments.

    Parameters
    ----------
    points : ndarray, shape (n + 1, 3)
        Joint positions at the via points [rad].
    v0, v1 : ndarray, shape (n, 3)
        Velocities at the segments' ends [rad/s].
    T : ndarray, shape (n, 1)
        Durations [s].
    parts : Parts
        Of each segment.
    function : TransitionFunction
        The velocity function of transitions.

    Returns
    -------
    PiecewiseTrajectory
        Transition, cruise, transition in every segment; each begins exactly at its via point.

    """
    middle = np.maximum(T - parts.first - parts.last, 0.0)
    q1 = points[:-1] + 0.5 * (v0 + parts.cruise) * parts.first
    q2 = q1 + parts.cruise * middle
    with np.errstate(divide='ignore', invalid='ignore'):
        pieces = (function.transition(parts.first, points[:-1], v0, parts.cruise),
                  function.cruise(middle, q1, parts.cruise),
                  function.transition(parts.last, q2, parts.cruise, v1))
    return PiecewiseTrajectory(joint_profiles(pieces), np.concatenate(([0.0], np.cumsum(T))))


def joint_profiles(pieces: Sequence[Pieces]) -> list[JointProfile]:
    """
    Return the profiles of joints whose segments all consist of the same kinds of pieces.

    Parameters
    ----------
    pieces : sequence of Pieces
        In order of time; values of shape (n, 3), for each segment and joint. Those of zero
        duration are ignored.

    Returns
    -------
    list of JointProfile
        One for each joint.

    """
    lasting = np.stack([p.duration > 0.0 for p in pieces], axis=1)
    fields = [np.where(lasting, np.stack(f, axis=1), 0.0).reshape(-1, 3)
              for f in zip(*(np.broadcast_arrays(*p.parameters().values()) for p in pieces))]
    return [JointProfile(pieces[0].with_parameters(f[:, j] for f in fields)) for j in range(3)]


def _mirrored(parts: Callable[[Segments], Parts], segments: Segments) -> Parts:
    """
    Return parts for every case from a function for v0 <= v1 and D at least the mean velocity's.

    Cases of smaller displacement are mirrored in position, those with v0 > v1 reversed in time.
    """
    v0, v1, T, D = segments
    sign = np.where(D >= 0.5 * (v0 + v1) * T, 1.0, -1.0)
    a, b = sign * v0, sign * v1
    backwards = a > b
    found = parts(Segments(np.minimum(a, b), np.maximum(a, b), T, sign * D))
    return Parts(np.where(backwards, found.last, found.first), sign * found.cruise,
                 np.where(backwards, found.first, found.last))


def _split(share: Array, segments: Segments) -> Parts:
    """Return two transitions without a cruise, the last taking a share of the segment."""
    v0, v1, T, D = segments
    cruise = 2.0 * D / T - (1.0 - share) * v0 - share * v1
    return Parts((1.0 - share) * T, cruise, share * T)


def _share_of_last(law: TransitionLaw, segments: Segments) -> Array:
    """
    Return the part of a segment that is left for the last transition, at most a half.

    The first transition is at its acceleration limit, and there is no cruise.
    """
    v0, v1, T, D = segments
    excess = 2.0 * (D / T - 0.5 * (v0 + v1))
    with np.errstate(divide='ignore', invalid='ignore'):
        share = 1.0 - excess / (T / law.slope - (v1 - v0))
    return np.where(np.isfinite(share), np.clip(share, 0.0, 0.5), 0.5)


def _where_allowed(limits: SegmentLimits, preferred: Parts, otherwise: Parts,
                   segments: Segments) -> Parts:
    """Return the preferred parts where they keep the limits, else the others."""
    law = limits.law
    allowed = ((law.least_time(preferred.cruise - segments.v0) <= preferred.first)
               & (law.least_time(preferred.cruise - segments.v1) <= preferred.last)
               & (np.abs(preferred.cruise) <= limits.max_velocity) & (preferred.last > 0.0))
    return Parts(*(np.where(allowed, p, o) for p, o in zip(preferred, otherwise)))


def _limited(limits: SegmentLimits, segments: Segments) -> Parts:
    """
    Return parts at the limits, for v0 <= v1 and D at least the mean velocity's displacement.

    A cruise above both end velocities, with shortest transitions; or, where D is less than that of
    a cruise at v1, a single transition that lasts longer than the shortest one.
    """
    law, (v0, v1, T, D) = limits.law, segments
    high = np.maximum(largest_cruise(limits, v0, v1, T), v1)
    high = _cruise_covering(law, v1, high, segments)
    first, last = law.least_time(high - v0), law.least_time(high - v1)
    with np.errstate(divide='ignore', invalid='ignore'):
        longer = np.clip(2.0 * (v1 * T - D) / (v1 - v0), 0.0, T)
    single = v1 * T - 0.5 * (v1 - v0) * law.least_time(v1 - v0) >= D
    return Parts(np.where(single, np.where(v1 > v0, longer, 0.0), first),
                 np.where(single, v1, high), np.where(single, 0.0, last))


def _cruise_covering(law: TransitionLaw, low: Array, high: Array, segments: Segments) -> Array:
    """Return the least cruise velocity, shortest transitions given, that covers a displacement."""
    given = [contiguous(x) for x in (*law, low, *segments)]
    found = high.copy()
    bisections = 60  # to the last digit
    KERNELS.cruise_covering(
        len(segments.T), bisections, *(x.ctypes.data for x in (*given, found)))
    return found
