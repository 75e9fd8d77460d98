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

"""The faults that `benchmarks/mutations.py` puts in are in lines that the code still has."""

from __future__ import annotations

import runpy

from helpers.places import ROOT
import pytest

MUTATIONS = runpy.run_path(str(ROOT / 'benchmarks' / 'mutations.py'))['FAULTS']
FILES = [file for kind in ('*.py', '*.[ch]', '*.inc')
         for file in (ROOT / 'rrr_traj_planner').rglob(kind)]


@pytest.fixture(scope='module')
def sources():
    return [file.read_text() for file in FILES]


@pytest.mark.parametrize('folder', MUTATIONS)
def test_lines_are_each_in_one_file(folder, sources):
    assert (ROOT / folder).is_dir()
    for right, wrong in MUTATIONS[folder]:
        assert right != wrong
        assert sum(right in source for source in sources) == 1, right
