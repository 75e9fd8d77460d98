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

"""Hard joint stops: which joints are in contact with theirs."""

from __future__ import annotations

from rrr_traj_planner.core.states import State, Triple

# For each joint: 1 at its lower stop, -1 at its upper one, 0 free.
Contact = tuple[int, int, int]

FREE: Contact = (0, 0, 0)

# A joint that would return to its stop within this part of a step counts as in contact. Without
# this bound, two joints at their stops exchange ever smaller velocities (Zeno behaviour). Chosen.
SHORTEST_REBOUND = 0.05


def contact(state: State, low: Triple, high: Triple) -> Contact:
    """
    Return the contacts of joints at or beyond a stop.

    Parameters
    ----------
    state : tuple of 6 floats
        Positions [rad] and velocities [rad/s].
    low, high : tuple of 3 floats
        Positions of the stops [rad].

    Returns
    -------
    tuple of 3 ints
        1 at the lower stop, -1 at the upper one, 0 between.

    """
    q1, q2, q3 = state[:3]
    return (_side(q1, low[0], high[0]), _side(q2, low[1], high[1]), _side(q3, low[2], high[2]))


def widened(state: State, low: Triple, high: Triple,
            width: float = 0.0) -> tuple[Triple, Triple]:
    """
    Return the stops; those of a joint beyond one, which was moved, include its position.

    Parameters
    ----------
    state : tuple of 6 floats
        Positions [rad] and velocities [rad/s].
    low, high : tuple of 3 floats
        Ends of the ranges [rad].
    width : float
        Distance of the stops behind the ends of the ranges [rad].

    Returns
    -------
    tuple of two tuples of 3 floats
        Positions of the lower and of the upper stops [rad].

    """
    (l1, l2, l3), (u1, u2, u3), (q1, q2, q3) = low, high, state[:3]
    return ((min(l1 - width, q1), min(l2 - width, q2), min(l3 - width, q3)),
            (max(u1 + width, q1), max(u2 + width, q2), max(u3 + width, q3)))


def clipped(state: State, low: Triple, high: Triple) -> State:
    """
    Return the state with joints beyond a stop set back onto it.

    Parameters
    ----------
    state : tuple of 6 floats
        Positions [rad] and velocities [rad/s].
    low, high : tuple of 3 floats
        Positions of the stops [rad].

    Returns
    -------
    tuple of 6 floats
        Positions between the stops; the velocities are unchanged.

    """
    (l1, l2, l3), (u1, u2, u3) = low, high
    q1, q2, q3 = state[:3]
    return (min(max(q1, l1), u1), min(max(q2, l2), u2), min(max(q3, l3), u3)) + state[3:]


def _side(q: float, low: float, high: float) -> int:
    if q <= low:
        return 1
    return -1 if q >= high else 0
