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

"""Planners side by side: one is asked at a time, the drag's request comes first."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.nodes.point_files.reading import read_task
from rrr_traj_planner.nodes.studio.comparison import Comparison, comparison_html
from rrr_traj_planner.nodes.studio.planned import Planned
from rrr_traj_planner.nodes.studio.session import Refusal
from rrr_traj_planner.nodes.studio.wanted import wanted_of

IDS = ('slow', 'refuses', 'fast')
REFUSED = Refusal('via point 1: out of <reach>', 1)


def answer(planner_id, duration, note=''):
    limits = np.array([2.0, 2.0, np.inf])
    return Planned(planner_id, duration, 0.25, note, np.zeros((1, 3)), np.zeros(0), np.zeros(1),
                   np.zeros((1, 3)), np.zeros((2, 3)),
                   (('velocity', np.array([1.0, 0.5, 7.0]), limits),), lambda: (0.125, 0.0, 0.0))


class Asked:
    """Keeps what a comparison asks for, and how often it shows itself."""

    def __init__(self):
        self.requests, self.is_free, self.shown = [], True, 0
        self.comparison = Comparison(IDS, self.ask, lambda: self.is_free, self.show)

    def ask(self, wanted, answered):
        self.requests.append((wanted.task.planner_id, answered))

    def show(self, comparison):
        assert comparison is self.comparison
        self.shown += 1

    def answer(self, value):
        self.requests[-1][1](value)

    def answer_all(self):
        for value in (answer('slow', 3.0), REFUSED, answer('fast', 1.5, 'misses <1>')):
            self.answer(value)


@pytest.fixture
def asked():
    return Asked()


@pytest.fixture
def wanted():
    return wanted_of(read_task('table_6_1.yaml'), RobotModel(), 'base_link', 'cycloid')


def test_planners_are_asked_one_after_another(asked, wanted):
    asked.comparison.start(wanted)
    assert [name for name, _ in asked.requests] == ['slow']
    asked.comparison.go_on()  # none piles up
    assert len(asked.requests) == 1 and asked.comparison.waits_for == 'slow'
    asked.answer_all()
    assert [name for name, _ in asked.requests] == list(IDS)
    assert [row.planner_id for row in asked.comparison.rows] == ['fast', 'slow', 'refuses']
    assert asked.comparison.waits_for == '' and asked.shown > 2


def test_nothing_is_asked_while_the_drag_waits_for_its_plan(asked, wanted):
    asked.is_free = False
    asked.comparison.start(wanted)
    assert asked.requests == []
    asked.is_free = True
    asked.comparison.go_on()
    assert len(asked.requests) == 1


def test_a_drag_ends_it_and_its_rows_are_of_the_past(asked, wanted):
    asked.comparison.start(wanted)
    asked.answer(answer('slow', 3.0))
    asked.comparison.changed(wanted.moved(1, (0.46, 0.55, 1.3)))
    asked.answer(REFUSED)  # comes late: of other via points
    asked.comparison.go_on()
    assert len(asked.requests) == 2
    assert [row.planner_id for row in asked.comparison.rows] == ['slow']
    assert asked.comparison.plan_of('slow') is None
    assert 'of other via points' in comparison_html(asked.comparison)


def test_another_scaling_ends_it_and_another_planner_does_not(asked, wanted):
    asked.comparison.start(wanted)
    asked.comparison.changed(wanted.with_planner('gauss'))
    assert asked.comparison.is_current
    asked.comparison.changed(wanted.with_scalings(0.5, 1.0))
    assert not asked.comparison.is_current


def test_a_new_comparison_waits_for_the_old_one_s_answer(asked, wanted):
    asked.comparison.start(wanted)
    other = wanted.moved(1, (0.46, 0.55, 1.3))
    asked.comparison.changed(other)
    asked.comparison.start(other)
    assert len(asked.requests) == 1
    asked.answer(answer('slow', 9.0))  # of the old one: left out
    assert asked.comparison.rows == [] and len(asked.requests) == 2
    asked.answer_all()
    assert asked.comparison.plan_of('slow').duration == 3.0


def test_only_plans_can_be_taken(asked, wanted):
    asked.comparison.start(wanted)
    asked.answer_all()
    assert asked.comparison.plan_of('fast').duration == 1.5
    assert asked.comparison.plan_of('refuses') is None
    assert asked.comparison.plan_of('unknown') is None


def test_table_has_times_shares_and_refusals(asked, wanted):
    assert '<tr>' not in comparison_html(asked.comparison)
    asked.comparison.start(wanted)
    assert 'planning: slow' in comparison_html(asked.comparison)
    asked.answer_all()
    text = comparison_html(asked.comparison)
    for part in ('1.500', '3.000', '>50<', '>250<', '>0.12<', 'out of &lt;reach&gt;',
                 'misses &lt;1&gt;'):
        assert part in text, part
    assert text.index('fast') < text.index('slow') < text.index('refuses')
    assert 'planning:' not in text


def test_joint_without_limits_has_no_share(asked, wanted):
    asked.comparison.start(wanted)
    free = answer('slow', 3.0)
    asked.answer(replace(free, peaks=(('jerk', free.peaks[0][1], np.full(3, np.inf)),)))
    assert '>-<' in comparison_html(asked.comparison)


def test_planners_with_the_same_remark_both_have_it():
    asked = Asked()
    asked.comparison.start(wanted_of(
        read_task('table_6_1.yaml'), RobotModel(), 'base_link', 'cycloid'))
    for value in (answer('slow', 3.0, 'slowed'), REFUSED, answer('fast', 1.5, 'slowed')):
        asked.answer(value)
    html = comparison_html(asked.comparison)
    assert '* slow: slowed' in html and '* fast: slowed' in html
