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

"""The folder of the via points: the chosen one, single changes, undo and redo."""

from __future__ import annotations

import numpy as np
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.nodes.studio.editor import Editor
from rrr_traj_planner.nodes.studio.edits import with_duration, with_dwell, with_stop
from rrr_traj_planner.nodes.studio.panel.controls import enable, given, Post, TYPED, when
from rrr_traj_planner.nodes.studio.panel.typed import Number, position_in, position_text
from rrr_traj_planner.nodes.studio.studio import Studio
from rrr_traj_planner.nodes.studio.wanted import Wanted
import viser

EARLIER, LATER = 'move earlier', 'move later'
INSERT, REMOVE = 'insert after', 'remove'
UNDO, REDO = 'undo', 'redo'
NOTHING = {  # said where a button changes nothing
    REMOVE: 'a motion needs two via points', EARLIER: 'the first via point has none before it',
    LATER: 'the last via point has none after it', UNDO: 'nothing to undo',
    REDO: 'nothing to do again'}


class PointsFolder:
    """
    The list of via points, and what can be changed of the chosen one.

    Parameters
    ----------
    gui : viser.GuiApi
        Where to put it.
    wanted : Wanted
        What is shown at the beginning.

    """

    def __init__(self, gui: viser.GuiApi, wanted: Wanted) -> None:
        with gui.add_folder('Via points'):
            self._list = gui.add_dropdown('chosen', labels(wanted))
            self._position = gui.add_text(
                'x, y, z [m]', position_text(wanted.points[0]), hint='in the base frame')
            self._stop = gui.add_checkbox('stop', False, hint='whether the arm stops there')
            self._dwell = Number(gui, 'dwell [s]', 'rest at this via point; empty: none')
            self._duration = Number(
                gui, 'time [s]', 'from the via point before to this one; empty: as fast as the '
                'limits allow')
            self._number = gui.add_button_group(
                'points', (INSERT, REMOVE), hint='a via point after the chosen one; remove it')
            self._order = gui.add_button_group(
                'order', (EARLIER, LATER), hint='of the chosen via point among the others')
            self._steps = gui.add_button_group(
                'changes', (UNDO, REDO), hint='Ctrl Z, Ctrl Shift Z; a whole drag is one step')
        self._commands = {
            UNDO: gui.add_command('Undo', hotkey='Z', modifier='cmd/ctrl'),
            REDO: gui.add_command('Redo', hotkey='Z', modifier='cmd/ctrl+shift')}

    def connect(self, studio: Studio, post: Post) -> None:
        """Have the controls do something."""
        editor, refuse = studio.editor, studio.tasks.refuse
        actions = {INSERT: editor.insert, REMOVE: editor.remove, UNDO: editor.undo,
                   REDO: editor.redo, EARLIER: lambda: editor.shift(-1),
                   LATER: lambda: editor.shift(1)}

        def chosen() -> int:
            return editor.chosen

        def place(text: str, index: int) -> None:
            try:
                position = position_in(text)
            except InvalidInputError as error:
                refuse(f'via point {index}: {error}')
            else:
                refuse('')
                editor.move(index, position)

        def rest(time: float, index: int) -> None:
            editor.change(with_dwell(editor.wanted, index, time), f'dwell {index}')

        def prescribe(time: float, index: int) -> None:
            editor.change(with_duration(editor.wanted, index, time), f'time {index}')

        def press(name: str) -> None:
            before = editor.wanted
            actions[name]()
            if editor.wanted is before:
                studio.tasks.say(NOTHING[name])

        given(self._list, post, lambda label: editor.choose(int(label.partition(':')[0])))
        given(self._position, post, place, TYPED, chosen)
        given(self._stop, post, lambda stop: editor.change(
            with_stop(editor.wanted, editor.chosen, bool(stop))))
        self._dwell.connect(post, rest, refuse, chosen)
        self._duration.connect(post, prescribe, refuse, chosen)
        for group in (self._number, self._order, self._steps):
            given(group, post, press)
        for name, command in self._commands.items():
            when(command, post, actions[name])

    def show_wanted(self, editor: Editor) -> None:
        """
        Show what is wanted.

        Parameters
        ----------
        editor : Editor
            Has it.

        """
        wanted, chosen = editor.wanted, editor.chosen
        options, last = labels(wanted), len(wanted.points) - 1
        if options != self._list.options:
            self._list.options = options
        self._list.value = options[chosen]
        self._position.value = position_text(wanted.points[chosen])
        self._stop.value = bool(wanted.stops[chosen]) or chosen == 0
        enable(self._stop, 0 < chosen < last)
        self._dwell.show(float(wanted.rests[chosen]))
        duration = wanted.durations[chosen - 1] if chosen else np.nan
        self._duration.show(float(np.nan_to_num(duration)), chosen > 0)
        for name, can in ((UNDO, editor.can_undo), (REDO, editor.can_redo)):
            enable(self._commands[name], can)


def labels(wanted: Wanted) -> tuple[str, ...]:
    """
    Return the via points as the list shows them.

    Parameters
    ----------
    wanted : Wanted
        What is planned.

    Returns
    -------
    tuple of str
        Number, position [m], stop and rest.

    """
    stops, dwell = wanted.stops, wanted.rests
    found = []
    for index, point in enumerate(wanted.points.tolist()):
        text = f'{index}: ' + ', '.join(f'{x:.3g}' for x in point)
        if dwell[index] > 0.0:
            text += f', rests {dwell[index]:.3g} s'
        elif stops[index] and index < len(stops) - 1:
            text += ', stop'
        found.append(text)
    return tuple(found)
