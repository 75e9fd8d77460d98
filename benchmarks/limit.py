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
The physical limit of a motion's time: direct transcription, solved with CasADi and IPOPT.

Each segment has nodes at equal intervals and constant jerk between them, which may jump; velocity,
acceleration, jerk, torque and position keep their limits at the nodes.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace
import sys
from typing import NamedTuple

import casadi as ca
import numpy as np
from rrr_traj_planner.core.arm.tables import ELEMENTS
from rrr_traj_planner.core.errors import RrrPlannerError
from rrr_traj_planner.core.trajectory.trajectory import Trajectory
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.tasks import JointTask
from tasks import NONE, Task, thesis_tasks

NODES = 60               # intervals in a segment; 240 change the thesis's tables by 0.05 % at most
TIME_SHARE = (0.2, 5.0)  # of the guessed durations, between which they are looked for
NEAR_KNOWN = 2e-3        # relative: what another discretisation of 60 intervals may differ by
OPTIONS = {'print_time': False, 'ipopt': {
    'print_level': 0, 'sb': 'yes', 'tol': 1e-7, 'max_iter': 1000, 'mu_strategy': 'adaptive'}}


class Limit(NamedTuple):
    """The least time that was found [s], and whether the solver says that it is a minimum."""

    duration: float
    solved: bool


def limit(task: JointTask, guesses: list[Trajectory], nodes: int = NODES,
          steps_at_ends: bool = True) -> Limit:
    """
    Return the least time of a task, the best of several starts.

    Parameters
    ----------
    task : JointTask
        Via points, arm and limits.
    guesses : list of Trajectory
        Motions through the same via points to start from; they need not keep the limits.
    nodes : int
        Intervals in a segment.
    steps_at_ends : bool
        Whether acceleration may begin and end with a step where there is no jerk limit.

    Returns
    -------
    Limit
        Of the best start that was solved.

    """
    problem = _Problem(task, nodes, steps_at_ends)
    found = [problem.solved_from(g) for g in guesses]
    return min(found, key=lambda s: (not s.solved, s.duration), default=Limit(np.nan, False))


