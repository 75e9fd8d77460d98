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

"""The lines on top of the panel, which stay there: what the arm does, and what is refused."""

from __future__ import annotations

from rrr_traj_planner.nodes.studio.figures import refusal_html, status_html
from rrr_traj_planner.nodes.studio.session import Refusal
import viser


class Head:
    """
    What is seen however far the panel is scrolled.

    Parameters
    ----------
    gui : viser.GuiApi
        Where to put it.

    """

    def __init__(self, gui: viser.GuiApi) -> None:
        self._html = gui.add_html('')
        self._status = self._refusal = self._said = ''

    def show_status(self, text: str) -> None:
        """
        Show what the arm does.

        Parameters
        ----------
        text : str
            HTML.

        """
        self._status = text
        self._show()

    def show_refusal(self, refusal: Refusal | None) -> None:
        """
        Show why there is no plan.

        Parameters
        ----------
        refusal : Refusal, optional
            None: there is one.

        """
        self._refusal = refusal_html(refusal)
        self._show()

    def say(self, message: str, is_error: bool) -> None:
        """
        Show what there is to say about the last thing that the user has done.

        Parameters
        ----------
        message : str
            Empty: nothing.
        is_error : bool
            Whether it is red.

        """
        self._said = status_html(message, is_error) if message else ''
        self._show()

    def _show(self) -> None:
        text = f'<div class="head">{self._status}{self._refusal}{self._said}</div>'
        if text != self._html.content:
            self._html.content = text
