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

from math import isfinite, nan
import re

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.kinematics.link_positions import Point
from rrr_traj_planner.nodes.studio.editor import Editor
from rrr_traj_planner.nodes.studio.edits import with_duration, with_dwell, with_stop
from rrr_traj_planner.nodes.studio.panel.controls import enable, given, Post, TYPED, when
from rrr_traj_planner.nodes.studio.studio import Studio
from rrr_traj_planner.nodes.studio.wanted import Wanted
import viser

EARLIER, LATER = 'move earlier', 'move later'
INSERT, REMOVE = 'insert after', 'remove'
METRE_DIGITS, SECOND_DIGITS = 6, 3  # that can be typed
SEPARATORS = re.compile('[,;]')     # of coordinates
UNDO, REDO = 'undo', 'redo'


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
            self._dwell = gui.add_number(
                'dwell [s]', 0.0, min=0.0, step=0.1, hint='rest at this via point')
            self._duration = gui.add_number(
                'time [s]', 0.0, min=0.0, step=0.1,
                hint='from the via point before to this one; 0: as fast as the limits allow')
            self._dwell.precision = self._duration.precision = SECOND_DIGITS
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
        editor = studio.editor
        actions = {INSERT: editor.insert, REMOVE: editor.remove, UNDO: editor.undo,
                   REDO: editor.redo, EARLIER: lambda: editor.shift(-1),
                   LATER: lambda: editor.shift(1)}

        def chosen() -> int:
            return editor.chosen

        def place(text: str, index: int) -> None:
            try:
                editor.move(index, position_in(text))
                studio.tasks.say('')
            except InvalidInputError as error:
                studio.tasks.say(f'via point {index}: {error}', is_error=True)

        def rest(time: float, index: int) -> None:
            editor.change(with_dwell(editor.wanted, index, float(time)), f'dwell {index}')

        def prescribe(time: float, index: int) -> None:
            editor.change(with_duration(editor.wanted, index, float(time)), f'time {index}')

        given(self._list, post, lambda label: editor.choose(int(label.partition(':')[0])))
        given(self._position, post, place, TYPED, chosen)
        given(self._stop, post, lambda stop: editor.change(
            with_stop(editor.wanted, editor.chosen, bool(stop))))
        given(self._dwell, post, rest, TYPED, chosen)
        given(self._duration, post, prescribe, TYPED, chosen)
        for group in (self._number, self._order, self._steps):
            given(group, post, lambda name: actions[name]())
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
        self._dwell.value = float(wanted.rests[chosen])
        duration = wanted.durations[chosen - 1] if chosen else np.nan
        self._duration.value = float(np.nan_to_num(duration))
        enable(self._duration, chosen > 0)
        for name, can in ((UNDO, editor.can_undo), (REDO, editor.can_redo)):
            enable(self._commands[name], can)


def position_text(point: Array) -> str:
    """
    Return a position as it is typed.

    Parameters
    ----------
    point : ndarray, shape (3,)
        [m].

    Returns
    -------
    str
        To the micrometre.

    """
    return ', '.join(str(round(x, METRE_DIGITS)) for x in point.tolist())


def position_in(text: str) -> Point:
    """
    Return a position that is typed.

    Parameters
    ----------
    text : str
        Three numbers, with commas, semicolons or spaces between them.

    Returns
    -------
    tuple of 3 floats
        [m].

    Raises
    ------
    InvalidInputError
        If it is something else.

    """
    try:
        x, y, z = map(float, SEPARATORS.sub(' ', text).split())
    except ValueError:
        x = y = z = nan
    if not isfinite(x + y + z):
        raise InvalidInputError(f'position is {text!r}, must be three numbers, x, y, z in m')
    return x, y, z


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
