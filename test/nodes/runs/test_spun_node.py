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

"""What other threads have a spun node do."""

from __future__ import annotations

from threading import Event

from helpers.goal_client import DEADLINE
from rrr_traj_planner.nodes.runs.spun_node import SpunNode


def test_functions_posted_while_the_executor_is_busy_are_called_in_their_order(ros):
    node = ros.add(SpunNode('spun', context=ros.context))
    busy, posted, done, called = Event(), Event(), Event(), []
    node.post(lambda: (busy.set(), posted.wait(DEADLINE)))
    assert busy.wait(DEADLINE)
    for number in range(20):
        node.post(called.append, number)
    node.post(done.set)
    posted.set()
    assert done.wait(DEADLINE)
    assert called == list(range(20))
