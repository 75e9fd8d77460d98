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

"""Residual vibrations of plans side by side: against figures found by other means, and README."""

from __future__ import annotations

import re

from helpers.places import ROOT
import numpy as np
import pytest
from rrr_traj_planner.planners.registry import planner_ids
from rrr_traj_planner.report.attempts import planned
from rrr_traj_planner.report.vibration import (
    BESIDE,
    IN_FIGURE,
    IN_TABLE,
    vibration_figure,
    vibration_of,
    vibration_table,
)

README = (ROOT / 'README.md').read_text()
PRINTED = 6e-4  # rad/s^2, of three decimals
# At 16, 24, 32, 48 and 64 Hz on table 6.1, by a program of its own.
CYCLOID = (0.057, 0.019, 0.005, 0.004, 0.002)


def readme_row(planner_id):
    """Return the numbers of residual vibration in a planner's row."""
    row, = (line for line in README.splitlines() if line.startswith(f'| `{planner_id}`'))
    return [float(x) for x in re.findall(r'[\d.]+', row.split('|')[4])]


def test_cycloid_leaves_what_another_program_found(plans):
    found = vibration_of(plans.on_table_6_1('cycloid'), IN_TABLE[1:])
    assert found == pytest.approx(CYCLOID, abs=PRINTED)


def test_table_has_each_planner_s_time_and_vibrations(plans):
    table = vibration_table(planned(plans.table_6_1), 'x')
    assert [row[0] for row in table.rows] == planner_ids()
    assert len(table.heads) == 2 + len(IN_TABLE)
    row, = (row for row in table.rows if row[0] == 'cycloid')
    assert row[1] == '2.850'
    assert [float(x) for x in row[3:]] == pytest.approx(CYCLOID, abs=PRINTED)


def test_figure_shows_the_largest_within_five_per_cent(plans):
    of = [plans.on_table_6_1(i) for i in ('cycloid', 'time_optimal')]
    x, *curves = vibration_figure(of, 'x').data.values()
    assert x == pytest.approx(IN_FIGURE[BESIDE:-BESIDE])
    for p, curve in zip(of, curves, strict=True):
        for i in np.random.default_rng(1).integers(0, len(x), 5):
            beside = vibration_of(p, np.geomspace(x[i] / 1.049, x[i] * 1.049, 400)).max()
            assert curve[i] == pytest.approx(beside, rel=0.03)  # it samples at 0.4 %


def test_readme_has_the_vibrations_of_table_6_1(plans):
    for planner_id in ('cycloid', 'time_optimal'):
        assert readme_row(planner_id) == pytest.approx(
            vibration_of(plans.on_table_6_1(planner_id), (16.0, 64.0)), rel=0.02, abs=PRINTED)
    lines = [vibration_of(plans.on_table_6_1(i), (16.0, 64.0))
             for i in ('line_arc', 'line_polynomial')]
    assert readme_row('line_arc') == pytest.approx(np.ravel(lines), rel=0.02, abs=PRINTED)
    others = np.array([vibration_of(p, (16.0, 64.0)) for p in planned(plans.table_6_1)
                       if p.planner_id not in (
                           'cycloid', 'time_optimal', 'line_arc', 'line_polynomial')])
    assert readme_row('gauss') == pytest.approx(
        np.ravel([(c.min(), c.max()) for c in others.T]), rel=0.02, abs=PRINTED)
