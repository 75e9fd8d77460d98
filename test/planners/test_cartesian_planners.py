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

"""What the planners of Cartesian paths refuse, and how they read a request."""

from dataclasses import replace

from helpers.random_paths import NONE, PLANNERS
import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.errors import (
    InvalidInputError,
    LimitViolationError,
    StartStateError,
    UnreachableError,
)
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.kinematics.inverse import inverse_kinematics
from rrr_traj_planner.core.kinematics.postures import posture_of
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.request import PlanningRequest

HIT = 1e-9  # rad
MODEL = RobotModel()
FREE = JointLimits(min_position=[-6.0] * 3, max_position=[6.0] * 3, max_effort=NONE)
TABLE_6_3 = ((0.2, 0.8, 0.5), (0.5, 1.0, 1.0), (0.8, 1.2, 0.6))

each_planner = pytest.mark.parametrize('planner_id', PLANNERS)


def planned(planner_id, tips, limits=FREE, **request):
    return plan(MODEL, limits, PlanningRequest(tips, planner_id=planner_id, **request))


@each_planner
def test_table_6_3_is_refused_with_the_thesis_s_own_torque(planner_id):
    with pytest.raises(LimitViolationError, match=r'^via point 2: joint_2 needs 218\.9 N m to '
                                                  r'hold, limit 200 N m$') as caught:
        planned(planner_id, TABLE_6_3, JointLimits())
    assert (caught.value.joint, caught.value.via_point) == ('joint_2', 2)


@each_planner
def test_gravity_too_large_between_points_is_refused_with_the_path_coordinate(planner_id):
    # Gravity's torque on joint 2 is 102.6 and 175.7 N m at the ends, and 184.4 N m between them.
    limits = replace(FREE, max_effort=(150.0, 180.0, 200.0))
    with pytest.raises(LimitViolationError,
                       match=r'^at 1\.7\d* m along the path, between via points 0 and 1 \(nearest:'
                             r' 1\): joint_2 needs 184\.4 N m to hold, limit 180 N m$') as caught:
        planned(planner_id, [(0.9, 0.0, 1.55), (0.9, 0.0, -0.55)], limits, elbow='up',
                shoulder='front')
    assert (caught.value.joint, caught.value.via_point) == ('joint_2', 1)


@each_planner
def test_reversal_is_refused_by_number(planner_id):
    with pytest.raises(InvalidInputError, match='^via point 1: the path reverses there') as caught:
        planned(planner_id, [(1.0, 0.0, 0.6), (1.0, 0.3, 0.6), (1.0, 0.1, 0.6)])
    assert caught.value.via_point == 1


@each_planner
def test_line_through_the_inner_workspace_limit_is_refused_with_the_path_coordinate(planner_id):
    with pytest.raises(UnreachableError,
                       match=r'^at 0\.3 m along the path, between via points 0 and 1 \(nearest: '
                             r"[01]\): the tip would be out of the arm's reach: it misses by "
                             r'0\.01 m$'):
        planned(planner_id, [(0.19, 0.3, 0.5), (0.19, -0.3, 0.5)])


@each_planner
def test_line_across_joint_axis_1_is_refused_with_path_coordinate_and_nearest_point(planner_id):
    with pytest.raises(LimitViolationError,
                       match=r'^at 1\.\d* m along the path, .*\(nearest: [01]\): the tip would '
                             r'pass joint axis 1'):
        planned(planner_id, [(0.6, 0.8, 1.0), (-0.6, -0.8 + 1e-6, 1.2)])


@each_planner
@pytest.mark.parametrize('tips', [
    [(0.6, 0.8, 1.0), (-0.6, -0.8, 1.2)],                   # through the axis
    [(-0.3, 0.4, 1.5), (0.0, 0.0, 1.6)],                    # to it
    [(0.0, 0.0, 1.6), (3e-10, -2e-10, 1.9)],                # on it
    [(0.9, -0.1, 0.7), (0.5, 0.8, 1.0), (0.0, 0.0, 1.6)],   # to it, from another plane
    [(0.0, 1e-16, 1.6), (0.5, 0.8, 1.0), (0.9, -0.1, 0.7)]])
