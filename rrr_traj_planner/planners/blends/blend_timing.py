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
The least times of a motion with blends around the via points, by sequential linear programming.

With the rates r = 1 / T of the lines as unknowns, velocities are linear and the total time is
convex, and so are all constraints but two: half of both transitions must fit into their line, and
transitions are bounded by the jerk limit. These are replaced by their tangents at the last
solution, which lie inside the feasible set (convex-concave procedure: Lipp & Boyd, Optimization
and Engineering 17, 2016), so that no linear program's solution is slower than the one before. The
convex 1 / r is bounded from below by tangents, which accumulate (Kelley's cutting planes, J. SIAM
8, 1960).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.planners.blends.blend_motion import (
    BlendTimes,
    excess,
    ROUNDING,
    shortest_transitions,
)
from rrr_traj_planner.planners.tolerances import DURATION_MARGIN
from rrr_traj_planner.planners.transitions.via_problem import ViaProblem
from scipy import sparse
from scipy.optimize import linprog

# Chosen values, without unit: half and twice of them (a tenth and ten
# times of GAIN and LOWEST_RATE) change none of 20 random plans by more than 0.003 %.
GAIN = 1e-5             # part of the time, below which a round is the last
FIRST_TANGENTS = np.geomspace(1.0, 30.0, 12)  # of 1 / r, at these multiples of the first rates
LOWEST_RATE = 1e-3      # bound of a linear program, as a part of the present rate
# Least duration of the transition at which the jerk limit's tangent is taken, as a part of the
# shorter line: at zero duration, between lines of equal velocity, the tangent would be vertical
# and the duration would stay zero.
LEAST_TANGENT = 0.05


def fastest(problem: ViaProblem, transitions: Array | None,
            should_stop: Callable[[], bool]) -> BlendTimes:
    """
    Return the times of least sum within the limits on velocity, acceleration and jerk.

    Parameters
    ----------
    problem : ViaProblem
        The via points; no displacement zero in all joints.
    transitions : ndarray, shape (n + 1,), optional
        Lengths of the transitions [s]; None: free.
    should_stop : callable
        Cancellation callback, called before every round; True ends the method with the best times.

    Returns
    -------
    BlendTimes
        The times.

    """
    best = _feasible(problem, problem.rest_to_rest_times(), transitions)
    program = _Program(problem, transitions, best)
    point = best
    for _ in range(40):  # linear programs, at most
        solved = None if should_stop() else program.solved(point)
        if solved is None:
            break
        point, found = solved, _feasible(problem, solved.lines, transitions)
        gain = total_time(best) - total_time(found)
        if gain > 0.0:
            best = found
        if abs(gain) < GAIN * total_time(best):
            break
    return best._replace(lines=best.lines * (1.0 + DURATION_MARGIN))


def total_time(timing: BlendTimes) -> float:
    """
    Return the duration of a motion.

    Parameters
    ----------
    timing : BlendTimes
        Its times.

    Returns
    -------
    float
        [s].

    """
    return float(timing.lines.sum() + 0.5 * (timing.transitions[0] + timing.transitions[-1]))


def _feasible(problem: ViaProblem, lines: Array, transitions: Array | None) -> BlendTimes:
    """Return times scaled up, where necessary, until they keep the limits."""
    for _ in range(60):  # at most, for rounding in the solution of a linear program
        timing = BlendTimes(lines, shortest_transitions(
            problem.law, problem.displacements, lines) if transitions is None else transitions)
        velocity, change, halves = excess(problem, timing)
        if transitions is None:  # changes are feasible; transitions shorten like the root or less
            change = 0.0
            halves = np.sqrt(halves) if halves > 1.0 + ROUNDING else halves ** (2.0 / 3.0)
        factor = max(velocity, change, halves)
        if factor <= 1.0:
            return timing
        lines = lines * factor
    return BlendTimes(lines, timing.transitions)


class _Rows(NamedTuple):
    """Rows of a linear program: matrix @ unknowns <= bound."""

    matrix: sparse.csr_array
    bound: Array


