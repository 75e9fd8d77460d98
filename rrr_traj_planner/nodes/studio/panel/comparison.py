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

"""The folder of the planners side by side, from which one is taken."""

from __future__ import annotations

from rrr_traj_planner.nodes.studio.comparison import Comparison, comparison_html
from rrr_traj_planner.nodes.studio.panel.controls import Post, when
from rrr_traj_planner.nodes.studio.planned import Planned
from rrr_traj_planner.nodes.studio.studio import Studio
import viser


class ComparisonFolder:
    """
    A table of the plans of all planners.

    Parameters
    ----------
    gui : viser.GuiApi
        Where to put it.

    """

    def __init__(self, gui: viser.GuiApi) -> None:
        with gui.add_folder('Planners side by side', expand_by_default=False):
            self._compare = gui.add_button(
                'Compare', hint='plans the same via points with every planner')
            self._table = gui.add_html('')
            self._take = gui.add_button_group('take', (' ',), visible=False)

    def connect(self, studio: Studio, post: Post) -> None:
        """Have the controls do something."""
        when(self._compare, post, lambda: studio.comparison.start(studio.session.wanted))
        when(self._take, post, lambda: studio.take(self._take.value))

    def show(self, comparison: Comparison) -> None:
        """
        Show the plans so far.

        Parameters
        ----------
        comparison : Comparison
            Of all planners.

        """
        self._table.content = comparison_html(comparison)
        found = tuple(row.planner_id for row in comparison.rows
                      if isinstance(row.answer, Planned))
        self._take.visible = bool(found) and comparison.is_current
        if found:
            self._take.options = found
