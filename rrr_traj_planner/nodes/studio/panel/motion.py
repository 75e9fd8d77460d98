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

"""The folder of the motion: what is to be planned."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from rrr_traj_planner.nodes.studio.files import saved
from rrr_traj_planner.nodes.studio.panel.controls import Post, when
from rrr_traj_planner.nodes.studio.studio import Studio
from rrr_traj_planner.nodes.studio.wanted import Wanted
import viser

LEAST_SCALING = 0.05
SAVED = 'via_points.yaml'


class MotionFolder:
    """
    Planner, scalings, via points and their files.

    Parameters
    ----------
    gui : viser.GuiApi
        Where to put it.
    planner_ids : sequence of str
        To choose from.
    wanted : Wanted
        What is chosen at the beginning.

    """

    def __init__(self, gui: viser.GuiApi, planner_ids: Sequence[str], wanted: Wanted) -> None:
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
            when(handle, post, lambda: studio.change(change(studio.session.wanted)))

        changing(self._planner, lambda wanted: wanted.with_planner(self._planner.value))
        for slider in self._scalings:
            changing(slider, lambda wanted: wanted.with_scalings(
                *(float(s.value) for s in self._scalings)))
        changing(self._add, lambda wanted: wanted.with_point())
        changing(self._remove, lambda wanted: wanted.without_last())
        self._save.on_click(lambda event: event.client.send_file_download(
            SAVED, saved(studio.session.wanted).encode()))
        self._load.on_upload(lambda _: self._loaded(studio, post))

    def _loaded(self, studio: Studio, post: Post) -> None:
        file = self._load.value

        def load() -> None:
            studio.load(file.name, file.content)
            self._planner.value = studio.session.wanted.task.planner_id

        post(load)
