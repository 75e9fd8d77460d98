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

"""Each planner in a line, for `planner --help`."""

from subprocess import run
import sys

from rrr_traj_planner.planners.method_summaries import method_summaries
from rrr_traj_planner.planners.registry import planner_ids


def test_every_planner_has_a_line_that_says_something():
    found = method_summaries()
    assert list(found) == planner_ids()
    for summary in found.values():
        assert 20 < len(summary) < 76  # with the id, a line
        assert summary[-1] not in '.:`'


def test_no_planner_is_imported_for_it():
    code = ('import sys, rrr_traj_planner.planners.method_summaries as m; m.method_summaries(); '
            'sys.exit("numpy" in sys.modules)')
    assert run([sys.executable, '-c', code], check=False).returncode == 0
