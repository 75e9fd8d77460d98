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

"""Writes a self-contained web page: sections with pictures, tables and animations."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from importlib.resources import files
from pathlib import Path
from typing import Protocol

from rrr_traj_planner.report.page_files import GENERATOR, listed, PAGE, remove_earlier
from rrr_traj_planner.report.theme import DARK, LIGHT, variables


class Content(Protocol):
    """An element of a section: a picture, a table or an animation."""

    @property
    def name(self) -> str:
        """Return its id in the page."""

    @property
    def title(self) -> str:
        """Return its title."""

    @property
    def caption(self) -> str:
        """Return its caption."""

    @property
    def files(self) -> tuple[str, ...]:
        """Return the names of its files beside the page."""

    def written(self, folder: Path) -> str:
        """
        Write its files and return its HTML.

        Parameters
        ----------
        folder : Path
            Folder of the files.

        Returns
        -------
        str
            The content as HTML.

        """


@dataclass(frozen=True, eq=False)
class Section:
    """
    A part of a page.

    Parameters
    ----------
    title, text : str
        Title and introduction, plain text.
    contents : sequence of Content
        Shown side by side on a wide page; tables one below the other.

    """

    title: str
    text: str
    contents: Sequence[Content]


def write_page(folder: Path, title: str, text: str, sections: Sequence[Section]) -> Path:
    """
    Write a page and its files; replace an earlier report in the same folder.

    Files of the earlier report that are not part of the new one are removed, unless they have been
    changed since. Other files remain.

    Parameters
    ----------
    folder : Path
        Folder of the page and its files; created if missing.
    title, text : str
        Title and introduction.
    sections : sequence of Section
        The sections.

    Returns
    -------
    Path
        The page; it is written last, so that its files exist.

    Raises
    ------
    OSError
        If a file cannot be written; FileExistsError if there is a page that is not a report.

    """
    folder.mkdir(parents=True, exist_ok=True)
    names = {name for section in sections for content in section.contents
             for name in content.files}
    remove_earlier(folder, names)
    body = '\n'.join(_section(folder, i, section) for i, section in enumerate(sections))
    page = folder / PAGE
    page.write_text(f"""<!DOCTYPE html>
<html lang="en">
{_head(title)}
<body>
<header><h1>{escape(title)}</h1>{paragraphs(text)}{_links(sections)}</header>
<main>
{body}
</main>
{listed(folder, names)}
</body>
</html>
""", encoding='utf-8')
    return page


def resource(name: str) -> str:
    """
    Return the content of a text file of this package.

    Parameters
    ----------
    name : str
        The file's name.

    Returns
    -------
    str
        Its content.

    """
    return files('rrr_traj_planner.report').joinpath(name).read_text(encoding='utf-8')


def paragraphs(text: str) -> str:
    """
    Return plain text as HTML paragraphs.

    Parameters
    ----------
    text : str
        Paragraphs, separated by empty lines.

    Returns
    -------
    str
        HTML elements.

    """
    return ''.join(f'<p>{escape(part)}</p>' for part in text.split('\n\n') if part.strip())


def _head(title: str) -> str:
    return f"""<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<meta name="generator" content="{GENERATOR}">
<link rel="icon" href="data:,">
<title>{escape(title)}</title>
<style>
:root {{ {variables(LIGHT)} }}
@media (prefers-color-scheme: dark) {{ :root {{ {variables(DARK)} }} }}
{resource('page.css')}</style>
</head>"""


def _links(sections: Sequence[Section]) -> str:
    items = ''.join(f'<li><a href="#section-{i}">{escape(section.title)}</a></li>'
                    for i, section in enumerate(sections))
    return f'<nav><ul>{items}</ul></nav>'


def _section(folder: Path, number: int, section: Section) -> str:
    cards = '\n'.join(_card(folder, content) for content in section.contents)
    return (f'<section id="section-{number}"><h2>{escape(section.title)}</h2>'
            f'{paragraphs(section.text)}\n<div class="cards">{cards}</div></section>')


def _card(folder: Path, content: Content) -> str:
    kind = type(content).__name__.lower()
    return (f'<figure id="{content.name}" class="{kind}">'
            f'<h3>{escape(content.title)}</h3>{content.written(folder)}'
            f'<figcaption>{escape(content.caption)}</figcaption></figure>')
