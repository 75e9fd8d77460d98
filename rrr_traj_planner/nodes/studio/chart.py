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

import numpy as np
from rrr_traj_planner.nodes.studio.planned import Planned
import viser

QUANTITIES = ('velocity', 'acceleration', 'torque', 'position in its range')
COLOURS = ('#1f77b4', '#ff7f0e', '#2ca02c')  # of the joints
LIMIT = '#c62828'
ROOM = 1.1    # of the axis, where 1 is the limit
HEIGHT = 190  # pixels


class Chart:
    """
    A chart, and what chooses its quantity.

    Parameters
    ----------
    gui : viser.GuiApi
        Where to put it.
    joint_names : sequence of str
        The arm's joints.

    """

    def __init__(self, gui: viser.GuiApi, joint_names: Sequence[str]) -> None:
        self._plan: Planned | None = None
        self._quantity = gui.add_dropdown(
            'plot', QUANTITIES, hint='as shares of the limits, which are the red lines')
        self._chart = gui.add_uplot(
            (np.zeros(1),) * 6, (
                {'label': 's'},
                *({'label': name, 'stroke': colour, 'width': 2} for name, colour in zip(
                    joint_names, COLOURS)),
                *({'label': label, 'stroke': LIMIT, 'width': 1} for label in ('limit', '-limit'))),
            scales={'x': {'time': False}, 'y': {'auto': False, 'range': (-ROOM, ROOM)}},
            legend={'show': True}, height=HEIGHT)
        self._quantity.on_update(lambda _: self._draw())

    def show(self, plan: Planned) -> None:
        """
        Show a plan.

        Parameters
        ----------
        plan : Planned
            With its curves.

        """
        self._plan = plan
        self._draw()

    def _draw(self) -> None:
        plan = self._plan
        if plan is not None:
            one = np.ones(len(plan.times))
            self._chart.data = (
                plan.times, *plan.curves[self._quantity.value].T, one, -one)
