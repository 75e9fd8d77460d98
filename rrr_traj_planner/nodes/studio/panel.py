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

"""The page's panel: planner, scalings, via points, the arm's buttons, and the plan's figures."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from rrr_traj_planner.nodes.studio.chart import Chart
from rrr_traj_planner.nodes.studio.files import saved
from rrr_traj_planner.nodes.studio.planned import Planned
from rrr_traj_planner.nodes.studio.studio import Studio
from rrr_traj_planner.nodes.studio.wanted import Wanted
import viser

LEAST_SCALING = 0.05
SAVED = 'via_points.yaml'

# Calls a function in the thread in which the studio is to be called.
Post = Callable[[Callable[[], None]], Any]


class Panel:
    """
    What stands beside the scene.

    Parameters
    ----------
    gui : viser.GuiApi
        Where to put it.
    planner_ids : sequence of str
        To choose from.
    wanted : Wanted
        What is chosen at the beginning.
    joint_names : sequence of str
        The arm's joints.

    """

    def __init__(self, gui: viser.GuiApi, planner_ids: Sequence[str], wanted: Wanted,
                 joint_names: Sequence[str]) -> None:
        with gui.add_folder('Motion'):
            self._planner = gui.add_dropdown(
                'planner', planner_ids, initial_value=wanted.task.planner_id)
            self._scalings = [gui.add_slider(
                f'max {name}', LEAST_SCALING, 1.0, LEAST_SCALING, value,
                hint=f'fraction of the {name} limits') for name, value in (
                    ('velocity', wanted.velocity_scaling),
                    ('acceleration', wanted.acceleration_scaling))]
            self._add = gui.add_button('Add a via point')
            self._remove = gui.add_button('Remove the last one')
            self._load = gui.add_upload_button('Load a via-point file')
            self._save = gui.add_button('Save')
        with gui.add_folder('Arm'):
            self._status = gui.add_html('')
            self._progress = gui.add_progress_bar(0.0)
            self._run = gui.add_button('Run', color='green')
            self._hold, self._reset = gui.add_button('Hold'), gui.add_button('Reset')
        with gui.add_folder('Plan'):
            self._figures = gui.add_html('')
            self._chart = Chart(gui, joint_names)
            self._play = gui.add_checkbox('play', False, hint='the arm does the plan as a ghost')
            self._moment = gui.add_slider('moment', 0.0, 1.0, 0.001, 0.0,
                                          hint='of the motion, as a fraction of its duration')

    def connect(self, studio: Studio, post: Post) -> None:
        """
        Have the controls do something.

        Parameters
        ----------
        studio : Studio
            What they act on.
        post : callable
            Calls a function in the studio's thread.

        """
        def changing(handle: Any, change: Callable[[Wanted], Wanted]) -> None:
            when(handle, lambda: studio.change(change(studio.session.wanted)))

        def when(handle: Any, act: Callable[[], None]) -> None:
            attach = handle.on_click if hasattr(handle, 'on_click') else handle.on_update
            attach(lambda _: post(act))

        changing(self._planner, lambda wanted: wanted.with_planner(self._planner.value))
        for slider in self._scalings:
            changing(slider, lambda wanted: wanted.with_scalings(
                *(float(s.value) for s in self._scalings)))
        changing(self._add, lambda wanted: wanted.with_point())
        changing(self._remove, lambda wanted: wanted.without_last())
        when(self._play, lambda: studio.play(bool(self._play.value)))
        when(self._moment, self._go_to(studio))
        self._save.on_click(lambda event: event.client.send_file_download(
            SAVED, saved(studio.session.wanted).encode()))
        self._load.on_upload(lambda _: self._loaded(studio, post))
        when(self._run, studio.run)
        when(self._hold, lambda: studio.trigger('hold'))
        when(self._reset, lambda: studio.trigger('reset'))

    def _loaded(self, studio: Studio, post: Post) -> None:
        file = self._load.value

        def load() -> None:
            studio.load(file.name, file.content)
            self._planner.value = studio.session.wanted.task.planner_id

        post(load)

    def _go_to(self, studio: Studio) -> Callable[[], None]:
        def act() -> None:
            self._play.value = False
            studio.go_to(float(self._moment.value))

        return act

    def show_plan(self, plan: Planned | None, text: str) -> None:
        """
        Show a plan's figures and curves.

        Parameters
        ----------
        plan : Planned, optional
            The last plan.
        text : str
            HTML.

        """
        self._figures.content = text
        if plan is not None:
            self._chart.show(plan)

    def show_status(self, text: str, share: float) -> None:
        """
        Show what the arm does.

        Parameters
        ----------
        text : str
            HTML.
        share : float
            Of the motion that is done, 0 to 1.

        """
        self._status.content = text
        self._progress.value = 100.0 * min(max(share, 0.0), 1.0)
