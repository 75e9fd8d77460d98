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

"""Numbers as they are typed, in fields of text: fields of numbers lose signs, and stay empty."""

from __future__ import annotations

from collections.abc import Callable
from math import isfinite, nan
import re
from typing import Any

from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.kinematics.link_positions import Point
from rrr_traj_planner.nodes.studio.panel.controls import enable, given, Post, TYPED
import viser

DIGITS = 6                       # of a coordinate, after the point
SEPARATORS = re.compile('[,;]')  # of coordinates


class Number:
    """
    A field for a number, at least 0; it is empty where that is 0.

    Parameters
    ----------
    gui : viser.GuiApi
        Where to put it.
    label : str
        With the unit, as in 'dwell [s]'.
    hint : str
        What it means.

    """

    def __init__(self, gui: viser.GuiApi, label: str, hint: str) -> None:
        self._label, self._handle = label, gui.add_text(label, '', hint=hint)

    def connect(self, post: Post, act: Callable[..., None], refuse: Callable[[str], None],
                about: Callable[[], Any] | None = None) -> None:
        """
        Have it do something.

        Parameters
        ----------
        post : callable
            Calls a function in the studio's thread.
        act : callable
            Gets the number that the user has typed, and what it is of.
        refuse : callable
            Gets what is wrong with what the user has typed; empty: nothing.
        about : callable, optional
            See `given`.

        """
        def typed(text: str, *of: Any) -> None:
            try:
                number = number_in(text, self._label)
            except InvalidInputError as error:
                refuse(str(error))
            else:
                refuse('')
                act(number, *of)

        given(self._handle, post, typed, TYPED, about)

    def show(self, number: float, is_enabled: bool = True) -> None:
        """
        Show a number.

        Parameters
        ----------
        number : float
            The number.
        is_enabled : bool
            Whether it can be changed.

        """
        self._handle.value = f'{number:.9g}' if number else ''
        enable(self._handle, is_enabled)


def number_in(text: str, label: str) -> float:
    """
    Return a number that is typed.

    Parameters
    ----------
    text : str
        The number; empty: 0.
    label : str
        What it is of, with its unit in brackets.

    Returns
    -------
    float
        At least 0.

    Raises
    ------
    InvalidInputError
        If it is something else.

    """
    try:
        number = float(text.strip() or 0.0)
    except ValueError:
        number = nan
    if not 0.0 <= number < float('inf'):
        raise InvalidInputError(f'{label} is {text.strip()!r}, must be a number, 0 or more')
    return number


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
    return ', '.join(str(round(x, DIGITS)) for x in point.tolist())


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
