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

"""Values of a YAML file with the lines that they stand in, for errors."""

from __future__ import annotations

from collections.abc import Collection
from difflib import get_close_matches
import sys
from typing import Any, NamedTuple

from rrr_traj_planner.core.errors import did_you_mean, InvalidInputError, shown
import yaml

LARGEST = sys.float_info.max
SIMILARITY = 0.6  # difflib's ratio; 1: equal; chosen


class Located(NamedTuple):
    """A value, its name in messages, and where it stands."""

    name: str
    value: Any
    node: yaml.Node

    @property
    def line(self) -> int:
        """Return the number of the line in which it begins."""
        return int(self.node.start_mark.line) + 1

    def error(self, text: str) -> InvalidInputError:
        """
        Return an error about the value.

        Parameters
        ----------
        text : str
            What is wrong, after its name.

        Returns
        -------
        InvalidInputError
            With line and name.

        """
        return InvalidInputError(f'line {self.line}: {self.name} {text}')

    def items(self) -> list[Located]:
        """Return the items of a list."""
        return [Located(f'{self.name}[{i}]', value, node)
                for i, (value, node) in enumerate(zip(self.value, self.node.value))]

    def fields(self, known: Collection[str] = ()) -> dict[str, Located]:
        """
        Return the fields of a mapping.

        Parameters
        ----------
        known : collection of str, optional
            The keys that it may have; empty: any.

        Returns
        -------
        dict
            By their keys.

        Raises
        ------
        InvalidInputError
            If a key repeats (YAML would take the last one) or is not known; with its line, and the
            nearest known key.

        """
        found: dict[str, Located] = {}
        own: set[str] = set()  # others are merged into it, as by `<<: *other`
        values = {str(key): value for key, value in self.value.items()}
        for key, node in self.node.value:
            name, line = str(key.value), key.start_mark.line + 1
            if name in found and name in own:
                raise InvalidInputError(
                    f'line {line}: {name} is repeated (first in line {found[name].line})')
            if known and name not in known:
                raise InvalidInputError(
                    f'line {line}: unknown {name}{meant(name, known)}; known are '
                    f'{", ".join(known)}')
            prefix = f'{self.name}.' if self.name else ''
            found[name] = Located(f'{prefix}{name}', values.get(name), node)
            own |= {name} if self._is_inside(key) else set()
        return found

    def _is_inside(self, node: yaml.Node) -> bool:
        """Return whether a node stands within the value."""
        return bool(
            self.node.start_mark.index <= node.start_mark.index < self.node.end_mark.index)

    def number(self) -> float:
        """
        Return a finite number.

        Returns
        -------
        float
            The value.

        Raises
        ------
        InvalidInputError
            If it is none; with line, name and value.

        """
        value = self.value
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            hint = ''
            if isinstance(value, str) and is_number(value):
                hint = ' without quotation marks'
            raise self.error(f'is {shown(value)}, must be a number{hint}')
        if abs(value) > LARGEST or value != value:
            raise self.error(f'is {shown(value)}, must be finite')
        return float(value)

    def text(self) -> str:
        """
        Return a text, empty where there is no value.

        Returns
        -------
        str
            The value.

        Raises
        ------
        InvalidInputError
            If it is none.

        """
        if self.value is not None and not isinstance(self.value, str):
            raise self.error(f'is {shown(self.value)}, must be a text')
        return self.value or ''


def meant(name: str, known: Collection[str]) -> str:
    """
    Return a hint of the known name that is most similar to an unknown one.

    Parameters
    ----------
    name : str
        The unknown one.
    known : collection of str
        Those known.

    Returns
    -------
    str
        For a message; empty where none is similar.

    """
    near = similar(name, known)
    return f' ({did_you_mean(near)})' if near else ''


def similar(name: str, others: Collection[str], least: float = SIMILARITY) -> str:
    """
    Return the most similar of other names.

    Parameters
    ----------
    name : str
        A name.
    others : collection of str
        The others.
    least : float
        Least ratio (difflib's; 1: equal) that counts as similar.

    Returns
    -------
    str
        Empty where none is similar.

    """
    near = get_close_matches(name, others, 1, least)
    return near[0] if near else ''


def is_number(text: str) -> bool:
    """
    Return whether a text is a number.

    Parameters
    ----------
    text : str
        The text.

    Returns
    -------
    bool
        As `float` reads it, but for underscores between digits.

    """
    try:
        float(text)
    except ValueError:
        return False
    return '_' not in text
