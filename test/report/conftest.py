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

"""Reports made once, and a browser to look at them."""

from __future__ import annotations

import os

import browser
import pytest
from rrr_traj_planner.report.attempts import attempts
from rrr_traj_planner.report.page import write_page
from rrr_traj_planner.report.plan_report import write_plan_report
from rrr_traj_planner.report.thesis_report import sections, TEXT, thesis_plans, TITLE
from rrr_traj_planner.report.thesis_tasks import table_6_1

os.environ.setdefault('OPENBLAS_NUM_THREADS', '1')
COMPARED = ('cycloid', 'line_arc', 'time_optimal')


@pytest.fixture(scope='session')
def plans():
    """Return what every planner makes of the thesis's tasks."""
    return thesis_plans()


@pytest.fixture(scope='session')
def thesis_page(plans, tmp_path_factory):
    """Return the page of the thesis's figures."""
    return write_page(tmp_path_factory.mktemp('thesis'), TITLE, TEXT, sections(plans))


@pytest.fixture(scope='session')
def plan_page(tmp_path_factory):
    """Return the page of three planners' plans."""
    return write_plan_report(
        tmp_path_factory.mktemp('plan'), attempts(table_6_1(), COMPARED))


@pytest.fixture(scope='session')
def window(tmp_path_factory):
    """Return a browser; without one, skip."""
    if browser.found() is None:
        pytest.skip('no Chromium or Chrome to look at pages with: apt install chromium, or say '
                    'where one is in $CHROMIUM')
    with browser.Browser(tmp_path_factory.mktemp('profile')) as opened:
        yield opened
