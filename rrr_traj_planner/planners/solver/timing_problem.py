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
The least-time problem over segments between via points, as the compiled kernels see it.

The decision variables are those of `splines` (direct transcription: Betts, Practical Methods for
Optimal Control, 2010). Bounds hold for the states at the points of every segment, general
constraints for functions of a state: torques, or the joints' velocities, accelerations, jerks and
torques while the tip follows a path. Durations may be free, fixed or in fixed proportions, and
have lower bounds.
"""

from __future__ import annotations

import ctypes
from functools import cached_property
from typing import Any

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.kernels import contiguous, same_size_as
from rrr_traj_planner.planners.solver.library import Arena, KERNELS
from rrr_traj_planner.planners.solver.limits import DurationConstraints, FAR, Limits
from rrr_traj_planner.planners.solver.splines import Mesh, Variables
from rrr_traj_planner.planners.solver.workspace import ARRAYS, Size, Step, Workspace


@same_size_as('size_of_problem')
class _Problem(ctypes.Structure):  # as in native/timing_problem.h
    _fields_ = [
        *((name, ctypes.c_int32) for name in (
            'J', 'N', 'n', 'E', 'bounds', 'general', 'runs', 'bounded_alike', 'intervals')),
        *((name, ctypes.c_void_p) for name in (
            'points', 'parts', 'restore', 'lower', 'upper', 'general_lower', 'general_upper',
            'bound_runs', 'general_at', 'has_general', 'least_T')),
        ('longest', ctypes.c_double),
        *((name, ctypes.c_void_p) for name in (
            'free', 'proportions', 'weights', 'jerk_weights', 'fixed', 'arm', 'table', 'overshoot',
            'viscous', *ARRAYS)),
        ('shifted', ctypes.c_int32)]


class TimingProblem:
    """
    A timing problem, its iterate, and values and derivatives there.

    Parameters
    ----------
    mesh : Mesh
        Its n intervals in each segment.
    points : ndarray, shape (N + 1, J)
        Via points.
    limits : Limits
        The constraints.
    workspace : Workspace, optional
        Memory shared with problems that are solved before and after this one.

    Attributes
    ----------
    mesh, points, limits
        As given.
    address : object
        Of the problem, for the kernels.

    """

    def __init__(self, mesh: Mesh, points: Array, limits: Limits,
                 workspace: Workspace | None = None) -> None:
        self.mesh, self.points, self.limits = mesh, points, limits
        self._workspace = workspace or Workspace()
        N, n, J = len(points) - 1, mesh.n, points.shape[1]
        self._problem = _Problem(
            J=J, N=N, n=n, E=limits.general_lower.shape[-1], longest=FAR,
            bounded_alike=len(limits.lower) == 1,
            intervals=0 if limits.table is None else limits.table.shape[2])
        self._bound_arrays: dict[str, Array] = {}
        bound_at, general_at = map(np.flatnonzero, (limits.bounded, limits.general))
        self._problem.bounds, self._problem.general = len(bound_at), len(general_at)
        for name, values in (
                ('points', points), ('parts', mesh.parts), ('restore', mesh.restore),
                ('lower', limits.lower),
                ('upper', limits.upper), ('general_lower', limits.general_lower),
                ('general_upper', limits.general_upper), ('least_T', limits.least_T),
                *zip(('table', 'overshoot', 'viscous'), limits[-3:])):
            if values is not None:
                self._bind(name, contiguous(values))
        self._problem.arm = limits.arm and limits.arm.address
        first = np.flatnonzero(np.diff(bound_at, prepend=-2) > 1)
        lengths = np.diff(first, append=len(bound_at))
        self._problem.runs = len(first)
        self._bind('bound_runs',
                   np.column_stack((bound_at[first], lengths, first)).astype(np.int32))
        self._bind('general_at', general_at.astype(np.int32))
        self._bind('has_general', limits.general.any(axis=1).astype(np.uint8))
        self._shape = N, n, J
        self.address: Any = ctypes.byref(self._problem)

    def _bind(self, name: str, values: Any) -> None:
        """Give the kernels an array's address, and hold the array as long as the problem."""
        self._bound_arrays[name] = values
        setattr(self._problem, name, values.ctypes.data)

    @cached_property
    def _memory(self) -> tuple[Arena, list[Step]]:
        problem = self._problem
        arena, steps = self._workspace.memory(
            Size(*self._shape, problem.E, problem.bounds + problem.general,
                 self.limits.bounds_alone), self.address)
        for name in ARRAYS:
            setattr(problem, name, arena.addresses[name])
        return arena, steps

    @property
    def arrays(self) -> Arena:
        """Return the kernels' arrays, under the names of native/timing_problem.h."""
        return self._memory[0]

    @property
    def steps(self) -> list[Step]:
        """Return the memory of an iteration's steps; every second one has a correction."""
        return self._memory[1]

    def begin(self, motion: Variables, durations: DurationConstraints) -> None:
        """
        Set the first iterate, without shifts.

        Parameters
        ----------
        motion : Variables
            The iterate.
        durations : DurationConstraints
            Which durations and values at via points may change.

        """
        self.arrays['variables'][:] = motion.flat()
        self.arrays['shift'][:] = 0.0
        self._problem.shifted = 0
        self._bind('free', durations.free.astype(np.uint8))
        self._bind('proportions', contiguous(durations.proportions))
        self._bind('weights', contiguous(durations.weights))
        if durations.max_jerk is not None:
            self._bind('jerk_weights', contiguous(
                durations.jerk_weights(self.mesh.node_shares, motion.T)))
        self._bind('fixed', durations.fixed.astype(np.uint8))

    def shift(self, wider: Limits) -> None:
        """
        Relax every constraint to other limits where those are wider.

        Parameters
        ----------
        wider : Limits
            On the same quantities.

        """
        now = self.limits
        sides = [(wider.upper - now.upper, wider.general_upper - now.general_upper),
                 (now.lower - wider.lower, now.general_lower - wider.general_lower)]
        count = self._problem.bounds + self._problem.general
        shift = self.arrays['shift'][:2 * len(self.mesh.parts) * count].reshape(-1, count, 2)
        for side, (bounds, general) in enumerate(sides):
            shift[:, :self._problem.bounds, side] = bounds[:, now.bounded]
            shift[:, self._problem.bounds:, side] = general[:, now.general]
        np.maximum(shift, 0.0, out=shift)
        self._problem.shifted = 1

    @property
    def shifted(self) -> bool:
        """Return whether any constraint is relaxed."""
        return bool(self._problem.shifted)

    def slacks(self, motion: Variables) -> Array:
        """
        Return the slack of each constraint, in the order of native/timing_problem.h.

        Parameters
        ----------
        motion : Variables
            Any.

        Returns
        -------
        ndarray
            Positive where the constraint holds strictly.

        """
        flat = motion.flat()
        found = np.empty(self.arrays['slack'].size)
        KERNELS.timing_slacks(self.address, flat.ctypes.data, found.ctypes.data)
        return found

    def is_within(self, motion: Variables) -> bool:
        """
        Return whether a motion is strictly feasible, as an iterate must be.

        Parameters
        ----------
        motion : Variables
            Any.

        Returns
        -------
        bool
            False where a slack is 0.

        """
        return bool(self.slacks(motion).min() > 0.0)

    def motion(self, variables: Array) -> Variables:
        """
        Return a motion from the vector of its unknowns.

        Parameters
        ----------
        variables : ndarray
            See `Variables.flat`.

        Returns
        -------
        Variables
            Views, not copies.

        """
        N, n, J = self._shape
        via = np.empty((N + 1, J))
        return Variables(
            np.empty((N, n - 1, J)), via, via, via, np.empty(N)).with_values(variables)
