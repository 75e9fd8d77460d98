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

"""Planners that stop at every via point: durations, stays, and refused paths."""

from dataclasses import replace

from helpers.planning_cases import ARM, LIMITS, table, through
import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.errors import LimitViolationError, TimingError
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.request import PlanningRequest

# From rest to rest over D at an acceleration of at most 1 rad/s^2 it takes the root of this times
# D: two cycloid transitions of 2 v each, D = 2 v^2; a 4-3-4 of three equal parts.
ROOTS = {'cycloid_approach_c': 8.0, 'poly_434': 6.0}
SEGMENT_1 = np.deg2rad(50.0921 - 40.1792)  # joint 1's displacement in table 6.1, the longest there

each_planner = pytest.mark.parametrize('planner_id', ROOTS)


@each_planner
def test_prescribed_durations_are_kept_and_free_ones_least(planner_id):
    least = np.diff(plan(ARM, LIMITS, table('6.1', planner_id=planner_id)).via_times)
    assert least[1] == pytest.approx(np.sqrt(ROOTS[planner_id] * SEGMENT_1), rel=5e-6)
    answer = plan(ARM, LIMITS, table(
        '6.1', planner_id=planner_id, segment_durations=[4.0, np.nan]))
    assert np.diff(answer.via_times) == pytest.approx([4.0, least[1]], abs=1e-9)
    again = plan(ARM, LIMITS, table('6.1', planner_id=planner_id, segment_durations=least))
    assert again.via_times == pytest.approx(np.concatenate(([0.0], np.cumsum(least))), abs=1e-9)


@each_planner
def test_a_stay_at_a_point_may_be_prescribed(planner_id):
    q = [[0.3, 1.4, 0.0], [0.3, 1.4, 0.0], [0.8, 1.5, 0.1]]
    answer = plan(ARM, LIMITS, through(q, planner_id=planner_id, segment_durations=[1.5, 4.0]))
    assert answer.via_times == pytest.approx([0.0, 1.5, 5.5], abs=1e-9)
    assert np.abs(answer.trajectory(np.linspace(0.0, 1.5, 9))[1]).max() == 0.0


@each_planner
def test_durations_too_short_are_refused_by_segment_with_feasible_ones(planner_id):
    request = table('6.1', planner_id=planner_id, segment_durations=[4.0, 0.5])
    with pytest.raises(TimingError, match=(
            r'^segment_durations \[4\.0, 0\.5\] s are too short for segment 1: the least '
            r'feasible are \[4\.0, \d\.\d*\] s$')) as no:
        plan(ARM, LIMITS, request)
    offered = no.value.least_durations
    assert offered == pytest.approx([4.0, np.sqrt(ROOTS[planner_id] * SEGMENT_1)], abs=1e-5)
    answer = plan(ARM, LIMITS, replace(request, segment_durations=offered))
    assert np.diff(answer.via_times) == pytest.approx(offered, abs=1e-9)


@each_planner
def test_a_path_that_cannot_be_held_is_refused_by_segment(planner_id):
    # Half-way the forearm is level: 12 * 9.81 * 0.5 = 58.9 N m.
    weak = replace(LIMITS, max_effort=[150.0, 200.0, 50.0])
    q = [[0.2, 1.5, -1.5], [0.3, 1.5, -1.5], [0.3, np.pi / 2, 1.5]]
    with pytest.raises(LimitViolationError, match=(
            r'^segment 1: along the segment joint_3 needs 58\.9 N m to hold, limit 50 N m$')):
        plan(ARM, weak, through(q, planner_id=planner_id))


@each_planner
@pytest.mark.parametrize('seed', (9, 10, 14, 20))
def test_a_wider_range_of_joint_1_makes_no_motion_slower(planner_id, seed):
    # Every segment has a time of its own, from rest to rest: none but the best turns will do.
    rng = np.random.default_rng([313, seed])
    azimuth = np.cumsum(rng.uniform(-1.5, 3.0, 5)) if seed % 2 else rng.uniform(-np.pi, np.pi, 5)
    q = np.column_stack((azimuth, rng.uniform(0.8, 1.4, 5), rng.uniform(-0.5, 0.5, 5)))
    none, durations = [np.inf] * 3, []
    for low, high in ((-np.pi, np.pi), (-1.25 * np.pi, 1.1 * np.pi), (-1.5 * np.pi, 2.0 * np.pi)):
        limits = JointLimits((low, -4.0, -4.0), (high, 4.0, 4.0), max_jerk=none, max_effort=none)
        durations.append(plan(ARM, limits, through(q, planner_id=planner_id)).trajectory.duration)
    assert (np.diff(durations) <= 1e-5 * np.array(durations[:2])).all()


@pytest.mark.parametrize('planner_id', [*ROOTS, 'cycloid_approach_b', 'time_optimal'])
def test_turns_are_chosen_for_how_the_planner_passes_via_points(planner_id):
    # In the wider range joint 1 can go on by 5.2 rad instead of back and forth, which saves those
    # nothing that stop at the point between anyway.
    request = PlanningRequest([(0.20252085, 0.84631354, 0.80479441),
                               (0.33101498, -0.79621133, 0.80213610),
                               (0.51592836, 0.09880974, 1.10039866)], planner_id=planner_id)
    narrow, wide = (plan(ARM, JointLimits((low, 0.0, -np.pi), (high, np.pi, 6.0)), request)
                    for low, high in ((-1.5, 2.0), (-2.0 * np.pi, 2.0 * np.pi)))
    assert wide.trajectory.duration <= narrow.trajectory.duration * (1.0 + 1e-9)
