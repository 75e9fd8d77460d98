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

"""The folder of files: the package's tasks with their arms, and the user's via-point files."""

from __future__ import annotations

from typing import Any

from rrr_traj_planner.nodes.point_files.shipped import shipped_tasks
from rrr_traj_planner.nodes.studio.editor import Editor
from rrr_traj_planner.nodes.studio.figures import status_html
from rrr_traj_planner.nodes.studio.files import saved
from rrr_traj_planner.nodes.studio.panel.controls import given, Post
from rrr_traj_planner.nodes.studio.studio import Studio
from rrr_traj_planner.nodes.studio.tasks import Tasks
import viser

NONE = 'choose'


class FilesFolder:
    """
    What opens tasks, and saves what is shown.

    Parameters
    ----------
    gui : viser.GuiApi
        Where to put it.

    """

    def __init__(self, gui: viser.GuiApi) -> None:
        self._tasks: Tasks | None = None
        with gui.add_folder('Task'):
            self._name = gui.add_html('')
            self._shipped = gui.add_dropdown(
                'open', (NONE, *shipped_tasks()), hint="the package's tasks, with their "
                'arms: for another arm, the nodes are started anew')
            self._load = gui.add_upload_button('Load a via-point file')
            self._save = gui.add_button('Save', hint='via points, stops, rests, times and planner')

    def connect(self, studio: Studio, post: Post) -> None:
        """Have the controls do something."""
        def open_shipped(name: str) -> None:
            if name != NONE:
                self._shipped.value = NONE
                studio.tasks.open_shipped(name)

        def save(event: Any) -> None:
            wanted = studio.editor.wanted
            event.client.send_file_download(
                f'{wanted.task.name}.yaml', saved(wanted, studio.tasks.arm).encode(),
                save_immediately=True)

        def load(file: Any) -> None:
            studio.tasks.load(file.name, file.content)

        self._tasks = studio.tasks
        given(self._shipped, post, open_shipped)
        self._save.on_click(save)
        self._load.on_upload(lambda _: post(lambda: load(self._load.value)))

    def show_wanted(self, editor: Editor) -> None:
        """
        Show which task is changed, and which arm does it.

        Parameters
        ----------
        editor : Editor
            Has the task.

        """
        tasks = self._tasks
        if tasks is not None:
            arm = 'own arm' if tasks.arm is None else tasks.arm.stem
            text = status_html(f'{editor.wanted.task.name}, {arm}')
            if text != self._name.content:
                self._name.content = text
