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

"""Reports made once, and a browser that shows them."""

from __future__ import annotations

from helpers import browser
import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.planners.request import PlanningRequest
from rrr_traj_planner.report.attempts import Attempt, attempts, Task
from rrr_traj_planner.report.page import write_page
from rrr_traj_planner.report.plan_report import write_plan_report
from rrr_traj_planner.report.thesis_report import sections, TEXT, thesis_plans, TITLE
from rrr_traj_planner.report.thesis_tasks import table_6_1

REFUSAL = ("via point 2: (2, 0, 0.5) m is out of the arm's reach: it misses by 0.4 m; "
           'no_word_of_a_message_that_is_as_long_as_this_one_leaves_the_page_where_it_is_narrow')
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
def many_points_page(tmp_path_factory):
    """Return the page of a plan through 60 points, and of a planner that refused."""
    a = np.linspace(0.0, 2.0 * np.pi, 60)
    points = np.column_stack((0.75 + 0.2 * np.sin(2.0 * a + 0.3), 0.6 + 0.2 * np.cos(3.0 * a),
                              1.0 + 0.25 * np.sin(a)))
    task = Task('a_name_of_a_file_that_is_longer_than_a_phone_is_wide_' * 2, RobotModel(),
                JointLimits(), PlanningRequest(points))
    refused = Attempt(task, 'line_polynomial', None, REFUSAL, 0.0)
    return write_plan_report(
        tmp_path_factory.mktemp('many'), [*attempts(task, ['cycloid']), refused])


@pytest.fixture(scope='session')
def window(tmp_path_factory):
    """Return a browser; without one, skip."""
    if browser.found() is None:
        pytest.skip(browser.MISSING)
    with browser.Browser(tmp_path_factory.mktemp('profile')) as opened:
        yield opened
