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

"""Requests to `time_optimal` on the thesis's arm, and what its notes say."""

from dataclasses import replace
from functools import partial
import re

from helpers import planning_cases
from helpers.measured_motions import Measured
from helpers.planning_cases import ARM, LIMITS, NONE
from helpers.random_tasks import Task
import numpy as np
import pytest
from rrr_traj_planner.planners.planning import plan

GAP = 2e-3   # relative: how far from the optimum the method may end
KEPT = 1e-9  # s, of prescribed durations

TORQUE_LIMITED = {'max_acceleration': NONE, 'max_jerk': np.full(3, 100.0)}
EITHER_LIMITS = [LIMITS, replace(LIMITS, **TORQUE_LIMITED)]
each_limits = pytest.mark.parametrize('limits', EITHER_LIMITS, ids=['acceleration', 'torque'])

A, B, C = [0.3, 1.4, 0.0], [1.0, 1.8, 0.3], [0.2, 1.3, -0.5]

table, through = (partial(request, planner_id='time_optimal')
                  for request in (planning_cases.table, planning_cases.through))


def durations_of(answer):
    """Return the durations of a plan's segments."""
    return np.diff(answer.via_times)


def measured(limits, q, **request):
    """Return the measured plan through joint positions of the thesis's arm."""
    task = Task(0, '', ARM, limits, np.asarray(q, dtype=float), through(q, **request))
    return Measured(task, plan(ARM, limits, task.request))


def time_to_save(answer):
    """Return the percentage of the time that a plan's note says could be saved; 0 without one."""
    note = answer.trajectory.note
    if not note:
        return 0.0
    if answer.note == 'planning ended before it converged: faster motions may be possible':
        return 100.0  # no useful bound is known
    reported = re.fullmatch(r'planning ended before it converged: at most ([\d.]+) % of the time '
                            r'could be saved', note)
    assert reported, note
    return float(reported[1])
