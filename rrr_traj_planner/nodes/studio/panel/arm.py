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

"""The folder of the arm: Run, Hold, Reset, how far it is, and how well it follows."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from typing import Any

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.nodes.studio.chart import COLOURS
from rrr_traj_planner.nodes.studio.panel.controls import Post, when
from rrr_traj_planner.nodes.studio.studio import Studio
import viser

HEIGHT = 130   # pixels, of the chart
MILLI = 1e-3   # rad
NO_TICKS = {'ticks': {'show': False}}


class ArmFolder:
    """
    What has the arm move, and tells about its motion.

    Parameters
    ----------
    gui : viser.GuiApi
        Where to put it.
    joint_names : sequence of str
        The arm's joints.

    """

    def __init__(self, gui: viser.GuiApi, joint_names: Sequence[str]) -> None:
        with gui.add_folder('Arm'):
            self._run = gui.add_button('Run', color='green')
            self._hold, self._reset = gui.add_button('Hold'), gui.add_button('Reset')
            self._progress = gui.add_progress_bar(0.0)
            self._errors = gui.add_uplot(
                (np.zeros(1),) * 4, ({'label': 's'}, *(
                    {'label': name, 'stroke': colour, 'width': 1.5}
                    for name, colour in zip(joint_names, COLOURS))),
                scales={'x': {'time': False}}, title='tracking error [mrad]', height=HEIGHT,
                axes=(NO_TICKS, {**NO_TICKS, 'size': 60, 'space': 20}),
                legend={'show': True}, visible=False)

    def connect(self, studio: Studio, post: Post) -> None:
        """Have the controls do something."""
        commands = studio.commands
        when(self._hold, post, commands.hold)
        if commands.is_real:
            self._reset.remove()
            self._run.on_click(lambda event: _ask(event.client, studio, post))
        else:
            when(self._reset, post, commands.reset)
            when(self._run, post, commands.run)

    def show_progress(self, share: float) -> None:
        """
        Show how far the motion is.

        Parameters
        ----------
        share : float
            Of the motion that is done, 0 to 1.

        """
        self._progress.value = 100.0 * min(max(share, 0.0), 1.0)

    def show_tracking(self, times: Array, errors: Array) -> None:
        """
        Show how well the arm follows.

        Parameters
        ----------
        times : ndarray, shape (n,)
            Since the start of the motion [s].
        errors : ndarray, shape (n, 3)
            The joints' tracking errors [rad].

        """
        self._errors.data = (times, *(errors.T / MILLI))
        self._errors.visible = True


def _ask(client: Any, studio: Studio, post: Post) -> None:
    """Ask one user whether to move the arm; without a plan, there is nothing to ask."""
    question = studio.commands.question()
    if question is None:
        post(studio.commands.run)
        return
    with client.gui.add_modal('Move the real arm?') as modal:
        client.gui.add_html(f'<p>{escape(question.text)}</p>')
        move, cancel = client.gui.add_button('Move', color='red'), client.gui.add_button('Cancel')

    def confirmed(_: Any) -> None:
        modal.close()
        post(lambda: studio.commands.run(question.wanted))

    move.on_click(confirmed)
    cancel.on_click(lambda _: modal.close())
