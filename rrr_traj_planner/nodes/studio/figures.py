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

"""The page's texts: a plan's figures, a refusal, the arm's state; colours of a path."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from math import isinf

import numpy as np
from numpy.typing import NDArray
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.nodes.studio.planned import LIMITED, Planned
from rrr_traj_planner.nodes.studio.session import Refusal

RED = '#c62828'
# From slow to fast, each in red, green and blue: dark blue, purple, pink, orange (some of plasma).
SPEED_COLOURS = ((13, 8, 135), (126, 3, 168), (204, 71, 120), (248, 149, 64))
GREY = (160, 160, 160)

# Of the limits in `LIMITED`, where they are reached; where nothing of them is used, the last.
LIMIT_COLOURS = ((0, 90, 190), (225, 140, 0), (190, 40, 150), (50, 150, 40))
UNUSED = (225, 225, 225)

SPEED, TIGHTEST = 'speed of the tip', 'tightest limit'


def plan_html(plan: Planned | None, refusal: Refusal | None, joint_names: Sequence[str]) -> str:
    """
    Return the figures of a plan.

    Parameters
    ----------
    plan : Planned, optional
        The last plan.
    refusal : Refusal, optional
        None: the plan is the answer to the last request.
    joint_names : sequence of str
        The arm's joints.

    Returns
    -------
    str
        HTML.

    """
    if plan is None:
        return _block(*([] if refusal is not None else ['<p>planning</p>']))
    grey = ' style="opacity:0.5"' if refusal is not None else ''
    head = 'last plan, ' if refusal is not None else ''
    note = f'<p>{escape(plan.note)}</p>' if plan.note else ''
    return _block(
        f'<div{grey}><p>{head}{escape(plan.planner_id)}: <b>{plan.duration:.3f} s</b>, tip up to '
        f'{plan.speed.max():.2f} m/s, planned in {1e3 * plan.planning_time:.0f} ms</p>{note}'
        f'{_table(plan, joint_names)}</div>')


def refusal_html(refusal: Refusal | None) -> str:
    """
    Return why there is no plan of the via points as they are.

    Parameters
    ----------
    refusal : Refusal, optional
        None: there is one.

    Returns
    -------
    str
        HTML; empty without a refusal.

    """
    if refusal is None:
        return ''
    return _block(f'<p style="color:{RED}"><b>refused</b>: {escape(refusal.text)}</p>')


def _table(plan: Planned, joint_names: Sequence[str]) -> str:
    """Return peaks and limits: a row for each quantity, a column for each joint."""
    rows = [['peak / limit', *joint_names]]
    for name, peaks, limits in plan.peaks:
        rows.append([name, *(f'{peak:.4g} / {_limit(bound)}' for peak, bound in zip(
            peaks.tolist(), limits.tolist()))])
    cells = ''.join('<tr>' + ''.join(f'<td style="padding:0 .6em .2em 0">{escape(cell)}</td>'
                                     for cell in row) + '</tr>' for row in rows)
    return f'<table style="font-size:85%">{cells}</table>'


def _limit(bound: float) -> str:
    return 'none' if isinf(bound) else f'{bound:.4g}'


def status_html(text: str, is_error: bool = False) -> str:
    """
    Return a line about the arm.

    Parameters
    ----------
    text : str
        The line.
    is_error : bool
        Whether it is red.

    Returns
    -------
    str
        HTML.

    """
    colour = f' style="color:{RED}"' if is_error else ''
    return _block(f'<p{colour}>{escape(text)}</p>')


def notes_html(notes: Sequence[str]) -> str:
    """
    Return notes.

    Parameters
    ----------
    notes : sequence of str
        One a line.

    Returns
    -------
    str
        HTML.

    """
    return _block(*(f'<p>{escape(note)}</p>' for note in notes))


def _block(*parts: str) -> str:
    return f'<div style="padding:0 .75em;font-size:90%">{"".join(parts)}</div>'


def path_colours(plan: Planned, meaning: str, is_current: bool) -> NDArray[np.uint8]:
    """
    Return the colours of a path's segments.

    Parameters
    ----------
    plan : Planned
        With n points.
    meaning : str
        `SPEED`: from the first of `SPEED_COLOURS` at rest to the last at the highest speed;
        `TIGHTEST`: of `LIMIT_COLOURS` the one of the limit that is used most, paler the less of it
        is used.
    is_current : bool
        Whether the plan is of the via points as they are; else all is grey.

    Returns
    -------
    ndarray, shape (n - 1, 2, 3)
        Red, green and blue at both ends.

    """
    if not is_current:
        rgb = np.broadcast_to(np.array(GREY, dtype=float), (len(plan.path), 3))
    elif meaning == SPEED:
        return np.repeat(_rounded(_speed_colours(plan.speed))[:, None], 2, axis=1)
    else:
        shares = plan.shares
        used = np.clip(shares.max(axis=1, keepdims=True), 0.0, 1.0)
        rgb = (1.0 - used) * UNUSED + used * np.array(LIMIT_COLOURS)[shares.argmax(axis=1)]
    return np.stack((_rounded(rgb[:-1]), _rounded(rgb[1:])), axis=1)


def _speed_colours(speed: Array) -> Array:
    share = speed / max(float(speed.max(initial=0.0)), np.finfo(float).tiny)
    at = np.linspace(0.0, 1.0, len(SPEED_COLOURS))
    return np.stack([np.interp(share, at, channel) for channel in zip(*SPEED_COLOURS)], axis=-1)


def _rounded(rgb: Array) -> NDArray[np.uint8]:
    return rgb.round().astype(np.uint8)


def legend_html(plan: Planned | None, meaning: str) -> str:
    """
    Return what the colours of a path mean.

    Parameters
    ----------
    plan : Planned, optional
        The path's.
    meaning : str
        As in `path_colours`.

    Returns
    -------
    str
        HTML; empty without a plan.

    """
    if plan is None:
        return ''
    if meaning == SPEED:
        fastest = float(plan.speed.max(initial=0.0))
        return _block(_bar(SPEED_COLOURS), _ends('at rest', f'{fastest:.2f} m/s'))
    used = plan.shares.argmax(axis=1)
    steps = np.diff(plan.times, append=plan.times[-1:])
    whole = max(plan.duration, np.finfo(float).tiny)
    rows = ''.join(
        f'<tr><td style="padding-right:.6em">{name}</td><td style="width:55%">'
        f'{_bar((UNUSED, colour))}</td><td style="padding-left:.6em">'
        f'{100.0 * steps[used == i].sum() / whole:.0f} %</td></tr>'
        for i, (name, colour) in enumerate(zip(LIMITED, LIMIT_COLOURS)))
    return _block(f'<table style="width:100%">{rows}</table>',
                  '<p>The limit of which a joint uses most, and for how much of the time; paler '
                  'where less of it is used.</p>')


def _bar(colours: Sequence[tuple[int, int, int]]) -> str:
    stops = ','.join(f'rgb{colour}' for colour in colours)
    return (f'<div style="height:.8em;border-radius:.2em;background:linear-gradient(90deg,{stops})'
            '"></div>')


def _ends(left: str, right: str) -> str:
    return (f'<div style="display:flex;justify-content:space-between"><span>{left}</span>'
            f'<span>{right}</span></div>')
