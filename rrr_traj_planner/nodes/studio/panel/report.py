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

"""The button that makes a report of what is shown."""

from __future__ import annotations

from typing import Any

from rrr_traj_planner.core.errors import RrrPlannerError
from rrr_traj_planner.nodes.studio.panel.controls import Post
from rrr_traj_planner.nodes.studio.planned import in_words_of_the_page
from rrr_traj_planner.nodes.studio.studio import Studio
import viser

LABEL, DRAWING = 'Report', 'Drawing the report ...'


class ReportButton:
    """
    Makes a report, and has the browser save it.

    Parameters
    ----------
    gui : viser.GuiApi
        Where to put it.

    """

    def __init__(self, gui: viser.GuiApi) -> None:
        self._button = gui.add_button(
            LABEL, hint='a page to save: profiles, torque, path, animation, residual vibration')

    def connect(self, studio: Studio, _: Post) -> None:
        """Have the button do something."""
        self._button.on_click(lambda event: self._make(studio, event.client))

    def _make(self, studio: Studio, client: Any) -> None:
        self._button.label, self._button.disabled = DRAWING, True
        try:
            client.send_file_download(*studio.report(), save_immediately=True)
        except (RrrPlannerError, ImportError) as error:
            client.add_notification(
                'No report', in_words_of_the_page(str(error)), color='red')
        finally:
            self._button.label, self._button.disabled = LABEL, False
