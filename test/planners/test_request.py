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

"""Requests are checked when they are made, ids when they are looked up, limits when used."""

import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.registration import register
from rrr_traj_planner.planners.registry import planner, planner_ids
from rrr_traj_planner.planners.request import PlanningRequest
from rrr_traj_planner.planners.tasks import JointTask
from rrr_traj_planner.planners.transitions.via_problem import via_problem_of

POINTS = [[1.0, 0.6, 1.0], [0.5, 0.5, 1.4]]


@pytest.mark.parametrize(('changes', 'message'), [
    ({'via_points': [[1.0, 0.6, 1.0]]}, '^1 via point given, at least 2 needed$'),
    ({'via_points': np.zeros((0, 3)), 'start': [0.0, 0.0, 0.0]},
     '^0 via points given, at least 1 needed$'),
    ({'via_points': [[1.0, 0.6, 1.0], [0.5, np.nan, 1.4]]}, r'^via_points.* is nan, must be fin'),
    ({'via_points': [[1.0, 0.6]]}, '^via_points '),
    ({'start': [0.0, np.inf, 0.0]}, '^start.* is inf, must be finite$'),
    ({'elbow': 'sideways'}, "^elbow is 'sideways', must be 'up' or 'down'$"),
    ({'sample_period': 0.0}, r'^sample_period is 0\.0 s, must be positive$'),
    ({'sample_period': np.nan}, '^sample_period is nan s, must be finite$'),
    ({'max_deviation': -1.0}, r'^max_deviation is -1\.0 m, must be positive$'),
    ({'segment_durations': [1.0, 1.0]}, '^2 segment_durations given for 1 segment$'),
    ({'segment_durations': [0.0]}, r'^segment_durations\[0\] is 0\.0 s, must be finite and at '),
    ({'segment_durations': [np.inf]}, r'^segment_durations\[0\] is inf s, must be finite and')])
def test_malformed_value_is_refused_by_name(changes, message):
    with pytest.raises(InvalidInputError, match=message):
        PlanningRequest(**{'via_points': POINTS, **changes})


def test_segments_are_counted_from_the_start():
    assert PlanningRequest(POINTS).segments == 1
    assert PlanningRequest(POINTS, start=[0.0, 1.0, 0.0]).segments == 2
    assert PlanningRequest(POINTS[:1], start=[0.0, 1.0, 0.0]).segments == 1


def test_arrays_of_a_request_are_its_own_and_read_only():
    points = np.array(POINTS)
    request = PlanningRequest(points, segment_durations=[1.0])
    points[:] = 9.0
    assert request.via_points.tolist() == POINTS
    for array in (request.via_points, request.segment_durations):
        with pytest.raises(ValueError, match='read-only'):
            array[0] = 1.0


def task_of(limits=None, points=((0.3, 1.4, 0.0), (1.0, 1.8, 0.3), (0.2, 1.3, -0.5)),
            numbers=None):
    return JointTask(RobotModel(), limits or JointLimits(), np.array(points), None, 0.01, numbers)


def test_segments_are_numbered_as_the_caller_numbers_them():
    assert [task_of().segment_number(k) for k in (0, 1)] == [0, 1]
    assert [task_of(numbers=np.array([0, 2])).segment_number(k) for k in (0, 1)] == [0, 2]


def test_ids_are_sorted_and_known_ones_found():
    ids = planner_ids()
    assert ids == sorted(ids)
    assert {'cycloid', 'cycloid_approach_a'} <= set(ids)
    assert callable(planner('cycloid').plan)


def test_unknown_id_is_refused_with_the_known_ones():
    with pytest.raises(InvalidInputError, match=(
            r"^planner_id 'cycl' is unknown, known are .*cycloid, cycloid_approach_a")):
        planner('cycl')


def test_a_function_registered_is_the_planner_of_its_id(monkeypatch):
    monkeypatch.setattr('rrr_traj_planner.planners.registration.REGISTERED', {})

    @register('mine')
    def mine(task):
        return task

    assert planner('mine').plan is mine


@pytest.mark.parametrize('planner_id', planner_ids())
def test_a_planner_needs_acceleration_limits_as_registered(planner_id):
    without = JointLimits(max_acceleration=[np.inf] * 3, max_effort=[300.0] * 3)
    request = PlanningRequest(POINTS, planner_id=planner_id)
    if planner(planner_id).needs_acceleration_limit:
        with pytest.raises(InvalidInputError, match='needs acceleration limits, joint_1 has none'):
            plan(RobotModel(), without, request)
    else:
        assert plan(RobotModel(), without, request).trajectory.duration > 0.0


def test_law_is_the_cycloid_s_peaks_over_the_limits():
    # Peak acceleration 2 D / t, peak jerk 2 pi D / t^2: 1 rad/s at 4 rad/s^2 takes 0.5 s,
    # at 8 pi rad/s^3 too.
    limits = JointLimits(max_acceleration=[4.0] * 3, max_jerk=[8.0 * np.pi] * 3)
    law = via_problem_of(task_of(limits)).law
    assert law.least_time(np.full(3, 1.0)) == pytest.approx([0.5] * 3)
    assert law.slope == pytest.approx([0.5] * 3)
    assert law.root == pytest.approx([0.5] * 3)


def test_via_velocity_is_bounded_by_the_distance_to_the_range():
    # Joint 1, 0.02 rad from its end at 1 rad/s^2: it stops in v^2 / 1 (a cycloid's mean is half
    # its peak): v^2 = 0.02.
    problem = via_problem_of(task_of(points=((0.3, 1.4, 0.0), (0.02, 1.8, 0.3), (0.2, 1.3, -0.5))))
    assert problem.highest[0, 0] == pytest.approx(np.sqrt(0.02))
    assert problem.lowest[0].tolist() == (-problem.highest[0]).tolist()
    assert problem.highest[0, 1] == 1.0


def test_joint_at_the_end_of_its_range_has_all_but_no_via_velocity():
    problem = via_problem_of(task_of(points=((0.3, 1.4, 0.0), (0.0, 1.8, 0.3), (0.2, 1.3, -0.5))))
    assert 0.0 < problem.highest[0, 0] <= 1e-8


def test_missing_velocity_limit_bounds_nothing_that_a_motion_could_reach():
    problem = via_problem_of(task_of(JointLimits(max_velocity=[np.inf] * 3)))
    D = np.abs(problem.displacements).sum(axis=0)
    assert np.isfinite(problem.max_velocity).all()
    assert (problem.max_velocity > np.sqrt(D)).all()  # 1 rad/s^2, half of it in the mean