class _Program:
    """The linear programs. Unknowns: rates (n), transitions (n + 1) and times of lines (n)."""

    def __init__(self, problem: ViaProblem, transitions: Array | None, start: BlendTimes) -> None:
        self.problem, self.transitions = problem, transitions
        self.unit = float(start.lines.mean())  # of time [s]: scales all unknowns to about 1
        self.n = len(start.lines)
        self.tangents = [self.unit / start.lines * factor for factor in FIRST_TANGENTS]
        D = problem.displacements / self.unit
        n = self.n
        velocities = sparse.diags(D.ravel()) @ sparse.kron(sparse.eye(n), np.ones((3, 1)))
        none = sparse.csr_array((3, n))
        self.changes = sparse.csr_array(
            sparse.vstack((velocities, none)) - sparse.vstack((none, velocities)))
        self.own_transition = sparse.csr_array(
            sparse.kron(sparse.eye(n + 1), np.ones((3, 1))))
        self.halves = sparse.csr_array(
            0.5 * (sparse.eye(n, n + 1) + sparse.eye(n, n + 1, k=1)))

    def solved(self, at: BlendTimes) -> BlendTimes | None:
        """Return the solution of the program with tangents at given times; None if it fails."""
        rates, unit, n = self.unit / at.lines, self.unit, self.n
        self.tangents.append(rates)
        rows = [self._transitions_fit(rates), self._times_above_tangents()]
        rows += self._changes_within_limits() if self.transitions is not None else (
            self._long_transitions(rates, at.transitions / unit))
        with np.errstate(divide='ignore'):
            fastest_rates = unit * (self.problem.max_velocity / np.abs(
                self.problem.displacements)).min(axis=1)
        free = (np.zeros(n + 1), np.full(n + 1, np.inf))
        low, high = free if self.transitions is None else (self.transitions / unit,) * 2
        cost = np.concatenate((np.zeros(n), [0.5], np.zeros(n - 1), [0.5], np.ones(n)))
        answer = linprog(
            cost, A_ub=sparse.vstack([r.matrix for r in rows]).tocsc(),
            b_ub=np.concatenate([r.bound for r in rows]),
            bounds=np.column_stack((np.concatenate((LOWEST_RATE * rates, low, np.zeros(n))),
                                    np.concatenate((fastest_rates, high, np.full(n, np.inf))))))
        if answer.status != 0:
            return None
        return BlendTimes(unit / answer.x[:n], unit * answer.x[n:2 * n + 1])

    def _row(self, by_rate: sparse.sparray | None, by_transition: sparse.sparray | None,
             by_time: sparse.sparray | None, bound: Array) -> _Rows:
        """Return rows from their blocks for rates, transitions and times."""
        m, n = len(bound), self.n
        parts = [sparse.csr_array((m, size)) if part is None else part for part, size in (
            (by_rate, n), (by_transition, n + 1), (by_time, n))]
        return _Rows(sparse.csr_array(sparse.hstack(parts)), bound)

    def _transitions_fit(self, rates: Array) -> _Rows:
        """Return the constraint that half of both transitions is at most 1 / r, by its tangent."""
        return self._row(sparse.diags(1.0 / rates ** 2), self.halves, None, 2.0 / rates)

    def _times_above_tangents(self) -> _Rows:
        """Return the constraint that times are at least 1 / r, by its tangents."""
        r = np.concatenate(self.tangents)
        line = np.tile(np.arange(self.n), len(self.tangents))
        by_rate, by_time = (sparse.csr_array(
            (values, (np.arange(r.size), line)), shape=(r.size, self.n))
            for values in (-1.0 / r ** 2, np.full(r.size, -1.0)))
        return self._row(by_rate, None, by_time, -2.0 / r)

    def _changes_within_limits(self) -> list[_Rows]:
        """Return the constraint on changes of velocity by transitions of fixed durations."""
        assert self.transitions is not None
        most = self.problem.law.largest_change(self.transitions[:, np.newaxis]).ravel()
        return [self._row(side * self.changes, None, None, most) for side in (1.0, -1.0)]

    def _long_transitions(self, rates: Array, transitions: Array) -> list[_Rows]:
        """Return the constraint that transitions last as long as acceleration and jerk require."""
        slope = np.tile(self.problem.law.slope / self.unit, self.n + 1)
        squared = np.tile((self.problem.law.root / self.unit) ** 2, self.n + 1)
        lines = np.append(np.append(np.inf, 1.0 / rates), np.inf)
        now = np.repeat(np.maximum(
            transitions, LEAST_TANGENT * np.minimum(lines[:-1], lines[1:])), 3)
        rows = []
        for side in (1.0, -1.0):
            by_rate = side * sparse.diags(slope) @ self.changes
            rows.append(self._row(by_rate, -self.own_transition, None, np.zeros(len(now))))
            by_rate = side * sparse.diags(squared) @ self.changes
            rows.append(self._row(by_rate, -2.0 * sparse.diags(now) @ self.own_transition,
                                  None, -now ** 2))
        return rows
