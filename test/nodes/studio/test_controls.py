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

"""Values of the panel's controls: the user's, when typed, and of what they were given."""

from __future__ import annotations

from asyncio import run, sleep
from types import SimpleNamespace

from rrr_traj_planner.nodes.studio.panel.controls import given

PAUSE = 0.05  # s


class Number:
    """A control with a value, as viser has them."""

    def on_update(self, changed):
        self.changed = changed

    async def give(self, value, client_id=1):
        self.value = value
        await self.changed(SimpleNamespace(client_id=client_id))


def taken(script, pause=PAUSE):
    """Return what is taken from a control that is used as in a coroutine function."""
    number, found, chosen = Number(), [], SimpleNamespace(index=2)
    given(number, lambda act: act(), lambda *values: found.append(values), pause,
          lambda: chosen.index)

    async def used():
        await script(number, chosen)
        await sleep(4.0 * PAUSE)

    run(used())
    return found


def test_of_what_is_typed_the_whole_is_taken():
    async def script(number, _):
        for value in (0.0, 0.4, 0.45):
            await number.give(value)

    assert taken(script) == [(0.45, 2)]
    assert taken(script, pause=0.0) == [(0.0, 2), (0.4, 2), (0.45, 2)]


def test_what_the_page_sets_is_not_taken():
    async def script(number, _):
        await number.give(0.5, client_id=None)

    assert taken(script) == taken(script, pause=0.0) == []


def test_each_number_is_of_the_point_that_was_chosen_when_it_was_typed():
    async def script(number, chosen):
        await number.give(0.1)
        chosen.index = 3
        await sleep(2.0 * PAUSE)
        await number.give(0.2)
        chosen.index = 4
        await number.give(0.3)

    assert taken(script) == [(0.1, 2), (0.2, 3), (0.3, 4)]
