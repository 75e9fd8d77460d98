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
Relief from limits that a motion does not keep yet: taken away with steps towards them.

A motion found within some limits may exceed others that are a little closer. Each limit that it
exceeds is relieved by as much as it kept the former one; a whole Newton step takes all relief
away, a part of one that part.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.planners.limit_tables import Tables
from rrr_traj_planner.planners.ramp_chain import Motion

SMALL = 0.5  # of a limit's room: less relief is taken away at once


class Limits(Protocol):
    """Limits on a motion."""

    def slacks(self, m: Motion) -> list[Array]:
        """
        Return the room to the limits.

        Parameters
        ----------
        m : Motion
            Its unknowns.

        Returns
        -------
        list of ndarray, shape (2, N, p, K)
            Above and below, for each kind of limited quantity.

        """


def relief_of(limits: Limits, former: Limits, m: Motion) -> list[Array]:
    """
    Return by how much former limits are wider.

    Parameters
    ----------
    limits, former : Limits
        On the same quantities.
    m : Motion
        Any.

    Returns
    -------
    list of ndarray
        As slacks; nowhere negative.

    """
    return [np.maximum(before - now, 0.0) for before, now in zip(
        former.slacks(m), limits.slacks(m))]


def relief_in_tables(limits: Tables, former: Tables) -> Array:
    """
    Return by how much former limits are wider, as the compiled method takes it.

    Parameters
    ----------
    limits, former : Tables
        On the same quantities.

    Returns
    -------
    ndarray
        Of every limit of every segment, above and below, then of the durations' floors: none.

    """
    boxed, kept = limits.boxed, limits.kept
    above = np.concatenate(((former.upper - limits.upper)[:, boxed],
                            (former.general_upper - limits.general_upper)[:, kept]), axis=1)
    below = np.concatenate(((limits.lower - former.lower)[:, boxed],
                            (limits.general_lower - former.general_lower)[:, kept]), axis=1)
    wider = np.maximum(np.stack((above, below), axis=-1), 0.0)
    return np.concatenate((wider.ravel(), np.zeros(2 * len(wider))))


def less(reliefs: list[Array], slacks: list[Array], size: float) -> tuple[
        list[Array], list[Array]]:
    """
    Return what a step leaves of relief.

    Parameters
    ----------
    reliefs : list of ndarray
        Before the step.
    slacks : list of ndarray
        After it, its part of relief taken away.
    size : float
        Of the step.

    Returns
    -------
    tuple of list of ndarray
        Reliefs, and slacks without what was small beside them.

    """
    left, room = [], []
    for relief, slack in zip(reliefs, slacks):
        rest = (1.0 - size) * relief
        small = rest <= SMALL * slack
        left.append(np.where(small, 0.0, rest))
        room.append(np.where(small, slack - rest, slack))
    return left, room
