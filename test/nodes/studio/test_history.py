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

"""Undo and redo: a drag is one step, quick changes by one control are one step."""

from __future__ import annotations

from rrr_traj_planner.nodes.studio.history import History, LONGEST, PAUSE


def back(history):
    """Undo everything, and return the states from the present to the first."""
    found = [history.present]
    while history.can_undo:
        found.append(history.undo())
    return found


def test_at_first_there_is_nothing_to_undo_or_redo():
    history = History('a')
    assert not history.can_undo and not history.can_redo
    assert (history.undo(), history.redo()) == ('a', 'a')


def test_each_change_without_a_source_is_a_step():
    history = History('a')
    for state in 'bc':
        history.add(state, '', 0.0)
    assert back(history) == ['c', 'b', 'a']
    assert [history.redo(), history.redo(), history.redo()] == ['b', 'c', 'c']


def test_a_change_after_an_undo_forgets_what_was_undone():
    history = History('a')
    for state in 'bc':
        history.add(state, '', 0.0)
    history.undo()
    history.add('d', '', 0.0)
    assert not history.can_redo
    assert back(history) == ['d', 'b', 'a']


def test_quick_changes_by_one_source_are_one_step():
    history = History(0)
    for state, source, now in ((1, 'x', 5.0), (2, 'x', 5.0 + PAUSE), (3, 'y', 5.1 + PAUSE),
                               (4, 'y', 5.2 + 2 * PAUSE)):
        history.add(state, source, now)
    assert back(history) == [4, 3, 2, 0]


def test_a_drag_is_one_step_however_long_it_pauses():
    history = History(0)
    for state in range(1, 5):
        history.add(state, 'x', state * 10.0 * PAUSE, is_drag=True)
    history.end_step()
    history.add(5, 'x', 40.0 * PAUSE, is_drag=True)
    assert back(history) == [5, 4, 0]


def test_a_change_after_an_undo_is_a_step_of_its_own():
    history = History(0)
    history.add(1, 'x', 0.0)
    history.undo()
    history.redo()
    history.add(2, 'x', 0.1)
    assert back(history) == [2, 1, 0]


def test_oldest_states_are_forgotten():
    history = History(0)
    for state in range(1, LONGEST + 10):
        history.add(state, '', 0.0)
    found = back(history)
    assert len(found) == LONGEST + 1 and found[-1] == 9
