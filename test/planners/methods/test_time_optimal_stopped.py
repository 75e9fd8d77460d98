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

"""`time_optimal` stopped before it converges: a valid motion, and how far from the fastest."""

from itertools import count

from helpers.planning_cases import ARM, LIMITS, NONE
from helpers.time_optimal_cases import (
    A,
    B,
    C,
    durations_of,
    each_limits,
    GAP,
    KEPT,
    measured,
    through,
    time_to_save,
)
import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.planners.planning import plan


def stops_after(calls):
    """Return a function that answers True from so many calls on."""
    counter = count()
    return lambda: next(counter) >= calls


@pytest.mark.parametrize('calls', [0, 1, 3, 5])
@each_limits
def test_planning_stopped_early_gives_a_valid_motion_and_bounds_the_time_to_save(limits, calls):
    best = plan(ARM, limits, through([A, B, C])).via_times[-1]
    m = measured(limits, [A, B, C], should_stop=stops_after(calls))
    assert m.violations() == []
    saving = time_to_save(m.plan)
    assert 0.0 < saving <= 100.0
    # The bound is sound, but for torque, with which the problem is not quite convex.
    assert m.plan.via_times[-1] * (1.0 - 0.01 * saving) <= best * (1.0 + GAP)


def test_more_time_to_plan_gives_faster_motions():
    times = [measured(LIMITS, [A, B, C], should_stop=stops_after(k)).plan.via_times[-1]
             for k in (0, 4, 8, 1000)]
    assert (np.diff(times) <= 1e-9).all()
    assert times[-1] < 0.9 * times[0]


def test_prescribed_durations_are_kept_even_when_planning_is_stopped_early():
    for calls in (0, 2, 5):
        m = measured(LIMITS, [A, B, C], segment_durations=[5.0, 6.0],
                     should_stop=stops_after(calls))
        assert m.violations() == []
        assert durations_of(m.plan) == pytest.approx([5.0, 6.0], abs=KEPT)


def stopped(q, limits, calls):
    """Return the measured plan whose planning is stopped after so many calls, and their number."""
    counter = count()
    return measured(limits, q, should_stop=lambda: next(counter) >= calls), next(counter)


@pytest.mark.parametrize('inside', [0.0, 3e-3])  # rad, of via points from the ends of ranges
def test_motions_beside_the_ends_of_ranges_are_not_the_slow_one_when_stopped(inside):
    q = np.array([[1.0, 0.8, 1.0], [-1.0, 0.0, -0.7], [1.0, 1.0, 0.5], [-0.9, 0.9, -1.0]] * 3)
    limits = JointLimits(min_position=[-1.0 - inside] * 3, max_position=[1.0 + inside] * 3,
                         max_acceleration=[3.0] * 3, max_jerk=[60.0] * 3, max_effort=NONE)
    best, calls = stopped(q, limits, 10 ** 6)
    assert stopped(q, limits, 0)[0].trajectory.duration > 1.8 * best.trajectory.duration
    durations = []
    for k in range(20, calls, 12):
        m, _ = stopped(q, limits, k)
        assert m.violations() == []
        durations.append(m.trajectory.duration)
    assert max(durations) < 1.2 * best.trajectory.duration
