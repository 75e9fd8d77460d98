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

"""Parsing of via points: YAML lists, and tables of comma-separated values."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import isfinite
import re
import sys
from typing import Any, NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.errors import InvalidInputError, shown

AXES = ('x', 'y', 'z')
WANTED = 'three numbers, [x, y, z] in m'
LARGEST = sys.float_info.max


def listed_points(value: Any, lines: Sequence[int] = ()) -> Array:
    """
    Return the via points of a YAML list.

    Parameters
    ----------
    value : object
        The list as parsed.
    lines : sequence of int, optional
        Line number of each item, for messages.

    Returns
    -------
    ndarray, shape (n, 3)
        Tip positions [m].

    Raises
    ------
    InvalidInputError
        If it is not a list of points; names the point, and what is missing or wrong.

    """
    if not isinstance(value, list):
        raise InvalidInputError(
            f'via_points is {shown(value)}, must be a list of points [x, y, z]')
    for i, point in enumerate(value):
        where = f'line {lines[i]}: ' if i < len(lines) else ''
        name = f'{where}via_points[{i}]'
        if not isinstance(point, list):
            raise InvalidInputError(f'{name} is {shown(point)}, must be {WANTED}')
        if len(point) != len(AXES):
            raise InvalidInputError(
                f'{name} is {shown(point)}, must be {WANTED}: {_difference(point)}')
        for j, number in enumerate(point):
            check_number(f'{name}[{j}]', number)
    return np.array(value, dtype=float).reshape(-1, len(AXES))


def check_number(name: str, value: Any) -> None:
    """
    Refuse a value that is not a finite number.

    Parameters
    ----------
    name : str
        Name for the message.
    value : object
        The value as parsed from YAML.

    Raises
    ------
    InvalidInputError
        Gives name and value.

    """
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        hint = ''
        if isinstance(value, str) and _number(value) is not None:
            hint = ' (YAML reads 1e-3 and quoted numbers as text: write 1.0e-3)'
        raise InvalidInputError(f'{name} is {shown(value)}, must be a number{hint}')
    if abs(value) > LARGEST or value != value:
        raise InvalidInputError(f'{name} is {shown(value)}, must be finite')


def _difference(point: Sequence[Any]) -> str:
    if len(point) < len(AXES):
        missing = AXES[len(point):]
        return f'{" and ".join(missing)} {"is" if len(missing) == 1 else "are"} missing'
    more = ', '.join(map(shown, point[len(AXES):]))
    return f'{more} {"is" if len(point) == len(AXES) + 1 else "are"} too many'


class _Row(NamedTuple):
    """A line of a table that is neither empty nor a comment."""

    line: int
    fields: list[str]
    decimal_comma: bool

    def number(self, column: int) -> float | None:
        """Return a field as a number, None if it is not one."""
        text = self.fields[column]
        return _number(text.replace(',', '.') if self.decimal_comma else text)


def tabulated_points(text: str) -> Array:
    """
    Return the via points of a table of comma-separated values.

    Parameters
    ----------
    text : str
        One point per line: x, y, z. A header line may name the columns, in any order and among
        others, as in `t, x [m], y [m], z [m]`. A line with semicolons or tabs is split at these,
        and its numbers may have decimal commas. Empty lines and comments from # on are ignored.

    Returns
    -------
    ndarray, shape (n, 3)
        Tip positions [m].

    Raises
    ------
    InvalidInputError
        Names the line, and what is missing or wrong.

    """
    rows = list(_rows(text))
    columns: list[int] | None = None
    if rows and all(rows[0].number(i) is None for i in range(len(rows[0].fields))):
        header = rows.pop(0)
        columns = _header(header)
        for row in rows:
            _check_width(row, len(header.fields))
    return np.array([_point(row, columns) for row in rows], dtype=float).reshape(-1, len(AXES))


def _rows(text: str) -> Iterator[_Row]:
    for number, line in enumerate(text.splitlines(), 1):
        content = line.partition('#')[0]
        if content.strip(' \t,;'):
            mark = next((m for m in ';\t' if m in content.strip()), ',')
            yield _Row(number, [f.strip(' \t"') for f in content.strip().split(mark)], mark != ',')


def _header(row: _Row) -> list[int]:
    """Return the column indices of x, y and z."""
    names = [re.split(r'\W', field.lower())[0] for field in row.fields]
    for axis in AXES:
        if names.count(axis) != 1:
            raise InvalidInputError(
                f'line {row.line}: the header is {", ".join(row.fields)}, and must name one '
                f'column {axis}')
    return [names.index(axis) for axis in AXES]


def _check_width(row: _Row, width: int) -> None:
    """Refuse a line with more non-empty fields than the header has columns."""
    more = [field for field in row.fields[width:] if field]
    if more:
        raise InvalidInputError(
            f'line {row.line} is {", ".join(row.fields)}: the header has {width} columns, '
            f'{", ".join(map(shown, more))} {"is" if len(more) == 1 else "are"} too many')


def _point(row: _Row, columns: list[int] | None) -> list[float]:
    if columns is None and len(row.fields) != len(AXES):
        raise InvalidInputError(
            f'line {row.line} is {", ".join(row.fields)}, must be three numbers, x, y, z in m: '
            f'{_difference(row.fields)}')
    point = []
    for axis, column in zip(AXES, columns or range(len(AXES))):
        value = row.number(column) if column < len(row.fields) and row.fields[column] else None
        if value is None:
            found = row.fields[column] if column < len(row.fields) else ''
            what = f'{shown(found)}, must be a number' if found else 'missing'
            raise InvalidInputError(f'line {row.line}: {axis} is {what}')
        if not isfinite(value):
            raise InvalidInputError(f'line {row.line}: {axis} is {value}, must be finite')
        point.append(value)
    return point


def _number(text: str) -> float | None:
    try:
        return float(text)
    except ValueError:
        return None