def test_joint_1_stands_still_on_lines_in_a_plane_with_its_axis(planner_id, tips):
    found = planned(planner_id, tips, max_deviation=0.01)
    q = found.trajectory(np.linspace(0.0, found.trajectory.duration, 2001))[0]
    passed = forward_kinematics(MODEL, found.trajectory(found.via_times)[0])
    assert passed == pytest.approx(np.array(tips), abs=1e-9)
    # The path's first or last line, where the tip meets the axis: its azimuth is joint 1's.
    near = np.hypot(*forward_kinematics(MODEL, q)[:, :2].T) < 0.1
    assert near.any()
    assert np.ptp(q[near, 0]) < 1e-9
    if len(tips) == 2:  # straight: no point is off the line between the two
        a, b = np.array(tips)
        along = (forward_kinematics(MODEL, q) - a) @ (b - a) / ((b - a) @ (b - a))
        line = a + along[:, np.newaxis] * (b - a)
        assert forward_kinematics(MODEL, q) == pytest.approx(line, abs=1e-9)
        assert np.ptp(q[:, 0]) < 1e-9


@each_planner
def test_joint_limit_between_points_is_refused_with_the_path_coordinate(planner_id):
    tips = [(1.2, -0.5, 0.6), (1.2, 0.7, 0.6)]
    nearest = inverse_kinematics(MODEL, (1.2, 0.0, 0.6), 'up')[2]  # least, at y = 0
    limits = replace(FREE, min_position=(-4.0, -4.0, nearest + 1e-3))
    with pytest.raises(LimitViolationError,
                       match=r'^at 0\.5\d* m along the path, between via points 0 and 1 '
                             r'\(nearest: 0\): joint_3 would be at') as caught:
        planned(planner_id, tips, limits, elbow='up')
    assert caught.value.via_point == 0


@each_planner
@pytest.mark.parametrize('y', [-0.52, -0.54, -0.56, -0.58, -0.6, -0.62])
def test_a_range_that_is_left_by_nanoradians_between_points_is_refused_too(planner_id, y):
    # 2e-9 rad are more than rounding. The extreme is no sample of any grid.
    nearest = inverse_kinematics(MODEL, (1.2, 0.0, 0.6), 'up')[2]
    limits = replace(FREE, min_position=(-4.0, -4.0, nearest + 2e-9))
    with pytest.raises(LimitViolationError, match='joint_3 would be at'):
        planned(planner_id, [(1.2, y, 0.6), (1.2, 0.7, 0.6)], limits, elbow='up')


@each_planner
def test_segment_durations_are_refused(planner_id):
    with pytest.raises(InvalidInputError, match='takes no segment_durations: its time is the'):
        planned(planner_id, [(1.0, 0.0, 0.6), (1.0, 0.3, 0.6)], segment_durations=[2.0])


@each_planner
@pytest.mark.parametrize('elbow', ['up', 'down'])
def test_path_begins_at_the_start_s_tip(planner_id, elbow):
    tips = np.array([(1.0, 0.0, 0.6), (1.0, 0.3, 0.7), (0.8, 0.4, 0.9)])
    start = inverse_kinematics(MODEL, tips[0], elbow)
    whole = planned(planner_id, tips, elbow=elbow, shoulder='front')
    found = planned(planner_id, tips[1:], start=start)
    assert found.trajectory(0.0)[0] == pytest.approx(start, abs=HIT)
    assert found.trajectory.duration == pytest.approx(whole.trajectory.duration, rel=1e-9)
    assert found.via_times == pytest.approx(whole.via_times[1:], rel=1e-9)


@each_planner
def test_a_start_on_the_other_branch_is_refused(planner_id):
    start = inverse_kinematics(MODEL, (1.0, 0.0, 0.6), 'down')
    with pytest.raises(StartStateError, match=(
            '^the start state has elbow down, shoulder front: along a path of the tip the arm '
            'cannot change to elbow up$')):
        planned(planner_id, [(1.0, 0.3, 0.7)], start=start, elbow='up')


