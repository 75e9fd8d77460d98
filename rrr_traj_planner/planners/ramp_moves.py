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

"""What is done to chains of ramps as wholes: steps, changes of rate, via points met again."""

from __future__ import annotations

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.planners.ramp_chain import Grid, Motion


def stepped(grid: Grid, points: Array, m: Motion, step: Motion, size: float) -> Motion:
    """
    Return the motion after a step, again through every via point.

    Velocities and accelerations follow the durations as if time were stretched, which keeps
    the way; what is left of the step's second order is mended by smooth changes.

    Parameters
    ----------
    grid : Grid
        The family of motions.
    points : ndarray, shape (N + 1, 3)
        Via points [rad].
    m : Motion
        Its unknowns.
    step : Motion
        Change of every unknown.
    size : float
        Part of the step that is taken.

    Returns
    -------
    Motion
        Not mended where a duration is not positive.

    """
    T = m.T + size * step.T
    if not (T > 0.0).all():
        return m._replace(T=T)
    rate = step.T[:, np.newaxis] / m.T[:, np.newaxis]
    # of the segments that a via point is between, above all the shorter: its way has less play
    play = m.T[:, np.newaxis] ** 3
    beside = (rate[:-1] * play[1:] + rate[1:] * play[:-1]) / (play[:-1] + play[1:])
    v = (m.v + size * (step.v + beside * m.v)) / (1.0 + size * beside)
    a = (m.a + size * (step.a + 2.0 * beside * m.a)) / (1.0 + size * beside) ** 2
    rate = rate[:, np.newaxis]
    inner = (m.inner + size * (step.inner + 2.0 * rate * m.inner)) / (1.0 + size * rate) ** 2
    return restored(grid, points, Motion(inner, v, a, T))


def restored(grid: Grid, points: Array, m: Motion) -> Motion:
    """
    Return the motion with inner accelerations mended to meet the via points exactly.

    Parameters
    ----------
    grid : Grid
        The family of motions.
    points : ndarray, shape (N + 1, 3)
        Via points [rad].
    m : Motion
        Its unknowns.

    Returns
    -------
    Motion
        Of the same via velocities, via accelerations and durations.

    """
    nodes, v0, v1 = grid.nodes(m)
    h = (m.T / grid.n)[:, np.newaxis]
    wanted = np.stack(((v1 - v0) / h, (np.diff(points, axis=0) - m.T[:, np.newaxis] * v0)
                       / h ** 2), axis=1)
    lacking = wanted - np.stack((grid.qd[grid.n], grid.q[grid.n])) @ nodes
    return m._replace(inner=m.inner + grid.restore @ lacking)


def stretched(m: Motion, factor: float) -> Motion:
    """
    Return a motion run through more slowly, as a whole.

    Parameters
    ----------
    m : Motion
        Its unknowns.
    factor : float
        What every time is multiplied by.

    Returns
    -------
    Motion
        The same way.

    """
    return Motion(m.inner / factor ** 2, m.v / factor, m.a / factor ** 2, m.T * factor)


def slowed(m: Motion, T: Array) -> Motion:
    """
    Return a motion with stops at every via point, run through in other durations.

    Parameters
    ----------
    m : Motion
        Its unknowns.
    T : ndarray, shape (N,)
        The durations [s].

    Returns
    -------
    Motion
        The same way.

    """
    return m._replace(inner=m.inner * ((m.T / T) ** 2)[:, np.newaxis, np.newaxis], T=T)
