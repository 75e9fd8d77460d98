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

"""The page's panel: its folders, from top to bottom."""

from __future__ import annotations

from collections.abc import Sequence

from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.nodes.studio.editor import Editor
from rrr_traj_planner.nodes.studio.panel.arm import ArmFolder
from rrr_traj_planner.nodes.studio.panel.browser import scripts_html
from rrr_traj_planner.nodes.studio.panel.comparison import ComparisonFolder
from rrr_traj_planner.nodes.studio.panel.controls import Folder, Post
from rrr_traj_planner.nodes.studio.panel.files import FilesFolder
from rrr_traj_planner.nodes.studio.panel.head import Head
from rrr_traj_planner.nodes.studio.panel.motion import MotionFolder
from rrr_traj_planner.nodes.studio.panel.plan import PlanFolder
from rrr_traj_planner.nodes.studio.panel.points import PointsFolder
from rrr_traj_planner.nodes.studio.panel.report import ReportButton
from rrr_traj_planner.nodes.studio.panel.view import ViewFolder
from rrr_traj_planner.nodes.studio.studio import Studio
from rrr_traj_planner.nodes.studio.tasks import Tasks
from rrr_traj_planner.nodes.studio.wanted import Wanted
import viser


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
    model : RobotModel
        The arm.
    is_dark : bool
        Whether the page is dark.

    """

    def __init__(self, gui: viser.GuiApi, planner_ids: Sequence[str], wanted: Wanted,
                 model: RobotModel, is_dark: bool) -> None:
        self._head = Head(gui)
        self._tasks: Tasks | None = None
        self._files = FilesFolder(gui)
        self._points = PointsFolder(gui, wanted)
        self._motion = MotionFolder(gui, planner_ids, wanted, model)
        self._arm = ArmFolder(gui, model.joint_names)
        self._plan = PlanFolder(gui, model.joint_names)
        self._comparison = ComparisonFolder(gui)
        self.view = ViewFolder(gui, is_dark)
        self._report = ReportButton(gui)
        gui.add_html(scripts_html())
        self.show_refusal, self.show_tracking = self._head.show_refusal, self._arm.show_tracking
        self.show_comparison = self._comparison.show
        self.show_plan, self.show_time = self._plan.show, self._plan.show_time

    def connect(self, studio: Studio, post: Post) -> None:
        """Have the controls do something."""
        folders: tuple[Folder, ...] = (
            self._files, self._points, self._motion, self._arm, self._plan, self._comparison,
            self._report)
        self._tasks = studio.tasks
        for folder in folders:
            folder.connect(studio, post)

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
        self._head.show_status(text)
        self._arm.show_progress(share)

    def show_wanted(self, editor: Editor) -> None:
        """
        Show all that the user can change.

        Parameters
        ----------
        editor : Editor
            Has it.

        """
        for folder in (self._files, self._points, self._motion):
            folder.show_wanted(editor)
        if self._tasks is not None:
            self._head.say(self._tasks.message, self._tasks.is_error)
