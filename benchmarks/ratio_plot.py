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

"""The benchmarks as a picture: every ratio over its target, on one axis."""

from __future__ import annotations

import math
from pathlib import Path

from matplotlib.figure import Figure
from measuring import Row

MET, MISSED = '#2a7a3b', '#c0392b'
INCHES_A_ROW, WIDTH, MARGIN = 0.22, 13.0, 1.8
DPI = 120
EDGE_FACTOR = 2.5  # factor between the outermost ratios and the edges


def draw(rows: list[Row], setting: str, path: Path) -> None:
    """
    Write the picture of rows that have targets.

    Parameters
    ----------
    rows : list of Row
        From top to bottom.
    setting : str
        The machine, printed below.
    path : Path
        Of the PNG.

    """
    shares = [row.ratio / row.target for row in rows]
    shown = [s for s in shares if math.isfinite(s) and s > 0.0]
    low, high = min([*shown, 0.5]) / EDGE_FACTOR, max([*shown, 2.0]) * EDGE_FACTOR
    figure = Figure(figsize=(WIDTH, INCHES_A_ROW * len(rows) + MARGIN), layout='constrained')
    axes = figure.subplots()
    for y, (row, share) in enumerate(zip(rows, shares)):
        x = min(max(share, low), high) if not math.isnan(share) else high
        axes.plot((1.0, x), (y, y), color=MET if row.met else MISSED, linewidth=1.2, zorder=2)
        axes.plot(x, y, 'o', color=MET if row.met else MISSED, markersize=5.0, zorder=3)
        axes.annotate(f'{row.ratio:.3g}', (x, y), (6 if x >= 1.0 else -6, 0),
                      textcoords='offset points', fontsize=7, va='center',
                      ha='left' if x >= 1.0 else 'right')
    axes.axvline(1.0, color='black', linewidth=1.0, zorder=1)
    axes.set_xscale('log')
    axes.set_xlim(low, high)
    axes.set_ylim(len(rows) - 0.4, -0.6)
    axes.set_yticks(range(len(rows)), [f'{row.row}   (target {row.target:.3g})' for row in rows],
                    fontsize=7.5)
    axes.grid(axis='x', which='major', linewidth=0.5, color='0.85')
    axes.set_xlabel('ratio / target [1], logarithmic; 1 is the target: green met, red missed\n'
                    'number at the point: the ratio, ours / theirs [1]')
    axes.set_title('rrr_traj_planner: what make bench has measured, over its target')
    figure.text(0.01, 0.002, setting.replace('\n', '; '), fontsize=6.5, color='0.35')
    figure.get_layout_engine().set(rect=(0.0, 0.02, 1.0, 0.98))
    figure.savefig(path, dpi=DPI)
