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

"""The folder of the arm: Run, Hold, Reset, and what it does."""

from __future__ import annotations

from rrr_traj_planner.nodes.studio.panel.controls import Post, when
from rrr_traj_planner.nodes.studio.studio import Studio
import viser


class ArmFolder:
    """
    What has the arm move, and tells about its motion.

    Parameters
    ----------
    gui : viser.GuiApi
        Where to put it.

    """

    def __init__(self, gui: viser.GuiApi) -> None:
        with gui.add_folder('Arm'):
            self._status = gui.add_html('')
            self._progress = gui.add_progress_bar(0.0)
            self._run = gui.add_button('Run', color='green')
            self._hold, self._reset = gui.add_button('Hold'), gui.add_button('Reset')

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
        when(self._run, post, studio.run)
        when(self._hold, post, lambda: studio.trigger('hold'))
        when(self._reset, post, lambda: studio.trigger('reset'))

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
