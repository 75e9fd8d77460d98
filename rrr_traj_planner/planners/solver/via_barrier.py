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

For every segment and joint there are four constraints: the displacement is between the least and
the largest that the transition law allows in the duration and between the end velocities, and the
change of velocity is between those that it allows. Via velocities have bounds, durations may have
lower bounds. The barrier is the sum of -log(slack) (Boyd & Vandenberghe, Convex Optimization,
11.2). Where the term of a segment and joint is not convex, the eigenvalues of its Hessian are
replaced by their magnitudes (Nocedal & Wright, Numerical Optimization, 3.4).
"""

from __future__ import annotations

import ctypes
from typing import Any, Protocol

from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.kernels import same_size_as
from rrr_traj_planner.planners.solver.library import Arena, KERNELS


class Law(Protocol):
    """The least duration of a change of velocity u: max(slope u, root sqrt(u)) [s]."""

    @property
    def slope(self) -> Array:
        """Return the coefficient of the acceleration limit, shape (3,) [s^2/rad]."""

    @property
    def root(self) -> Array:
        """Return the coefficient of the jerk limit, 0 without one, shape (3,) [s sqrt(s/rad)]."""


class ViaLimits(Protocol):
    """The via points, and the limits of the motion through them."""

    @property
    def displacements(self) -> Array:
        """Return the displacements from point to point, shape (n, 3) [rad]."""

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


@same_size_as('size_of_via_problem')
class _ViaProblem(ctypes.Structure):  # as in native/via_problem.h
    _fields_ = [('n', ctypes.c_int32), *((name, ctypes.c_void_p) for name in (
        'displacements', 'slope', 'root', 'max_velocity', 'lowest', 'highest', 'least_T',
        'proportions', 'point', 'step', 'next', 'before', 'after', 'damping', 'gradient',
        'hessian', 'bound', 'band', 'right', 'total_gradient', 'border')),
        ('objective', ctypes.c_double), ('decrement', ctypes.c_double)]


class ViaBarrier:
    """
    The barrier problem at an iterate, as the compiled kernels see it.

    Parameters
    ----------
    limits : ViaLimits
        The via points.
    v : ndarray, shape (n - 1, 3)
        Via velocities of the first iterate [rad/s].
    T : ndarray, shape (n,)
        Its durations [s]; the point is strictly feasible.
    least_T : ndarray, shape (n,), optional
        Least durations [s].
    proportions : ndarray, shape (n,), optional
        Durations [s] whose common factor is minimised; None: durations are free, their sum is
        minimised.

    Attributes
    ----------
    address : object
        Of the problem, for the kernels.
    structure : object
        The problem itself: objective of the iterate, and decrement of the last step, squared.
    arrays : Arena
        The kernels' arrays, under the names of native/via_problem.h.
    constraints : int
        Number of inequality constraints, each a logarithm of the barrier.
    velocities, durations : ndarray
        The iterate: shapes (n - 1, 3) and (n,) [rad/s, s].

    """

    def __init__(self, limits: ViaLimits, v: Array, T: Array, least_T: Array | None = None,
                 proportions: Array | None = None) -> None:
        n = len(T)
        law = limits.law
        given = {name: array for name, array in (
            ('displacements', limits.displacements), ('slope', law.slope), ('root', law.root),
            ('max_velocity', limits.max_velocity), ('lowest', limits.lowest),
            ('highest', limits.highest), ('least_T', least_T), ('proportions', proportions),
        ) if array is not None}
        unknowns, parts = (4 * n - 3,), (7 * n - 3,)
        self.arrays = Arena({
            **{name: array.shape for name, array in given.items()},
            'point': unknowns, 'step': unknowns, 'next': unknowns, 'before': parts,
            'after': parts, 'damping': parts, 'gradient': (n, 3, 3), 'hessian': (n, 3, 3, 3),
            'bound': (*unknowns, 2), 'band': (*unknowns, 5), 'right': (*unknowns, 2),
            'total_gradient': unknowns, 'border': unknowns})
        for name, array in given.items():
            self.arrays[name][...] = array
        self.arrays['damping'][:] = 0.0
        self.structure: Any = _ViaProblem(n=n, **self.arrays.addresses)
        self.address: Any = ctypes.byref(self.structure)
        self.constraints = 12 * n + 6 * (n - 1) + (n if least_T is not None else 0)
        point = self.arrays['point']
        self.velocities, self.durations = point[:3 * n - 3].reshape(-1, 3), point[3 * n - 3:]
        self.velocities[:], self.durations[:] = v, T
        KERNELS.via_begin(self.address)
