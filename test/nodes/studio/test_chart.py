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

"""What the chart draws: curves of the joints, limits, and a line at the ghost's moment."""

from __future__ import annotations

from importlib import import_module
from types import SimpleNamespace

import numpy as np
import pytest
from rrr_traj_planner.nodes.studio.planned import LIMITED, Planned

pytest.importorskip('viser', reason='viser is not installed: make studio installs it')
chart = import_module('rrr_traj_planner.nodes.studio.chart')

COUNT = 5
TIMES = np.linspace(0.0, 2.0, COUNT)


def plan(count=COUNT):
    times = np.linspace(0.0, 2.0, count)
    return Planned('cycloid', 2.0, 0.0, '', np.zeros((count, 3)), np.zeros(count - 1), times,
                   np.zeros((count, 3)), np.zeros((2, 3)), (), tuple,
                   {name: np.outer(times, (0.5, -0.5, 0.1)) for name in chart.QUANTITIES})


def test_all_limited_quantities_can_be_chosen():
    assert set(LIMITED) < set(chart.QUANTITIES) and 'jerk' in chart.QUANTITIES


def test_without_ghost_there_is_no_line_in_the_chart():
    times, *joints, limit, below, cursor = chart.curves(plan(), 'jerk', None)
    np.testing.assert_array_equal(times, TIMES)
    np.testing.assert_array_equal(joints, np.outer((0.5, -0.5, 0.1), TIMES))
    assert (limit == 1.0).all() and (below == -1.0).all() and (cursor < -chart.ROOM).all()


@pytest.mark.parametrize('time', [0.0, 0.7, 1.0, 2.0])
def test_line_is_at_the_moment_and_curves_stay_as_they_are(time):
    times, *joints, _, _, cursor = chart.curves(plan(), 'velocity', time)
    assert (np.diff(times) >= 0.0).all()
    up, = np.flatnonzero(cursor > chart.ROOM)
    assert times[up] == time and (times[up - 1:up + 2] == time).all()
    np.testing.assert_allclose(joints, np.outer((0.5, -0.5, 0.1), times))


def test_a_plan_is_drawn_once_no_other_has_come_for_a_while(monkeypatch):
    class Gui:

        def add_dropdown(self, *_, **__):
            return SimpleNamespace(value='jerk', on_update=lambda _: None)

        def add_uplot(self, data, *_, **__):
            return SimpleNamespace(data=data)

    clock = []
    monkeypatch.setattr(chart, 'monotonic', lambda: clock[-1])
    shown = chart.Chart(Gui(), ('a', 'b', 'c'))
    seen = []
    for time, count in ((10.0, 5), (10.1, 7), (10.25, 0), (10.31, 0), (10.5, 0)):
        clock.append(time)
        if count:
            shown.show(plan(count))
        shown.show_time(None)
        seen.append(len(shown._chart.data[0]))
    assert seen == [1, 1, 1, 7, 7]


def test_long_plans_are_thinned_out():
    found = chart.curves(plan(5000), 'torque', 1.0)
    assert len(found) == 7 and {len(values) for values in found} == {chart.POINTS + 3}
