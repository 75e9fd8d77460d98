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

"""The planner's process, for the tests of a module."""

from __future__ import annotations

from helpers.scripts import Script, script
import pytest
from rrr_traj_planner_interfaces.srv import PlanTrajectory


@pytest.fixture(scope='module')
def ask(module_ros):
    """Return a function that has the planner's process answer a request."""
    with Script(script('planner'), '--ros-args', '--log-level', 'error') as planner:
        yield lambda request: module_ros.call(PlanTrajectory, 'plan_trajectory', request)
        assert planner.process.poll() is None
