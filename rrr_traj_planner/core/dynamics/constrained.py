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
Accelerations and velocities of an arm some of whose joints are held: by stops, or by friction.

A joint's reaction lies in a range: [-c, c] for Coulomb friction at rest, one-sided and unbounded
for a stop. The joint stays at rest with a reaction inside its range, or moves against the reaction
at an end of it. These are the optimality conditions of a strictly convex problem (Gauss's
principle of least constraint with dry friction; for velocities, Moreau's law of inelastic impact:
Moreau, Unilateral contact and dry friction in finite freedom dynamics, 1988), which has exactly
one solution, found among the at most 27 cases of three joints.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from itertools import product
from math import inf, isinf

from rrr_traj_planner.core.dynamics.arm_dynamics import solved, Terms
from rrr_traj_planner.core.states import Triple

# Least and largest reaction [N m], not above and not below 0; (0, 0) for a joint that moves.
Range = tuple[float, float]

NO_REACTION: Range = (0.0, 0.0)

# For each joint: 0 at rest, or the sign of the direction in which it moves.
_Case = tuple[int, int, int]


def held(t: Terms, x: Triple, lock: Sequence[int]) -> Triple:
    """
    Return rates with some joints held at rest by constraint torques of any size.

    Parameters
    ----------
    t : Terms
        At the position.
    x : tuple of 3 floats
        Free accelerations [rad/s^2], or velocities before an impact [rad/s].
    lock : sequence of 3 ints
        Not 0 for each joint that is held.

    Returns
    -------
    tuple of 3 floats
        Rates; exactly 0.0 for a joint that is held.

    """
    free = tuple(i for i in range(3) if not lock[i])
    return _moving(t, x, free, (0.0, 0.0, 0.0))


def rates_with_reactions(t: Terms, x: Triple, ranges: tuple[Range, Range, Range]) -> Triple:
    """
    Return the rates of an arm whose joints may stay at rest.

    Finds a with r = M (a - x) such that a_i = 0 and r_i in its range, or a_i > 0 and r_i at the
    lower end, or a_i < 0 and r_i at the upper one.

    Parameters
    ----------
    t : Terms
        At the position.
    x : tuple of 3 floats
        Accelerations without reactions [rad/s^2], or velocities before an impact [rad/s].
    ranges : tuple of 3 pairs of floats
        Least and largest reaction of each joint; may be infinite.

    Returns
    -------
    tuple of 3 floats
        Rates; exactly 0.0 for a joint that stays at rest.

    """
    best, least = (0.0, 0.0, 0.0), inf
    for case in _cases(tuple(limits == NO_REACTION for limits in ranges)):
        reaction, possible = [0.0, 0.0, 0.0], True
        for i, sign in enumerate(case):
            if sign:
                reaction[i] = ranges[i][sign < 0]
                possible = possible and not isinf(reaction[i])
        if not possible:
            continue
        free = tuple(i for i in range(3) if case[i])
        a = _moving(t, x, free, reaction)
        wrong = _inconsistency(t, x, a, case, ranges)
        if wrong <= 0.0:
            return a
        if wrong < least:  # rounding
            best, least = a, wrong
    return best


def permitted(t: Terms, x: Triple, at: Sequence[int]) -> Triple:
    """
    Return the permitted rates nearest to the free ones, in the kinetic metric.

    Minimises (y - x)' M (y - x) over y that moves no joint further into its stop. Since this is a
    projection, a stop never adds energy.

    Parameters
    ----------
    t : Terms
        At the position.
    x : tuple of 3 floats
        Free velocities [rad/s] or accelerations [rad/s^2].
    at : sequence of 3 ints
        1 for each joint at its lower stop, -1 at its upper one, else 0.

    Returns
    -------
    tuple of 3 floats
        Rates; exactly 0.0 for a joint that its stop holds.

    """
    if at[0] * x[0] >= 0.0 and at[1] * x[1] >= 0.0 and at[2] * x[2] >= 0.0:
        return x
    s1, s2, s3 = at
    return rates_with_reactions(t, x, (_SIDES[s1], _SIDES[s2], _SIDES[s3]))


