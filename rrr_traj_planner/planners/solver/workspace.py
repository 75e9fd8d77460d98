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

"""Memory of the timing problem's kernels, which problems solved one after the other share."""

from __future__ import annotations

import ctypes
from typing import Any, NamedTuple

from rrr_traj_planner.core.kernels import same_size_as
from rrr_traj_planner.planners.solver.library import Arena, KERNELS

STEPS = 4  # of one iteration: two Newton steps, each followed by its second-order correction

_STEP = {'direction': 'variables', 'correction': 'variables', 'rate': 'slack',
         'variables': 'variables', 'slack': 'slack'}  # a step's arrays; as large as which


@same_size_as('size_of_step')
class _Step(ctypes.Structure):  # as in native/timing_problem.h
    _fields_ = [*((name, ctypes.c_void_p) for name in _STEP),
                *((name, ctypes.c_double) for name in (
                    'predicted_decrease', 'max_relative_slack_decrease', 'cost', 'log',
                    'suggested_size'))]


class Step(NamedTuple):
    """A Newton step, and the result of a trial along it."""

    address: Any    # of the structure, for the kernels
    structure: Any  # see native/timing_problem.h


class Size(NamedTuple):
    """How large a problem is; see native/timing_problem.h."""

    N: int            # segments
    n: int            # intervals in a segment
    J: int            # coordinates
    E: int            # general constraints at a point, at most
    constraints: int  # of a segment
    diagonal: bool    # whether the Hessians are: with bounds alone


def _shapes(size: Size, newton: int) -> dict[str, tuple[int, ...]]:
    """Return the shapes of the arrays that kernels write, in the order of the structure."""
    N, n, J, E, constraints, diagonal = size
    P, Z = 2 * n + 1, 4 * J
    unknowns, slacks = (N * (n - 1) * J + 3 * (N + 1) * J + N,), (2 * N * (constraints + 1),)
    states, values = (N, P, Z), (N, P, E)
    hessian: tuple[int, ...] = states if diagonal else (N, P, Z, Z)
    return {
        'variables': unknowns, 'states': states, 'values': values, 'jacobian': (N, P, E, Z),
        'slack': slacks, 'inverse': slacks, 'dual': slacks, 'shift': slacks, 'hessian': hessian,
        'exact': (0,) if diagonal else hessian, 'gradient': states, 'gradient_T': (N,),
        'hessian_T': (N,), 'trial_variables': unknowns, 'trial_slack': slacks,
        'trial_gradient': states, 'trial_gradient_T': (N,), 'trial_states': (P, Z),
        'trial_values': (P, E), 'step_states': states, 'newton': (newton,)}


ARRAYS = tuple(_shapes(Size(1, 1, 1, 1, 1, False), 1))


class Workspace:
    """Memory shared by problems that are solved one after the other: allocation costs time."""

    def __init__(self) -> None:
        self._found: dict[Size, tuple[Arena, list[Step]]] = {}

    def memory(self, size: Size, problem: Any) -> tuple[Arena, list[Step]]:
        """
        Return memory for a problem's arrays, and for the steps of an iteration.

        Parameters
        ----------
        size : Size
            The problem's.
        problem : object
            Its address.

        Returns
        -------
        arena : Arena
            The same one for the same size.
        steps : list of Step
            In the arena; every second one has a correction.

        """
        if size not in self._found:
            shapes = _shapes(size, KERNELS.timing_newton_size(problem))
            arena = Arena(shapes | {f'{name} {k}': shapes[like] for k in range(STEPS)
                                    for name, like in _STEP.items()})
            self._found[size] = arena, [_step(arena, k) for k in range(STEPS)]
        return self._found[size]


def _step(arena: Arena, k: int) -> Step:
    direction, correction, *others = (arena.addresses[f'{name} {k}'] for name in _STEP)
    step = _Step(direction, correction if k % 2 else None, *others)
    return Step(ctypes.byref(step), step)
