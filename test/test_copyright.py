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

"""Every source file begins with the notice of the licence, as ament_copyright reads it."""

from __future__ import annotations

import re

from helpers.places import ROOT

FOLDERS = ('rrr_traj_planner', 'rrr_traj_planner_interfaces', 'test', 'benchmarks', 'scripts')
FILES = [ROOT / 'setup.py', *sorted(
    file for folder in FOLDERS for kind in ('*.py', '*.cmake')
    for file in (ROOT / folder).rglob(kind))]

HOLDER = re.compile(r'# Copyright 20\d\d(-20\d\d)? rrr_traj_planner developers')


def licensed_under():
    """Return the notice that the licence itself asks for, from its appendix."""
    text = (ROOT / 'LICENSE').read_text()
    lines = text[text.index('   Licensed under the Apache License'):].splitlines()
    return [f'# {line[3:]}'.rstrip() for line in lines[:11]]


def has_notice(file):
    first, *rest = file.read_text().splitlines()[:14]
    return HOLDER.fullmatch(first) and rest == ['#', *licensed_under(), '']


def test_files_begin_with_the_notice():
    assert len(FILES) > 100
    assert [str(file.relative_to(ROOT)) for file in FILES if not has_notice(file)] == []
