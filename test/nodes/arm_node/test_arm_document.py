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

"""docs/arm.md: it names what there is."""

from __future__ import annotations

import re

from helpers.places import ROOT
from rrr_traj_planner.nodes.parameters.table import ARM, rows_of

DOCUMENT = (ROOT / 'docs' / 'arm.md').read_text()

GROUPS = ('payload', 'friction', 'soft_stops', 'encoder', 'constraints', 'cmd_timeout',
          'allow_partial_joints_goal', 'allow_nonzero_velocity_at_trajectory_end',
          'publish_clock', 'real_time_factor')


def test_every_option_of_the_arm_is_documented_with_its_unit():
    rows = [row for row in rows_of(ARM, ('JOINT',) * 3).values()
            if row.name.split('.')[0] in GROUPS]
    units = {row.name: row.unit for row in rows}
    documented = dict(re.findall(r'^\| `([\w.]+)` \| ([^|]*?) ?\|', DOCUMENT, re.MULTILINE))
    assert documented == units


def test_every_test_that_is_named_exists():
    tests = ''.join(path.read_text() for path in (ROOT / 'test').rglob('test_*.py'))
    named = re.findall(r'`(test_\w+)`', DOCUMENT)
    assert len(named) > 20
    assert [name for name in named if f'def {name}(' not in tests] == []


def test_every_rule_has_a_test():
    rules = DOCUMENT.split('| rule | in JTC | test |')[1].split('\n\n')[0].splitlines()[2:]
    assert len(rules) > 15
    assert [rule for rule in rules if '`test_' not in rule.rsplit(' | ', 1)[1]] == []
