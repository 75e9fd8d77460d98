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
The logarithmic barrier of the least-time problem over via velocities and durations.

For every segment and joint four constraints must be kept strictly: the displacement lies between
the least and the largest that the transition law allows in the duration, between the velocities
at the ends, and velocity changes by no more than the law allows, up or down. Via velocities have
bounds, durations may have least values. The barrier is the sum of -log(slack) (Boyd &
Vandenberghe, Convex Optimization, 11.2). Where a segment's part is not convex its Hessian is given
the magnitudes of its eigenvalues.
"""

from __future__ import annotations

import ctypes
from typing import Any, Protocol

from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.planners.solver.library import Arena, KERNELS


class Law(Protocol):
    """How long a transition by u must last: max(slope u, root sqrt(u)) [s]."""

    @property
    def slope(self) -> Array:
        """Return the part of a limit on acceleration, shape (3,) [s^2/rad]."""

    @property
    def root(self) -> Array:
        """Return the part of a limit on jerk, 0 without one, shape (3,) [s sqrt(s/rad)]."""


class ViaLimits(Protocol):
    """Via points, and what bounds the motion through them."""

    @property
    def displacements(self) -> Array:
        """Return the ways from point to point, shape (n, 3) [rad]."""

    @property
    def law(self) -> Law:
        """Return the transitions' law."""

    @property
    def max_velocity(self) -> Array:
        """Return the limits on velocity, shape (3,) [rad/s]."""

    @property
    def lowest(self) -> Array:
        """Return the least via velocities, shape (n - 1, 3) [rad/s]."""

    @property
    def highest(self) -> Array:
        """Return the largest via velocities, shape (n - 1, 3) [rad/s]."""


class _ViaProblem(ctypes.Structure):  # as in native/via_problem.h
    _fields_ = [('n', ctypes.c_int32), *((name, ctypes.c_void_p) for name in (
        'displacements', 'slope', 'root', 'max_velocity', 'lowest', 'highest', 'floor',
        'proportions', 'point', 'step', 'next', 'before', 'after', 'damping', 'gradient',
        'hessian', 'bound', 'band', 'right', 'pull', 'border')),
        ('objective', ctypes.c_double), ('decrement', ctypes.c_double)]


class ViaBarrier:
    """
    The barrier problem at an iterate, as the compiled kernels see it.

    Parameters
    ----------
    limits : ViaLimits
        The via points.
    v : ndarray, shape (n - 1, 3)
        Via velocities to begin with [rad/s].
    T : ndarray, shape (n,)
        Durations to begin with [s]; the point is strictly feasible.
    floor : ndarray, shape (n,), optional
        Least durations [s].
    proportions : ndarray, shape (n,), optional
        Durations of which a common multiple is sought [s], the least factor; None: durations are
        free, of least sum.

    Attributes
    ----------
    at : object
        The problem's address: what kernels are given.
    found : object
        What they found: objective at the iterate, and decrement, of the last attempt, squared.
    arrays : Arena
        What they work on, under the names of native/via_problem.h.
    constraints : int
        The number of logarithms.
    velocities, durations : ndarray
        The iterate: shapes (n - 1, 3) and (n,) [rad/s, s].

    """

    def __init__(self, limits: ViaLimits, v: Array, T: Array, floor: Array | None = None,
                 proportions: Array | None = None) -> None:
        n = len(T)
        law = limits.law
        given = {name: array for name, array in (
            ('displacements', limits.displacements), ('slope', law.slope), ('root', law.root),
            ('max_velocity', limits.max_velocity), ('lowest', limits.lowest),
            ('highest', limits.highest), ('floor', floor), ('proportions', proportions),
        ) if array is not None}
        unknowns, parts = (4 * n - 3,), (7 * n - 3,)
        self.arrays = Arena({
            **{name: array.shape for name, array in given.items()},
            'point': unknowns, 'step': unknowns, 'next': unknowns, 'before': parts,
            'after': parts, 'damping': parts, 'gradient': (n, 3, 3), 'hessian': (n, 3, 3, 3),
            'bound': (*unknowns, 2), 'band': (*unknowns, 5), 'right': (*unknowns, 2),
            'pull': unknowns, 'border': unknowns})
        for name, array in given.items():
            self.arrays[name][...] = array
        self.arrays['damping'][:] = 0.0
        self.found: Any = _ViaProblem(n=n, **self.arrays.addresses)
        self.found.arrays = self.arrays  # live as long as the problem
        self.at: Any = ctypes.byref(self.found)
        self.constraints = 12 * n + 6 * (n - 1)
        point = self.arrays['point']
        self.velocities, self.durations = point[:3 * n - 3].reshape(-1, 3), point[3 * n - 3:]
        self.velocities[:], self.durations[:] = v, T
        KERNELS.via_begin(self.at)
