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

"""Via points in tables of comma-separated values: tip positions, or joint positions by name."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
import csv
from math import isfinite
import re
from typing import Any, NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.core.errors import did_you_mean, InvalidInputError, shown
from rrr_traj_planner.nodes.point_files.located import is_number, similar
from rrr_traj_planner.nodes.point_files.point_forms import AXES, difference

STOP_AT, DWELL = 'stop_at', 'dwell'
SIMILAR = 0.72  # of another column's name to these, with which it is refused; of stop, not state
TRUTH = {'true': True, 'yes': True, '1': True, 'false': False, 'no': False, '0': False}

# Factors to m, rad and s of the units that a header may name, as in `x [mm]`.
LENGTHS = {'m': 1.0, 'cm': 0.01, 'mm': 0.001}
ANGLES = {'rad': 1.0, 'deg': np.pi / 180.0, '°': np.pi / 180.0}
TIMES = {'s': 1.0, 'ms': 0.001}
MESSAGE_FIELD = re.compile(r'(?:.*[./])?(?:position|point)[./]([xyz])')  # pose.position.x
AXIS_AND_UNIT = re.compile(r'([xyz])_(mm|cm|m)')
QUOTED = re.compile(r'"(?:[^"]|"")*"')

POSITION = ' position'  # after a joint's name, in the columns of `Plan.to_csv`


class _Row(NamedTuple):
    """A line of a table that is neither empty nor a comment."""

    line: int
    fields: list[str]
    decimal_comma: bool

    def text(self, column: int) -> str:
        """Return a field, empty where the line is shorter."""
        return self.fields[column] if column < len(self.fields) else ''

    def is_number(self, column: int) -> bool:
        """Return whether a field is a number, if need be with a decimal comma."""
        return is_number(self.text(column).replace(',', '.'))

    def number(self, column: int, name: str) -> float:
        """Return a field as a number."""
        if not self.text(column):
            raise InvalidInputError(f'line {self.line}: {name} is missing')
        if not is_number(self._plain(column)):
            point = (' with a decimal point; decimal commas need columns that are split at '
                     'semicolons' if self.is_number(column) else '')
            raise InvalidInputError(
                f'line {self.line}: {name} is {shown(self.text(column))}, must be a number{point}')
        value = float(self._plain(column))
        if not isfinite(value):
            raise InvalidInputError(f'line {self.line}: {name} is {value}, must be finite')
        return value

    def truth(self, column: int, name: str) -> bool:
        """Return a field as a truth value."""
        text = self.text(column).lower()
        if text not in TRUTH:
            raise InvalidInputError(f'line {self.line}: {name} is {shown(self.text(column))}, '
                                    'must be true or false')
        return TRUTH[text]

    def _plain(self, column: int) -> str:
        text = self.text(column)
        return text.replace(',', '.') if self.decimal_comma else text


class _Column(NamedTuple):
    """A column of a table with a header."""

    place: int
    name: str
    unit: str  # empty: not given


class _Table(NamedTuple):
    """The lines of a table, and its columns, if a header names them."""

    rows: list[_Row]
    columns: list[_Column]
    header: _Row | None

    def column(self, names: Sequence[str], wanted: str) -> _Column:
        """Return the only column with one of some names."""
        found = [c for c in self.columns if c.name in names]
        if len(found) != 1:
            raise InvalidInputError(f'{self.head}, and must name one column {wanted}')
        return found[0]

    @property
    def head(self) -> str:
        """Return the header for a message."""
        return '' if self.header is None else (
            f'line {self.header.line}: the header is {", ".join(self.header.fields)}')

    def values(self, columns: Sequence[_Column], units: Mapping[str, float]) -> Array:
        """Return the numbers of columns in SI units, (lines, columns)."""
        for column in columns:
            if column.unit and column.unit not in units:
                raise InvalidInputError(
                    f'{self.head}, and {column.name} is in {shown(column.unit)}: must be in '
                    f'{", ".join(units)}')
        return np.array([[
            (units[c.unit] if c.unit else 1.0) * row.number(c.place, c.name) for c in columns]
            for row in self.rows])


class _TableJoints:
    """The joint positions in a table, in the order of an arm's joints on request."""

    def __init__(self, found: _Table) -> None:
        self._found = found

    def __len__(self) -> int:
        """Return the number of via points."""
        return len(self._found.rows)

    def __call__(self, joint_names: Sequence[str]) -> Array:
        """Return joint positions [rad]."""
        return _joints(self._found, joint_names)


def table(text: str) -> dict[str, Any]:
    """
    Return the content of a table of comma-separated values.

    Parameters
    ----------
    text : str
        One point per line: x, y, z. A header line may name the columns, in any order and among
        others, as in `t, x [m], y [m], z [m]`, or joints in place of x, y and z; there may be
        columns stop_at and dwell. A line with semicolons or tabs is split at these, and its
        numbers may have decimal commas. Fields may be quoted, by the rules of the `csv` module,
        but not over several lines. Empty lines and comments from # on are ignored.

    Returns
    -------
    dict
        Values of `Task`'s fields.

    Raises
    ------
    InvalidInputError
        Names the line, and what is missing or wrong.

    """
    found = _table(text)
    if found.header is None:
        given: dict[str, Any] = {'via_points': np.array([_point(row) for row in found.rows])}
    elif any(column.name in AXES for column in found.columns) or len(found.columns) < 3:
        given = {'via_points': _tips(found)}
    else:
        given = {'joint_positions': _TableJoints(found)}
    if not found.rows:
        raise InvalidInputError(
            'no via_points, must have a line x, y, z [m], or of joint positions [rad] by a header '
            'of joint names, for each')
    return {**given, **_rests(found)}


