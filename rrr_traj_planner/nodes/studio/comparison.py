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

"""The same via points by every planner: asked one after another, side by side in a table."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import fields
from html import escape
from typing import Any, NamedTuple

import numpy as np
from rrr_traj_planner.nodes.studio.planned import LIMITED, Planned
from rrr_traj_planner.nodes.studio.session import Refusal
from rrr_traj_planner.nodes.studio.wanted import Wanted
from rrr_traj_planner.report.excitation import IN_TEXT

CELL = 'style="padding:0 .3em .2em 0;text-align:right"'
FIRST = 'style="padding:0 .3em .2em 0;white-space:nowrap"'


# Asks for a plan; the second argument is called with the answer.
Ask = Callable[[Wanted, Callable[[Planned | Refusal], None]], None]


class Row(NamedTuple):
    """A planner and its answer."""

    planner_id: str
    answer: Planned | Refusal


class Comparison:
    """
    The plans of several planners.

    Parameters
    ----------
    planner_ids : sequence of str
        Who are asked.
    ask : callable
        Gets what is to be planned, and what is to be called with the answer, later.
    is_free : callable
        Returns whether nothing else is asked for: that comes first.
    show : callable
        Called when there is something new, with the comparison.

    Attributes
    ----------
    rows : list of Row
        The answers so far, fastest motions first, refusals last.
    is_current : bool
        Whether they are of the via points as they are.

    """

    def __init__(self, planner_ids: Sequence[str], ask: Ask, is_free: Callable[[], bool],
                 show: Callable[[Comparison], None]) -> None:
        self.rows: list[Row] = []
        self.is_current = False
        self._planner_ids, self._ask, self._is_free, self._show = planner_ids, ask, is_free, show
        self._wanted: Wanted | None = None
        self._waiting: list[str] = []
        self._in_flight: Wanted | None = None

    @property
    def waits_for(self) -> str:
        """Return the planner whose answer is next; empty: all have answered."""
        return self._waiting[0] if self._waiting else ''

    @property
    def planned(self) -> tuple[str, ...]:
        """Return whose plans of the via points as they are there are, if there are any."""
        return tuple(row.planner_id for row in self.rows
                     if self.is_current and isinstance(row.answer, Planned))

    def start(self, wanted: Wanted) -> None:
        """
        Begin, and forget the rows.

        Parameters
        ----------
        wanted : Wanted
            What is planned, whichever planner it names.

        """
        self.rows, self.is_current = [], True
        self._wanted, self._waiting = wanted, list(self._planner_ids)
        self.go_on()

    def changed(self, wanted: Wanted) -> None:
        """
        End where something else is wanted by now, but for the planner.

        Parameters
        ----------
        wanted : Wanted
            What is wanted.

        """
        if self._wanted is not None and not _same(self._wanted, wanted):
            self.is_current, self._waiting = False, []
            self._show(self)

    def go_on(self) -> None:
        """Ask the next planner, unless another answer is waited for; called after each of them."""
        if self._waiting and self._in_flight is None and self._is_free() and self._wanted:
            self._in_flight = asked = self._wanted.with_planner(self._waiting[0])
            self._ask(asked, lambda answer: self._answered(asked, answer))
        if self._waiting:
            self._show(self)

    def _answered(self, asked: Wanted, answer: Planned | Refusal) -> None:
        """Take an answer, unless something else is compared by now, and ask the next planner."""
        self._in_flight = None
        name = asked.task.planner_id
        if name in self._waiting and self._wanted and _same(asked, self._wanted):
            self._waiting.remove(name)
            self.rows.append(Row(name, answer))
            self.rows.sort(key=lambda row: (
                row.answer.duration if isinstance(row.answer, Planned) else np.inf))
            self._show(self)
        self.go_on()

    def plan_of(self, planner_id: str) -> Planned | None:
        """
        Return a planner's plan.

        Parameters
        ----------
        planner_id : str
            Who.

        Returns
        -------
        Planned or None
            None where there is none of the via points as they are.

        """
        return next((row.answer for row in self.rows if row.planner_id == planner_id
                     and self.is_current and isinstance(row.answer, Planned)), None)


def _same(a: Wanted, b: Wanted) -> bool:
    """Return whether the same is wanted, but for the planner."""
    return _equal(a, b, 'task') and _equal(a.task, b.task, 'planner_id')


def _equal(a: Any, b: Any, besides: str) -> bool:
    """Return whether all fields but one are the same object, or equal."""
    values = ((getattr(a, field.name), getattr(b, field.name))
              for field in fields(a) if field.name != besides)
    return all(x is y or np.array_equal(x, y) for x, y in values)


def comparison_html(comparison: Comparison) -> str:
    """
    Return the plans as a table.

    Parameters
    ----------
    comparison : Comparison
        So far.

    Returns
    -------
    str
        HTML; empty before the first answer.

    """
    grey = '' if comparison.is_current else 'opacity:0.5;'
    waits = comparison.waits_for
    parts = [] if comparison.is_current or not comparison.rows else [
        '<p>of other via points or options than those now</p>']
    if comparison.rows:
        parts.append(f'<table style="font-size:78%">{_head()}'
                     f'{"".join(map(_row, comparison.rows))}</table>')
        parts += [f'<p style="font-size:80%">* {escape(row.planner_id)}: '
                  f'{escape(row.answer.note)}</p>' for row in comparison.rows
                  if isinstance(row.answer, Planned) and row.answer.note]
    if waits:
        parts.append(f'<p>planning: {escape(waits)}</p>')
    return f'<div style="{grey}padding:0 .75em;font-size:90%">{"".join(parts)}</div>'


def _head() -> str:
    def cell(text: str, span: int = 1) -> str:
        return f'<th colspan="{span}" {CELL}>{text}</th>'

    names = {'velocity': 'vel.', 'acceleration': 'acc.', 'jerk': 'jerk', 'torque': 'torque'}
    return (f'<tr>{cell("", 2)}{cell("peaks [% of limits]", len(LIMITED))}{cell("planned")}'
            f'{cell("vibration")}</tr><tr>{cell("")}{cell("s")}'
            + ''.join(cell(names[name]) for name in LIMITED)
            + f'{cell("in ms")}{cell(f"{IN_TEXT[0]:g} Hz")}</tr>')


def _row(row: Row) -> str:
    answer = row.answer
    note = answer.note if isinstance(answer, Planned) else ''
    mark = f'<span title="{escape(note)}" style="cursor:help">*</span>' if note else ''
    name = f'<td {FIRST}>{escape(row.planner_id)}{mark}</td>'
    if isinstance(answer, Refusal):
        return (f'<tr>{name}<td colspan="{len(LIMITED) + 3}">refused: {escape(answer.text)}</td>'
                '</tr>')
    peaks = [float((peaks / limits).max()) for _, peaks, limits in answer.peaks]
    cells = [f'<b>{answer.duration:.3f}</b>',
             *(f'{100.0 * share:.0f}' if share else '-' for share in peaks),
             f'{1e3 * answer.planning_time:.0f}']
    vibration = answer.vibration()
    rings = ', '.join(f'{x:.2g} at {f:g} Hz' for x, f in zip(vibration, IN_TEXT))
    last = ''.join(f'{x:.2g}' for x in vibration[:1])
    return (f'<tr>{name}{"".join(f"<td {CELL}>{cell}</td>" for cell in cells)}'
            f'<td {CELL} title="residual vibration [rad/s²]: {rings}">{last}</td></tr>')