class _Problem:
    """Unknowns q, qd, qdd at every node and the segments' durations, as one column."""

    def __init__(self, task: JointTask, nodes: int, steps_at_ends: bool) -> None:
        self.task, self.nodes, self.steps_at_ends = task, nodes, steps_at_ends
        segments = len(task.points) - 1
        rows = segments * nodes + 1
        q, v, a = (ca.SX.sym(name, rows, 3) for name in 'qva')
        T = ca.SX.sym('T', segments)
        h = ca.vertcat(*(ca.repmat(T[k] / nodes, nodes, 3) for k in range(segments)))
        a0, a1 = a[:-1, :], a[1:, :]
        gaps = [v[1:, :] - v[:-1, :] - h * (a0 + a1) / 2,
                q[1:, :] - q[:-1, :] - h * (v[:-1, :] + h * (a0 / 3 + a1 / 6))]
        conditions = [(g, 0.0, 0.0) for g in gaps]
        limits = task.limits
        for j in range(3):
            if np.isfinite(limits.max_jerk[j]):
                bound = limits.max_jerk[j]
                conditions += [((a1 - a0)[:, j] - bound * h[:, j], -np.inf, 0.0),
                               ((a1 - a0)[:, j] + bound * h[:, j], 0.0, np.inf)]
        if np.isfinite(limits.max_effort).any():
            conditions += [(tau, -bound, bound) for tau, bound in zip(
                _torques(task, q, v, a), limits.max_effort) if np.isfinite(bound)]
        x = ca.vertcat(*(ca.vec(part) for part in (q, v, a, T)))
        g = ca.vertcat(*(ca.vec(c[0]) for c in conditions))
        self._lower, self._upper = (np.concatenate([np.full(c[0].numel(), c[k])
                                                    for c in conditions]) for k in (1, 2))
        self._solver = ca.nlpsol('limit', 'ipopt', {'x': x, 'f': ca.sum1(T), 'g': g}, OPTIONS)

    def solved_from(self, guess: Trajectory) -> Limit:
        """Return the minimum that the solver finds from a motion."""
        times = guess.via_times
        t = np.concatenate([np.linspace(a, b, self.nodes, endpoint=False)
                            for a, b in zip(times[:-1], times[1:])] + [times[-1:]])
        q, v, a, _ = guess(t)
        T = np.diff(times)
        lower, upper = self._bounds(T)
        answer = self._solver(x0=_column(q, v, a, T), lbx=lower, ubx=upper, lbg=self._lower,
                              ubg=self._upper)
        return Limit(float(answer['f']), bool(self._solver.stats()['success']))

    def _bounds(self, T: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        limits, points = self.task.limits, self.task.points
        shape = ((len(points) - 1) * self.nodes + 1, 3)
        at = [[np.broadcast_to(sign * bound, shape).copy() for sign in (-1.0, 1.0)]
              for bound in (limits.max_velocity, limits.max_acceleration)]
        place = [np.broadcast_to(limits.min_position, shape).copy(),
                 np.broadcast_to(limits.max_position, shape).copy()]
        for side in (0, 1):
            place[side][::self.nodes] = points
            at[0][side][[0, -1]] = 0.0
            for j in range(3):
                if np.isfinite(limits.max_jerk[j]) or not self.steps_at_ends:
                    at[1][side][[0, -1], j] = 0.0
        return tuple(_column(place[s], at[0][s], at[1][s], TIME_SHARE[s] * T) for s in (0, 1))


def _torques(task: JointTask, q: ca.SX, v: ca.SX, a: ca.SX) -> list[ca.SX]:
    """Return Lagrange's torques of each joint at all rows of states, from the arm's tables."""
    one = [ca.SX.sym(name, 3) for name in 'qva']
    by, tables = [_functions(one[0], j) for j in range(3)], task.model.tables
    M = ca.SX(3, 3)
    for (i, j), element in zip(ELEMENTS, tables.inertia):
        M[i, j] = M[j, i] = sum(element[k, m] * by[1][k] * by[2][m]
                                for k, m in np.argwhere(element))
    V = sum(tables.potential[k, m, n] * by[0][k] * by[1][m] * by[2][n]
            for k, m, n in np.argwhere(tables.potential))
    momentum = M @ one[1]
    torque = ca.Function('torque', one, [
        M @ one[2] + ca.jtimes(momentum, *one[:2]) + ca.gradient(V, one[0])
        - ca.gradient(0.5 * ca.dot(one[1], momentum), one[0])])
    rows = [torque(*(x[k, :].T for x in (q, v, a))).T for k in range(q.rows())]
    return ca.horzsplit(ca.vertcat(*rows))


def _functions(q: ca.SX, joint: int) -> list[ca.SX]:
    """Return 1, cos q, sin q, cos 2 q, sin 2 q of a joint."""
    return [1.0, *(f(k * q[joint]) for k in (1, 2) for f in (ca.cos, ca.sin))]


def _column(q: np.ndarray, v: np.ndarray, a: np.ndarray, T: np.ndarray) -> np.ndarray:
    return np.concatenate([part.ravel(order='F') for part in (q, v, a)] + [T])


def limit_of(task: Task, own: Trajectory | None, steps_at_ends: bool = True) -> Limit:
    """Return the limit of a task, from our own motion on, if there is one, and a slow one."""
    slow = replace(task.limits, max_acceleration=np.minimum(task.limits.max_acceleration, 1.0),
                   max_jerk=np.minimum(task.limits.max_jerk, 10.0), max_effort=NONE)
    guesses = [] if own is None else [own]
    with suppress(RrrPlannerError):  # a joint's range may keep it from being planned
        guesses.append(plan(task.model, slow, task.asked_of('cycloid')).trajectory)
    return limit(task.joint_task(), guesses, steps_at_ends=steps_at_ends)


def main() -> int:
    """Compare the limits of the thesis's tables with the known ones, which begin with no step."""
    wrong = 0
    for task, known in thesis_tasks():
        guess = plan(task.model, task.limits, task.asked_of('time_optimal')).trajectory
        found = limit_of(task, guess, steps_at_ends=False)
        good = found.solved and abs(found.duration / known - 1.0) <= NEAR_KNOWN
        wrong += not good
        print(f'{task.name:40} {found.duration:8.4f} s, known {known:.4f} s, '
              f'ours {guess.duration:.4f} s{"" if good else "  WRONG"}', flush=True)
    return int(wrong > 0)


if __name__ == '__main__':
    sys.exit(main())
