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

"""The folder of the plan: its figures and curves, and the ghost that does it."""

from __future__ import annotations

from collections.abc import Sequence

from rrr_traj_planner.nodes.studio.chart import Chart
from rrr_traj_planner.nodes.studio.panel.controls import given, Post
from rrr_traj_planner.nodes.studio.planned import Planned
from rrr_traj_planner.nodes.studio.studio import Studio
import viser

STEP = 0.001  # of the moment


class PlanFolder:
    """
    What tells about the plan.

    Parameters
    ----------
    gui : viser.GuiApi
        Where to put it.
    joint_names : sequence of str
        The arm's joints.

    """

    def __init__(self, gui: viser.GuiApi, joint_names: Sequence[str]) -> None:
        self._plan: Planned | None = None
        with gui.add_folder('Plan'):
            self._figures = gui.add_html('')
            self._chart = Chart(gui, joint_names)
            self._play = gui.add_checkbox('play', False, hint='the arm does the plan as a ghost')
            self._moment = gui.add_slider(
                'moment / duration', 0.0, 1.0, STEP, 0.0,
                hint='of the motion; or click in the chart')

    def connect(self, studio: Studio, post: Post) -> None:
        """Have the controls do something."""
        def go_to(share: float) -> None:
            self._play.value = False
            studio.go_to(float(share))

        given(self._play, post, studio.play)
        given(self._moment, post, go_to)

    def show(self, plan: Planned | None, text: str) -> None:
        """
        Show a plan's figures and curves.

        Parameters
        ----------
        plan : Planned, optional
            The last plan.
        text : str
            HTML.

        """
        self._figures.content, self._plan = text, plan
        if plan is not None:
            self._chart.show(plan)

    def show_time(self, time: float | None) -> None:
        """
        Show the moment at which the ghost is; called again and again.

        Parameters
        ----------
        time : float, optional
            Of the plan [s]; None: there is no ghost.

        """
        self._chart.show_time(time)
        if time is not None and self._plan is not None and self._play.value:
            share = time / self._plan.duration if self._plan.duration > 0.0 else 0.0
            self._moment.value = round(share / STEP) * STEP
