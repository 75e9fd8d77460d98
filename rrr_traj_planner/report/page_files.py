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

"""The list of a page's files, with digests, and removal of the files of an earlier page."""

from __future__ import annotations

from collections.abc import Iterable
from hashlib import sha256
import json
from pathlib import Path
import re

PAGE = 'index.html'
GENERATOR = 'rrr_traj_planner report'
LIST = re.compile(r'<script type="application/json" id="files">(.*?)</script>', re.DOTALL)


def listed(folder: Path, names: Iterable[str]) -> str:
    """
    Return the list of a page's files with their SHA-256 digests.

    Parameters
    ----------
    folder : Path
        Folder of the files.
    names : iterable of str
        Their names.

    Returns
    -------
    str
        An invisible element of the page.

    """
    digests = {name: _digest(folder / name) for name in sorted(names)}
    return f'<script type="application/json" id="files">{json.dumps(digests)}</script>'


def remove_earlier(folder: Path, retained: Iterable[str]) -> None:
    """
    Remove the files that an earlier page lists and that have not been changed since.

    Parameters
    ----------
    folder : Path
        Folder of the page.
    retained : iterable of str
        Names of files that are not removed, because the new page has them too.

    Raises
    ------
    FileExistsError
        If there is a page that is not a report.

    """
    page = folder / PAGE
    if not page.exists():
        return
    text = page.read_text(encoding='utf-8', errors='replace')
    if f'content="{GENERATOR}"' not in text:
        raise FileExistsError(f'{page} is not a report of this program: choose another folder')
    found = LIST.search(text)
    digests = json.loads(found[1]) if found else {}
    for name in digests.keys() - set(retained):
        file = folder / name
        if file.name == name and file.is_file() and _digest(file) == digests[name]:
            file.unlink()


def _digest(file: Path) -> str:
    return sha256(file.read_bytes()).hexdigest()
