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

"""The folder of the scene: what the path's colours mean, the reach, and what cannot be drawn."""

from __future__ import annotations

from collections.abc import Callable

from rrr_traj_planner.nodes.studio.figures import legend_html, notes_html, SPEED, TIGHTEST
from rrr_traj_planner.nodes.studio.planned import Planned
import viser


class ViewFolder:
    """
    What the user chooses to see.

    Parameters
    ----------
    gui : viser.GuiApi
        Where to put it.
    is_dark : bool
        Whether the page is dark at the beginning.

    """

    def __init__(self, gui: viser.GuiApi, is_dark: bool) -> None:
        self._plan: Planned | None = None
        with gui.add_folder('View'):
            self._meaning = gui.add_dropdown('path shows', (SPEED, TIGHTEST))
            self._legend = gui.add_html('')
            self._reach = gui.add_checkbox(
                'reach', False, hint='where the tip gets to within the ranges of the joints')
            self._dark = gui.add_checkbox('dark page', is_dark)
            self._notes = gui.add_html('', visible=False)

    @property
    def meaning(self) -> str:
        """Return what the path's colours mean."""
        return self._meaning.value

    def connect(self, colour: Callable[[], None], reach: Callable[[bool], None],
                darken: Callable[[bool], None]) -> None:
        """
        Have the controls do something.

        Parameters
        ----------
        colour : callable
            Called when the colours mean something else.
        reach : callable
            Gets whether the reach is shown; called in a thread of its own.
        darken : callable
            Gets whether the page is to be dark; called in a thread of its own.

        """
        self._meaning.on_update(lambda _: (self._explain(), colour()))
        self._reach.on_update(lambda _: reach(bool(self._reach.value)))
        self._dark.on_update(lambda _: darken(bool(self._dark.value)))

    def explain(self, plan: Planned | None) -> None:
        """
        Show what the colours of a plan's path mean.

        Parameters
        ----------
        plan : Planned, optional
            The last plan.

        """
        self._plan = plan
        self._explain()

    def note(self, notes: tuple[str, ...]) -> None:
        """
        Show what cannot be drawn.

        Parameters
        ----------
        notes : tuple of str
            None: nothing is shown.

        """
        self._notes.content, self._notes.visible = notes_html(notes), bool(notes)

    def _explain(self) -> None:
        self._legend.content = legend_html(self._plan, self.meaning)
