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

"""One page that stands alone: sections with pictures, tables and animations, styles inside."""

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
    """What a section shows, and what is written beside the page for it."""

    @property
    def name(self) -> str:
        """Its place in the page."""

    @property
    def title(self) -> str:
        """Return what it is."""

    @property
    def caption(self) -> str:
        """Return what there is to see."""

    @property
    def files(self) -> tuple[str, ...]:
        """Return the names of what is written beside the page."""

    def written(self, folder: Path) -> str:
        """
        Write its files.

        Parameters
        ----------
        folder : Path
            Where they go.

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
        What it is about; text is plain.
    contents : sequence of Content
        Shown beside each other where there is room, tables below each other.

    """

    title: str
    text: str
    contents: Sequence[Content]


def write_page(folder: Path, title: str, text: str, sections: Sequence[Section]) -> Path:
    """
    Write a page and the files beside it, in the place of an earlier one.

    What an earlier page had beside it, and this one has not, is removed; files that have changed
    since, and all others, are left alone.

    Parameters
    ----------
    folder : Path
        Where everything goes; made if it is missing. Nothing is written elsewhere.
    title, text : str
        What the page is.
    sections : sequence of Section
        What it shows.

    Returns
    -------
    Path
        The page, written last: if it is there, all else is.

    Raises
    ------
    OSError
        If something cannot be written; FileExistsError if a page is there that is no report.

    """
    folder.mkdir(parents=True, exist_ok=True)
    names = {name for section in sections for content in section.contents
             for name in content.files}
    remove_earlier(folder, names)
    body = '\n'.join(_section(folder, i, section) for i, section in enumerate(sections))
    links = ''.join(f'<li><a href="#section-{i}">{escape(s.title)}</a></li>'
                    for i, s in enumerate(sections))
    page = folder / PAGE
    page.write_text(f"""<!DOCTYPE html>
<html lang="en">
<head>
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
</head>
<body>
<header><h1>{escape(title)}</h1>{paragraphs(text)}<nav><ul>{links}</ul></nav></header>
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
    Return a text file of this package.

    Parameters
    ----------
    name : str
        The file's.

    Returns
    -------
    str
        What it holds.

    """
    return files('rrr_traj_planner.report').joinpath(name).read_text(encoding='utf-8')


def paragraphs(text: str) -> str:
    """
    Return a text as HTML.

    Parameters
    ----------
    text : str
        Paragraphs, with empty lines between them.

    Returns
    -------
    str
        Elements.

    """
    return ''.join(f'<p>{escape(part)}</p>' for part in text.split('\n\n') if part.strip())


def _section(folder: Path, number: int, section: Section) -> str:
    cards = '\n'.join(_card(folder, content) for content in section.contents)
    return (f'<section id="section-{number}"><h2>{escape(section.title)}</h2>'
            f'{paragraphs(section.text)}\n<div class="cards">{cards}</div></section>')


def _card(folder: Path, content: Content) -> str:
    kind = type(content).__name__.lower()
    return (f'<figure id="{content.name}" class="{kind}">'
            f'<h3>{escape(content.title)}</h3>{content.written(folder)}'
            f'<figcaption>{escape(content.caption)}</figcaption></figure>')
