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

"""
Style of figures: colours by role, in a light and a dark theme.

Figures are drawn in the light colours. In the page's SVG each colour is replaced by a variable of
the style sheet, which follows the reader's theme; so no two roles may share a colour.
"""

from __future__ import annotations

from typing import Any

LIGHT = {
    'ink': '#1b1f24', 'muted': '#5b6470', 'grid': '#d5d9df', 'paper': '#ffffff',
    'band': '#eef1f5', 'limit': '#7d8590', 'transition': '#e3ecf9',
    'joint-1': '#0072b2', 'joint-2': '#c14f00', 'joint-3': '#008561',
    'tip': '#b0518c', 'via': '#d69100', 'arm': '#9aa3ad', 'extra-1': '#7a5cc0',
    'extra-2': '#8a6d3b', 'extra-3': '#2f8f9d', 'extra-4': '#ad3440', 'extra-5': '#56653f',
    'extra-6': '#35507a'}
DARK = {
    'ink': '#e8eaed', 'muted': '#a5adb8', 'grid': '#3a424d', 'paper': '#171b21',
    'band': '#222831', 'limit': '#8d96a2', 'transition': '#22344f',
    'joint-1': '#56b4e9', 'joint-2': '#ff9248', 'joint-3': '#2fcf9f',
    'tip': '#e58fc4', 'via': '#f0b840', 'arm': '#7b8591', 'extra-1': '#b39cf0',
    'extra-2': '#cdb07a', 'extra-3': '#6ccfdc', 'extra-4': '#ff8089', 'extra-5': '#b0c48f',
    'extra-6': '#8fb0e6'}

JOINTS = (LIGHT['joint-1'], LIGHT['joint-2'], LIGHT['joint-3'])
DASHES: tuple[Any, ...] = ('-', (0, (5, 1.5)), (0, (1.5, 1.2)))  # distinct in black and white too
SERIES = (*JOINTS, *(LIGHT[f'extra-{i}'] for i in (1, 4, 3, 2, 5, 6)), LIGHT['tip'])

WIDTH = 4.7  # inches: one column, legible on a phone

STYLE: Any = {
    'font.family': 'sans-serif', 'font.sans-serif': ['DejaVu Sans'], 'font.size': 9.0,
    'axes.titlesize': 9.5, 'axes.labelsize': 9.0, 'legend.fontsize': 8.5,
    'xtick.labelsize': 8.5, 'ytick.labelsize': 8.5,
    'axes.grid': True, 'axes.axisbelow': True, 'axes.spines.top': False,
    'axes.spines.right': False, 'grid.linewidth': 0.6, 'lines.linewidth': 1.5,
    'axes.linewidth': 0.8, 'legend.frameon': False, 'figure.constrained_layout.use': True,
    'figure.facecolor': LIGHT['paper'], 'axes.facecolor': LIGHT['paper'],
    'savefig.facecolor': LIGHT['paper'], 'text.color': LIGHT['ink'],
    'axes.edgecolor': LIGHT['muted'], 'axes.labelcolor': LIGHT['ink'],
    'axes.titlecolor': LIGHT['ink'], 'xtick.color': LIGHT['muted'],
    'ytick.color': LIGHT['muted'], 'xtick.labelcolor': LIGHT['ink'],
    'ytick.labelcolor': LIGHT['ink'], 'grid.color': LIGHT['grid'],
    'svg.fonttype': 'none', 'svg.hashsalt': 'rrr_traj_planner', 'path.simplify': True}

LIMIT: dict[str, Any] = {
    'color': LIGHT['limit'], 'linewidth': 0.9, 'linestyle': '--', 'zorder': 1.5}
VIA: dict[str, Any] = {'color': LIGHT['via'], 'linewidth': 0.9, 'linestyle': '-', 'zorder': 1.2}


def variables(colours: dict[str, str]) -> str:
    """
    Return colours as variables of a style sheet.

    Parameters
    ----------
    colours : dict
        Colours by role.

    Returns
    -------
    str
        CSS declarations.

    """
    return ' '.join(f'--{role}: {colour};' for role, colour in colours.items())


def themed(svg: str) -> str:
    """
    Replace a picture's colours by the style sheet's variables.

    Parameters
    ----------
    svg : str
        The picture in the light colours.

    Returns
    -------
    str
        The picture with variables as colours.

    """
    for role, colour in LIGHT.items():
        svg = svg.replace(f': {colour}', f': var(--{role})')
    return svg
