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

"""The page's chart: a quantity of all joints over time, as shares of the limits."""

from __future__ import annotations

from collections.abc import Sequence
from time import monotonic

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.nodes.output.wireframe import picked
from rrr_traj_planner.nodes.studio.planned import LIMITED, Planned
import viser

QUANTITIES = (*LIMITED, 'position in its range')
TITLE = 'shares of the limits'  # by which moment.js knows the chart
COLOURS = ('#1f77b4', '#ff7f0e', '#2ca02c')  # of the joints
LIMIT, CURSOR = '#c62828', '#888888'
ROOM = 1.1       # of the axis, where 1 is the limit
HEIGHT = 210     # pixels
POINTS = 300     # of a curve
PERIOD = 0.08    # s between two places of the cursor
STILL = 0.2      # s without another plan, after which one is drawn: the browser takes longer for
#                  the chart than for all else of a plan, and the path would have to wait


class Chart:
    """
    A chart, and what chooses its quantity; a line is at the moment at which the arm's ghost is.

    Parameters
    ----------
    gui : viser.GuiApi
        Where to put it.
    joint_names : sequence of str
        The arm's joints.

    """

    def __init__(self, gui: viser.GuiApi, joint_names: Sequence[str]) -> None:
        self._plan: Planned | None = None
        self._time: float | None = None
        self._came = 0.0   # when the plan came [s]
        self._drawn = 0.0  # when the chart was drawn [s]
        self._quantity = gui.add_dropdown(
            'plot', QUANTITIES, hint='as shares of the limits, which are the red lines')
        self._chart = gui.add_uplot(
            (np.zeros(1),) * 7, (
                {'label': 's'},
                *({'label': name, 'stroke': colour, 'width': 2} for name, colour in zip(
                    joint_names, COLOURS)),
                *({'label': label, 'stroke': LIMIT, 'width': 1} for label in ('limit', '-limit')),
                {'label': 'moment', 'stroke': CURSOR, 'width': 2}),
            title=TITLE, legend={'show': True}, height=HEIGHT, cursor={'drag': {'x': False}},
            scales={'x': {'time': False}, 'y': {'auto': False, 'range': (-ROOM, ROOM)}})
        self._quantity.on_update(lambda _: self._draw())

    def show(self, plan: Planned) -> None:
        """
        Show a plan, soon.

        Parameters
        ----------
        plan : Planned
            With its curves.

        """
        self._plan, self._came = plan, monotonic()

    def show_time(self, time: float | None) -> None:
        """
        Show the moment at which the ghost is, and a new plan; called again and again.

        Parameters
        ----------
        time : float, optional
            Of the plan [s]; None: there is no ghost.

        """
        now, is_new = monotonic(), self._drawn <= self._came
        if now - self._came >= STILL and (
                is_new or time != self._time and now - self._drawn >= PERIOD):
            self._time = time
            self._draw()

    def _draw(self) -> None:
        plan = self._plan
        if plan is not None:
            self._drawn = monotonic()
            self._chart.data = curves(plan, self._quantity.value, self._time)


def curves(plan: Planned, quantity: str, time: float | None) -> tuple[Array, ...]:
    """
    Return what the chart draws.

    Parameters
    ----------
    plan : Planned
        With its curves.
    quantity : str
        One of `QUANTITIES`.
    time : float, optional
        Where the cursor is [s]; None: there is none.

    Returns
    -------
    tuple of ndarray, shape (n,)
        Times, curves of the joints, limits, and the cursor: out of the chart's range, but for the
        middle one of three points at the same time.

    """
    some = picked(len(plan.times), POINTS)
    times, values = plan.times[some], plan.curves[quantity][some]
    if time is None:
        cursor = np.full(len(times), -2.0 * ROOM)
    else:
        at = int(np.searchsorted(times, time))
        joints = [np.interp(time, times, curve) for curve in values.T]
        times = np.insert(times, at, [time] * 3)
        values = np.insert(values, at, [joints] * 3, axis=0)
        cursor = np.full(len(times), -2.0 * ROOM)
        cursor[at + 1] *= -1.0
    one = np.ones(len(times))
    return (times, *values.T, one, -one, cursor)
