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

"""Numbers and positions as they are typed into the panel."""

from __future__ import annotations

from asyncio import run, sleep
from importlib import import_module
from types import SimpleNamespace

import numpy as np
import pytest
from rrr_traj_planner.core.errors import InvalidInputError

pytest.importorskip('viser', reason='viser is not installed: make studio installs it')
typed = import_module('rrr_traj_planner.nodes.studio.panel.typed')


@pytest.mark.parametrize('text', [
    '0.5, -0.1, 1.44', '0.5 -0.1 1.44', '0.5;-.1;1.44', ' 5e-1,\t-0.10 , 1.440,'])
def test_positions_are_read(text):
    assert typed.position_in(text) == (0.5, -0.1, 1.44)


@pytest.mark.parametrize('text', [
    '', '-', '0.5, -', '0.5, -0.1', '1, 2, 3, 4', 'x, y, z', '0.5, nan, 1', '1, 2, inf',
    '0,5, 0,1, 1,44'])
def test_what_is_no_position_is_refused(text):
    with pytest.raises(InvalidInputError, match='must be three numbers, x, y, z in m'):
        typed.position_in(text)


def test_what_is_shown_is_read_to_the_micrometre():
    for point in np.random.default_rng(0).uniform(-2.0, 2.0, (50, 3)):
        shown = typed.position_in(typed.position_text(point))
        assert shown == pytest.approx(tuple(point), abs=0.5001e-6)


@pytest.mark.parametrize(('text', 'number'), [
    ('', 0.0), ('  ', 0.0), ('0', 0.0), ('0.25', 0.25), (' 2.5e-1 ', 0.25), ('.5', 0.5),
    ('12', 12.0)])
def test_numbers_are_read(text, number):
    assert typed.number_in(text, 'dwell [s]') == number


@pytest.mark.parametrize('text', ['-', '-0.1', 'x', '0,5', '1 2', 'nan', 'inf', '-inf'])
def test_what_is_no_number_is_refused(text):
    with pytest.raises(InvalidInputError) as error:
        typed.number_in(text, 'dwell [s]')
    assert str(error.value) == f"dwell [s] is '{text}', must be a number, 0 or more"


class Text:
    """A field of text, as viser has them."""

    disabled = False

    def on_update(self, changed):
        self.changed = changed


def test_number_is_taken_and_a_wrong_one_is_told_of_until_it_is_right(monkeypatch):
    monkeypatch.setattr(typed, 'TYPED', 0.0)
    handle, found, said = Text(), [], []
    number = typed.Number(
        SimpleNamespace(add_text=lambda *_, **__: handle), 'time [s]', 'from the one before')
    number.connect(lambda act: act(), lambda *values: found.append(values), said.append, lambda: 2)

    async def script():
        for text in ('1.5', '-', ''):
            handle.value = text
            await handle.changed(SimpleNamespace(client_id=1))
            await sleep(0.0)

    run(script())
    assert found == [(1.5, 2), (0.0, 2)]
    assert said == ['', "time [s] is '-', must be a number, 0 or more", '']


def test_number_is_shown_as_it_is_typed():
    handle = Text()
    number = typed.Number(SimpleNamespace(add_text=lambda *_, **__: handle), 'a [s]', '')
    for value, text in ((0.0, ''), (0.1, '0.1'), (1 / 3, '0.333333333'), (12.0, '12'),
                        (1e-9, '1e-09')):
        number.show(value)
        assert handle.value == text
        number.show(value, is_enabled=False)
        assert handle.disabled
