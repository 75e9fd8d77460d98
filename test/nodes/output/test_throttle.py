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

"""Lines that would come again and again."""

from __future__ import annotations

from rrr_traj_planner.nodes.output import throttle
from rrr_traj_planner.nodes.output.throttle import Throttle


def test_each_kind_passes_once_in_a_period(monkeypatch):
    now = [100.0]
    monkeypatch.setattr(throttle, 'monotonic', lambda: now[0])
    gate = Throttle(2.0)
    assert gate.passes('a', 'b')
    assert not gate.passes('a')
    assert not gate.passes('b', 'a')
    assert gate.passes('a', 'c')      # c is new, and a passes with it
    now[0] = 101.9
    assert not gate.passes('a')
    assert gate.suppressed('a') == 3
    assert gate.suppressed('a') == 0
    now[0] = 102.0
    assert gate.passes('b')
    assert not gate.passes('b')