def held_and_stopped(t: Terms, qd: Triple, lock: tuple[int, int, int],
                     at: tuple[int, int, int]) -> tuple[Triple, tuple[int, int, int]]:
    """
    Return velocities after joints are brought to rest, and which joints rest.

    Where the impulse that stops one joint drives another into its stop, that one rests too.

    Parameters
    ----------
    t : Terms
        At the position.
    qd : tuple of 3 floats
        Velocities before [rad/s].
    lock, at : tuple of 3 ints
        Not 0 for each joint that is brought to rest; each joint's stop, as in `permitted`.

    Returns
    -------
    velocities : tuple of 3 floats
        [rad/s].
    lock : tuple of 3 ints
        Not 0 for each joint at rest.

    """
    if not any(rests and v for rests, v in zip(lock, qd)) and not any(
            side * v < 0.0 for side, v in zip(at, qd)):
        return qd, lock
    while True:
        after = held(t, qd, lock)
        struck = [not rests and side * v < 0.0 for rests, side, v in zip(lock, at, after)]
        if not any(struck):
            return after, lock
        l1, l2, l3 = (rests or int(hit) for rests, hit in zip(lock, struck))
        lock = l1, l2, l3


_SIDES: dict[int, Range] = {0: NO_REACTION, 1: (0.0, inf), -1: (-inf, 0.0)}


@lru_cache
def _cases(moving: tuple[bool, ...]) -> list[_Case]:
    """
    Return all combinations of rest (0) and either direction, for joints of which some surely move.

    Combinations with more joints at rest come first.
    """
    signs = [(1,) if moves else (0, 1, -1) for moves in moving]
    return sorted(((a, b, c) for a, b, c in product(*signs)),
                  key=lambda case: sum(map(abs, case)))


def _matrix(t: Terms) -> tuple[Triple, Triple, Triple]:
    return (t.M11, t.M12, t.M13), (t.M12, t.M22, t.M23), (t.M13, t.M23, t.M33)


def _moving(t: Terms, x: Triple, free: tuple[int, ...], reaction: Sequence[float]) -> Triple:
    """Return rates of the free joints under given reactions, the others at rest."""
    M, rates = _matrix(t), [0.0, 0.0, 0.0]
    # M_FF (a_F - x_F) = r_F + M_FL x_L, with L the joints at rest
    pull = [reaction[i] + sum(M[i][j] * x[j] for j in range(3) if j not in free) for i in free]
    changes: Sequence[float]
    if len(free) == 3:
        changes = solved(t, *pull)
    elif len(free) == 2:
        i, j = free
        det = M[i][i] * M[j][j] - M[i][j] * M[i][j]
        changes = [(M[j][j] * pull[0] - M[i][j] * pull[1]) / det,
                   (M[i][i] * pull[1] - M[i][j] * pull[0]) / det]
    else:
        changes = [p / M[i][i] for p, i in zip(pull, free)]
    for i, change in zip(free, changes):
        rates[i] = x[i] + change
    a1, a2, a3 = rates
    return a1, a2, a3


def _inconsistency(t: Terms, x: Triple, a: Triple, case: _Case,
                   ranges: tuple[Range, Range, Range]) -> float:
    """Return by how much a case breaks its own assumptions; not above 0 where it does not."""
    M, wrong = _matrix(t), 0.0
    for i, sign in enumerate(case):
        if sign and ranges[i] != NO_REACTION:
            wrong = max(wrong, -sign * a[i] * M[i][i])
        elif not sign:
            reaction = sum(M[i][j] * (a[j] - x[j]) for j in range(3))
            wrong = max(wrong, ranges[i][0] - reaction, reaction - ranges[i][1])
    return wrong
