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
Meshes with short intervals where jerk changes fast, and long ones elsewhere.

Nodes are placed so that each interval has the same share of a monitor function's integral
(equidistribution: de Boor, Good approximation by splines with variable knots, 1973; Betts,
Practical Methods for Optimal Control, 2010, section 4.7).
"""

from __future__ import annotations

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.kernels import contiguous
from rrr_traj_planner.planners.solver.library import KERNELS
from rrr_traj_planner.planners.solver.splines import Mesh, Variables

# Of the monitor: its value where jerk is constant, over its mean where jerk goes from zero to its
# limit in the course of a segment; and the weights of an interval and its two neighbours. Chosen.
BASE, SMOOTHING = 0.25, (0.25, 0.5, 0.25)

# Longest that the least interval may be, over the mean one; chosen: nodes remain to be moved.
MOST_UNIFORM = 0.9


def refined(mesh: Mesh, points: Array, m: Variables, max_jerk: Array,
            least_rise: float) -> tuple[Mesh, Variables]:
    """
    Return a mesh that suits a motion better, and the motion on it.

    Parameters
    ----------
    mesh : Mesh
        The motion's.
    points : ndarray, shape (N + 1, J)
        Via points.
    m : Variables
        The motion.
    max_jerk : ndarray, shape (J,)
        Its proportions are the joints' scales of changes of jerk; where it is infinite, the
        motion's own largest jerk is.
    least_rise : float
        Shortest interval [s].

    Returns
    -------
    mesh : Mesh
        With as many intervals.
    motion : Variables
        Nearly the same; it may exceed limits slightly.

    """
    n, jerk = mesh.n, _node_jerks(mesh, m)
    own = np.maximum(np.abs(jerk).max(axis=(0, 1)), np.finfo(float).tiny)
    limited = np.isfinite(max_jerk)
    scale = np.where(limited, np.where(limited, max_jerk, 1.0) * (own / max_jerk).max(), own)
    change = np.abs(np.diff(jerk, axis=1)) / scale
    monitor = change.max(axis=2) / (mesh.parts * n) + BASE
    beside = np.concatenate((monitor[:, :1], monitor, monitor[:, -1:]), axis=1)
    monitor = np.sum([f * beside[:, i:i + n] for i, f in enumerate(SMOOTHING)], axis=0)
    parts = _equal_shares(monitor, mesh.parts, least_rise / m.T)
    if mesh.suits is not None:
        parts = np.where(mesh.suits[:, np.newaxis], mesh.parts, parts)
    found = Mesh(parts, mesh.suits)
    return found, moved(mesh, found, points, m)


def moved(mesh: Mesh, to: Mesh, points: Array, m: Variables) -> Variables:
    """
    Return a motion on another mesh.

    Parameters
    ----------
    mesh : Mesh
        The motion's.
    to : Mesh
        The other.
    points : ndarray, shape (N + 1, J)
        Via points.
    m : Variables
        The motion.

    Returns
    -------
    Variables
        Nearly the same; it may exceed limits slightly.

    """
    jerk = _node_jerks(mesh, m)
    N, _, J = jerk.shape
    inner = np.empty((N, to.n - 1, J))
    KERNELS.jerks_on_mesh(J, N, mesh.n, mesh.parts.ctypes.data, jerk.ctypes.data, to.n,
                          to.parts.ctypes.data, inner.ctypes.data)
    return to.restored(points, m._replace(inner=inner))


def halved(mesh: Mesh) -> Mesh:
    """
    Return a mesh of twice as many intervals.

    Parameters
    ----------
    mesh : Mesh
        Any.

    Returns
    -------
    Mesh
        Its intervals in halves.

    """
    return Mesh(np.repeat(0.5 * mesh.parts, 2, axis=1), mesh.suits)


def _node_jerks(mesh: Mesh, m: Variables) -> Array:
    """Return a motion's jerks at all nodes, shape (N, n + 1, J)."""
    N, _, J = m.inner.shape
    jerk = np.empty((N, mesh.n + 1, J))
    jerk[:, 0], jerk[:, 1:-1], jerk[:, -1] = m.j[:-1], m.inner, m.j[1:]
    return jerk


def _equal_shares(monitor: Array, parts: Array, least: Array) -> Array:
    """Return parts with equal shares of the monitors' integrals, none shorter than the least."""
    N, n = parts.shape
    monitor, least = contiguous(monitor), np.minimum(least, MOST_UNIFORM / n)
    found = np.empty((N, n))
    KERNELS.refined_parts(N, n, *(f.ctypes.data for f in (monitor, parts, least, found)))
    return found