def _table(text: str) -> _Table:
    rows = list(_rows(text))
    if not rows or any(rows[0].is_number(i) for i in range(len(rows[0].fields))):
        return _Table(rows, [], None)
    header = rows.pop(0)
    for row in rows:
        _check_width(row, len(header.fields))
    return _Table(rows, [_column(i, field) for i, field in enumerate(header.fields)], header)


def _rows(text: str) -> Iterator[_Row]:
    for number, line in enumerate(text.splitlines(), 1):
        # Without the quoted parts, in which marks and # are text.
        bare = QUOTED.sub(lambda found: '_' * len(found[0]), line).partition('#')[0]
        content = line[:len(bare)].strip()
        if not content.strip(' \t,;'):
            continue
        if '"' in bare:
            raise InvalidInputError(
                f'line {number} is {shown(content)}: a quotation mark is not closed')
        mark = next((m for m in ';\t' if m in bare.strip()), ',')
        fields, = csv.reader([content], delimiter=mark, skipinitialspace=True)
        yield _Row(number, [field.strip() for field in fields], mark != ',')


def _column(index: int, field: str) -> _Column:
    """
    Return a column of a header: `NAME`, `NAME [UNIT]`, `NAME (UNIT)` or `"NAME, UNIT"`.

    An axis may also be named with its unit, as in `x_mm`, or as a message's field is in tables of
    recorded topics, as in `pose.position.x` or `/target/pose/position/x`.
    """
    parts = re.fullmatch(r'(.*?)\s*[\[(]\s*(.*?)\s*[\])]|(.*?)\s*,\s*(.*)', field)
    name, unit = (field, '') if parts is None else filter(
        lambda part: part is not None, parts.groups())
    lower = name.lower()
    if of_message := MESSAGE_FIELD.fullmatch(lower):
        lower = of_message[1]
    elif not unit and (with_unit := AXIS_AND_UNIT.fullmatch(lower)):
        lower, unit = with_unit.groups()
    return _Column(index, lower if lower in (*AXES, STOP_AT, DWELL) else name, unit)


def _check_width(row: _Row, width: int) -> None:
    """Refuse a line with more non-empty fields than the header has columns."""
    more = [field for field in row.fields[width:] if field]
    if more:
        raise InvalidInputError(
            f'line {row.line} is {", ".join(row.fields)}: the header has {width} columns, '
            f'{", ".join(map(shown, more))} {"is" if len(more) == 1 else "are"} too many')


def _point(row: _Row) -> list[float]:
    """Return the point of a line of a table without header."""
    if len(row.fields) != len(AXES):
        raise InvalidInputError(
            f'line {row.line} is {", ".join(row.fields)}, must be three numbers, x, y, z in m: '
            f'{difference(row.fields)}')
    return [row.number(column, axis) for column, axis in enumerate(AXES)]


def _tips(found: _Table) -> Array:
    """Return tip positions [m]."""
    return found.values([found.column([axis], axis) for axis in AXES], LENGTHS)


def _joints(found: _Table, joint_names: Sequence[str]) -> Array:
    """Return joint positions [rad]."""
    columns = []
    for joint in joint_names:
        others = [c.name for c in found.columns if c.name not in joint_names]
        near = similar(joint, others)
        columns.append(found.column(
            (joint, f'{joint}{POSITION}'), f'{joint} (or x, y and z)'
            + (f'; {did_you_mean(joint, by=near)}' if near else '')))
    return found.values(columns, ANGLES)


def _rests(found: _Table) -> dict[str, Any]:
    """Return where and how long the arm is to rest, if there are columns for it."""
    names = [column.name for column in found.columns]
    for name in names:
        near = similar(name.lower(), (STOP_AT, DWELL), SIMILAR)
        if near and name != near:
            raise InvalidInputError(f'{found.head}: unknown {name} ({did_you_mean(near)})')
    result: dict[str, Any] = {}
    if STOP_AT in names:
        result[STOP_AT] = _stops(found, found.column([STOP_AT], STOP_AT))
    if DWELL in names:
        column = found.column([DWELL], DWELL)
        filled = [row if row.text(column.place) else _filled(row, column.place)
                  for row in found.rows]
        result[DWELL] = found._replace(rows=filled).values([column], TIMES)[:, 0]
    return result


def _filled(row: _Row, column: int) -> _Row:
    """Return a line with 0 in an empty field."""
    fields = [*row.fields, *[''] * (column + 1 - len(row.fields))]
    fields[column] = '0'
    return row._replace(fields=fields)


def _stops(found: _Table, column: _Column) -> BoolArray:
    """Return whether the arm stops at each point; at the last also where its field is empty."""
    stops = [bool(row.text(column.place)) and row.truth(column.place, STOP_AT)
             for row in found.rows]
    stops[-1] |= not found.rows[-1].text(column.place)
    return np.array(stops)