@each_planner
def test_without_an_elbow_a_start_on_branch_down_stays_on_it(planner_id):
    start = inverse_kinematics(MODEL, (1.0, 0.0, 0.6), 'down')
    found = planned(planner_id, [(1.0, 0.3, 0.7), (0.8, 0.4, 0.9)], start=start)
    assert posture_of(MODEL, found.trajectory(found.trajectory.duration)[0]).elbow == 'down'
    with pytest.raises(UnreachableError):  # named for the start's own branch, not the other
        planned(planner_id, [(3.0, 0.3, 0.7)], start=start)


@each_planner
def test_note_bounds_the_time_to_save_where_planning_is_stopped_at_once(planner_id):
    found = planned(planner_id, [(1.0, 0.0, 0.6), (1.0, 0.3, 0.7), (0.8, 0.4, 0.9)],
                    should_stop=lambda: True)
    assert 'planning ended before it converged: ' in found.note


@each_planner
def test_without_an_elbow_a_branch_within_the_limits_is_taken(planner_id):
    tips = [(1.0, 0.0, 0.6), (1.0, 0.3, 0.6)]
    down = np.array([inverse_kinematics(MODEL, p, 'down') for p in tips])
    limits = replace(FREE, min_position=down.min(axis=0) - 0.2,
                     max_position=down.max(axis=0) + 0.2)
    assert posture_of(MODEL, planned(planner_id, tips, limits).trajectory(0.0)[0]).elbow == 'down'


@each_planner
def test_repeated_points_share_their_time(planner_id):
    a, b, c = (1.0, 0.0, 0.6), (1.0, 0.3, 0.6), (0.8, 0.4, 0.9)
    plain, found = planned(planner_id, [a, b, c]), planned(planner_id, [a, a, b, b, c])
    assert found.via_times.tolist() == plain.via_times[[0, 0, 1, 1, 2]].tolist()
    assert len(planned(planner_id, [a, a]).points.times) >= 2  # rest


@each_planner
def test_collinear_points_are_passed_on_the_line_between_the_outer_two(planner_id):
    a, b, c = np.array([(1.0, -0.3, 0.6), (1.0, 0.1, 0.8), (1.0, 0.3, 0.9)])
    found, direct = planned(planner_id, [a, b, c]), planned(planner_id, [a, c])
    assert found.trajectory.duration == pytest.approx(direct.trajectory.duration, rel=1e-2)
    assert len(found.trajectory.step_times) == 0
    tip = forward_kinematics(MODEL, found.trajectory(np.linspace(0.0, 9.0, 500))[0])
    assert np.linalg.norm(np.cross(tip - a, (c - a) / np.linalg.norm(c - a)), axis=1).max() < 1e-9


@each_planner
@pytest.mark.parametrize(('tips', 'start', 'blamed', 'names'), [
    (((1.0, 0.0, 0.6), (1.0, 0.0, 0.6), (1.0, 0.3, 0.6), (1.0, 0.1, 0.6)), None, 2, '0, 2, 3'),
    (((1.0, 0.3, 0.6), (1.0, 0.1, 0.6)), (1.0, 0.0, 0.6), 0, 'start, 0, 1')])
def test_points_are_counted_as_the_request_does(planner_id, tips, start, blamed, names):
    q = None if start is None else inverse_kinematics(MODEL, start, 'up')
    with pytest.raises(InvalidInputError,
                       match=rf'points counted along the path, via points: {names}\)$') as caught:
        planned(planner_id, tips, start=q)
    assert caught.value.via_point == blamed


@each_planner
def test_a_last_leg_that_its_blend_zone_nearly_fills_does_not_slow_the_motion(planner_id):
    tips = [(1.0, 0.0, 0.6), (1.0, 0.117, 0.6), (1.0004, 0.1179, 0.6005)]
    assert planned(planner_id, tips).trajectory.duration < 2.0
