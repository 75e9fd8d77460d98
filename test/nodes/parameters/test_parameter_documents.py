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

"""README and docs name the parameters that there are, each of them somewhere."""

from __future__ import annotations

import re

from helpers.places import DOCS, ROOT
from rrr_traj_planner.nodes.parameters.table import TABLE

TEXTS = {path.name: path.read_text() for path in (ROOT / 'README.md', *DOCS.glob('*.md'))}
NAMES = {row.name.replace('{joint}', 'JOINT') for row in TABLE}
GROUPS = {name.rpartition('.')[0] for name in NAMES} - {''}
FILES = ('.yaml', '.c')  # endings of files whose names begin like a group


def named_in(text):
    """Return names in code type, after -p, and in YAML, that are of one of the groups."""
    found = re.findall(r'`([a-z_]+(?:\.[\w*]+)+)[`:]|-p ([a-z_.]+):=|^ *([a-z_]+\.[\w.]+):', text,
                       re.MULTILINE)
    names = {name for match in found for name in match if name}
    return {name for name in names if not name.endswith(FILES)
            and name.split('.')[0] in {group.split('.')[0] for group in GROUPS}}


def test_every_parameter_is_named_by_itself_or_with_its_group():
    text = '\n'.join(TEXTS.values())
    groups = {group for group in GROUPS if f'`{group}.*`' in text}
    assert [name for name in sorted(NAMES) if name.rpartition('.')[0] not in groups
            and not re.search(rf'(?<![\w.]){re.escape(name)}(?![\w.]*\w)', text)] == []


def test_no_other_is_named():
    wild = {f'{group}.*' for group in GROUPS}
    found = {name: file for file, text in TEXTS.items() for name in named_in(text)}
    assert len(found) > 15
    assert {name: file for name, file in found.items() if name not in NAMES | wild} == {}
