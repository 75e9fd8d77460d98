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
    n = mesh.n
    jerk = mesh.states(points, m).jerk[:, :n + 1]
    own = np.maximum(np.abs(jerk).max(axis=(0, 1)), np.finfo(float).tiny)
    limited = np.isfinite(max_jerk)
    scale = np.where(limited, np.where(limited, max_jerk, 1.0) * (own / max_jerk).max(), own)
    change = np.abs(np.diff(jerk, axis=1)) / scale
    monitor = change.max(axis=2) / (mesh.parts * n) + BASE
    beside = np.concatenate((monitor[:, :1], monitor, monitor[:, -1:]), axis=1)
    monitor = np.sum([f * beside[:, i:i + n] for i, f in enumerate(SMOOTHING)], axis=0)
    parts = np.array([_equal_shares(own_monitor, own_parts, least_rise / T) for
                      own_monitor, own_parts, T in zip(monitor, mesh.parts, m.T)])
    found = Mesh(parts)
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
    jerk = mesh.states(points, m).jerk[:, :mesh.n + 1]
    inner = np.array([[np.interp(new, at, f) for f in own_jerk.T] for new, at, own_jerk in zip(
        to.starts[:, 1:-1], mesh.starts, jerk)])
    return to.restored(points, m._replace(inner=np.swapaxes(inner, 1, 2)))


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
    return Mesh(np.repeat(0.5 * mesh.parts, 2, axis=1))


def _equal_shares(monitor: Array, parts: Array, least: float) -> Array:
    """Return parts with equal shares of the monitor's integral, none shorter than the least."""
    n = len(parts)
    least = min(least, MOST_UNIFORM / n)
    share = np.concatenate(([0.0], np.cumsum(monitor * parts)))
    starts = np.concatenate(([0.0], np.cumsum(parts)))
    found = np.diff(np.interp(np.linspace(0.0, share[-1], n + 1), share, starts))
    while (short := found < least).any():
        found = np.where(short, least, found)
        longer = found > least
        found[longer] *= (1.0 - least * np.count_nonzero(~longer)) / found[longer].sum()
    return np.asarray(found / found.sum())
