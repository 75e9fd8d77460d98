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

"""A figure with title and caption: SVG inside the page, PNG and CSV beside it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from io import StringIO
from pathlib import Path
import re
from typing import Any
from warnings import catch_warnings, filterwarnings

import matplotlib
from matplotlib.figure import Figure
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.planners.csv_columns import write_columns
from rrr_traj_planner.report.theme import STYLE, themed, WIDTH

PNG_RESOLUTION = 200  # dots per inch
REFERENCES = re.compile(r'(\bid="|url\(#|href="#)')
LEADING = re.compile(r'^.*?(?=<svg)', re.DOTALL)
METADATA = re.compile(r'<metadata>.*?</metadata>', re.DOTALL)


@dataclass(frozen=True, eq=False)
class Picture:
    """
    A figure, drawn when it is written.

    Parameters
    ----------
    name : str
        Name of its files and id in the page: letters, digits, underscores.
    title, caption : str
        Title and caption.
    draw : callable
        Draws on a matplotlib figure.
    height : float
        Height for a width of `theme.WIDTH` [inches].
    data : dict
        The data drawn: columns of the CSV by heading (with unit), of equal lengths.

    """

    name: str
    title: str
    caption: str
    draw: Callable[[Any], None]
    height: float = 3.2
    data: dict[str, Array] = field(default_factory=dict)

    @property
    def files(self) -> tuple[str, ...]:
        """Return the names of its files beside the page."""
        return (f'{self.name}.png', *([f'{self.name}.csv'] if self.data else []))

    def written(self, folder: Path) -> str:
        """
        Draw the figure.

        Parameters
        ----------
        folder : Path
            Folder of PNG and CSV.

        Returns
        -------
        str
            The figure as SVG, with variables of the style sheet as colours.

        """
        with matplotlib.rc_context(STYLE), catch_warnings():
            filterwarnings('ignore', 'Glyph')  # a name in a script that the font lacks has boxes
            figure = Figure(figsize=(WIDTH, self.height))
            self.draw(figure)
            figure.savefig(folder / f'{self.name}.png', dpi=PNG_RESOLUTION)
            figure.set_layout_engine('none')  # laid out once is enough for both
            text = StringIO()
            figure.savefig(text, format='svg', transparent=True, metadata={'Date': None})
        if self.data:
            write_columns(folder / f'{self.name}.csv', self.data, digits=9)
        return embedded(text.getvalue(), self.name, self.title)


def embedded(svg: str, name: str, title: str) -> str:
    """
    Return an SVG file as an element of a page.

    Parameters
    ----------
    svg : str
        The file as written by matplotlib.
    name : str
        Prefix of every id, so that ids of several pictures differ.
    title : str
        Label for screen readers.

    Returns
    -------
    str
        An element as wide as its container.

    """
    svg = METADATA.sub('', LEADING.sub('', svg, count=1))
    svg = REFERENCES.sub(rf'\g<1>{name}-', svg)
    svg = re.sub(r'<svg ([^>]*?)width="[^"]*"', r'<svg \1', svg, count=1)
    svg = re.sub(r'<svg ([^>]*?)height="[^"]*"', r'<svg \1', svg, count=1)
    label = title.replace('&', '&amp;').replace('"', '&quot;').replace('<', '&lt;')
    return themed(svg.replace('<svg ', f'<svg role="img" aria-label="{label}" ', 1))
