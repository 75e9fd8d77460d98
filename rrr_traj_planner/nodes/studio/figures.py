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
from rrr_traj_planner.nodes.studio.planned import Planned
from rrr_traj_planner.nodes.studio.session import Refusal

RED = '#c62828'
# From slow to fast, each in red, green and blue: dark blue, purple, pink, orange (some of plasma).
SPEED_COLOURS = ((13, 8, 135), (126, 3, 168), (204, 71, 120), (248, 149, 64))
GREY = (160, 160, 160)


def plan_html(plan: Planned | None, refusal: Refusal | None, joint_names: Sequence[str]) -> str:
    """
    Return the figures of a plan, and why a newer one is refused.

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
    parts = []
    if refusal is not None:
        parts.append(f'<p style="color:{RED}"><b>refused</b>: {escape(refusal.text)}</p>')
    if plan is None:
        return _block(*parts, *([] if parts else ['<p>planning</p>']))
    grey = ' style="opacity:0.5"' if refusal is not None else ''
    head = 'last plan, ' if refusal is not None else ''
    note = f'<p>{escape(plan.note)}</p>' if plan.note else ''
    parts.append(
        f'<div{grey}><p>{head}{escape(plan.planner_id)}: <b>{plan.duration:.3f} s</b>, tip up to '
        f'{plan.speed.max():.2f} m/s, planned in {1e3 * plan.planning_time:.0f} ms</p>{note}'
        f'{_table(plan, joint_names)}</div>')
    return _block(*parts)


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


def _block(*parts: str) -> str:
    return f'<div style="padding:0 .75em;font-size:90%">{"".join(parts)}</div>'


def speed_colours(speed: Array, is_current: bool) -> NDArray[np.uint8]:
    """
    Return the colours of a path's segments.

    Parameters
    ----------
    speed : ndarray, shape (n,)
        Of the tip [m/s].
    is_current : bool
        Whether the plan is of the via points as they are; else all is grey.

    Returns
    -------
    ndarray, shape (n, 2, 3)
        Red, green and blue at both ends: from the first of `SPEED_COLOURS` at rest to the last at
        the highest speed.

    """
    if not is_current:
        return np.full((len(speed), 2, 3), GREY, dtype=np.uint8)
    share = speed / max(float(speed.max(initial=0.0)), np.finfo(float).tiny)
    at = np.linspace(0.0, 1.0, len(SPEED_COLOURS))
    rgb = np.stack([np.interp(share, at, channel) for channel in zip(*SPEED_COLOURS)], axis=-1)
    return np.repeat(rgb.round().astype(np.uint8)[:, None], 2, axis=1)
