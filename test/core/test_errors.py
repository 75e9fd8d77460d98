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

"""Errors: what their messages may hold."""

from __future__ import annotations

import pytest
from rrr_traj_planner.core.errors import quoted


@pytest.mark.parametrize(('text', 'shown'), [
    ('cycloid', "'cycloid'"), ('', "''"), ('a\nb', r"'a\nb'"), ('\x1b[2J', r"'\x1b[2J'")])
def test_text_from_outside_is_quoted_on_one_line(text, shown):
    assert quoted(text) == shown


def test_long_text_loses_its_middle():
    shown = quoted('begin' + 'x' * 10 ** 6 + 'end')
    assert len(shown) <= 60
    assert shown.startswith("'begin") and '...' in shown and shown.endswith("end'")
