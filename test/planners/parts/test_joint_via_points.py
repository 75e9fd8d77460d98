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

"""Via points as joint positions."""

from helpers.planning_cases import ARM, LIMITS
import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.errors import (
    InvalidInputError,
    JointRangeError,
    LimitViolationError,
)
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.kinematics.postures import Posture, posture_of
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.registry import planner, planner_ids
from rrr_traj_planner.planners.request import PlanningRequest

UP = np.array([[0.3, 1.4, 0.0], [0.9, 1.7, 0.2], [0.5, 1.2, -0.1]])
DOWN = np.array([0.4, 0.6, 2.6])  # elbow down
WIDE = JointLimits([-8.0] * 3, [8.0] * 3, max_effort=np.full(3, np.inf))
CARTESIAN = ('line_arc', 'line_polynomial')
HIT = 1e-9  # rad

each_planner = pytest.mark.parametrize('planner_id', planner_ids())
in_joint_space = pytest.mark.parametrize(
    'planner_id', [i for i in planner_ids() if i not in CARTESIAN])


def planned(q, limits=LIMITS, planner_id='cycloid', **request):
    return plan(ARM, limits, PlanningRequest(
        joint_via_points=q, planner_id=planner_id, **request))


@each_planner
def test_given_joint_positions_are_hit(planner_id):
    answer = planned(UP, planner_id=planner_id)
    reached = answer.trajectory(answer.via_times)[0]
    hit = slice(None, None, 2 if planner(planner_id).misses_via_points else 1)
    assert reached[hit] == pytest.approx(UP[hit], abs=HIT)
    tips = plan(ARM, LIMITS, PlanningRequest(
        forward_kinematics(ARM, UP), planner_id=planner_id, elbow='up', shoulder='front'))
    assert answer.via_times == pytest.approx(tips.via_times, abs=1e-6)


@in_joint_space
def test_posture_and_whole_turns_are_those_given(planner_id):
    q = np.array([UP[0], DOWN, UP[2] + [2.0 * np.pi, 0.0, 0.0]])
    assert posture_of(ARM, DOWN) == Posture('down', 'front')
    assert posture_of(ARM, UP[0]) == Posture('up', 'front')
    answer = planned(q, WIDE, planner_id, stop_at=[True] * 3)
    assert answer.trajectory(answer.via_times)[0] == pytest.approx(q, abs=HIT)


@pytest.mark.parametrize('planner_id', CARTESIAN)
def test_along_a_path_another_posture_than_that_of_the_first_point_is_refused(planner_id):
    with pytest.raises(InvalidInputError, match=(
            rf'^via point 1: along a path of the tip, .* planner {planner_id} comes to \[.*\] '
            r'rad, not to \[0\.4, 0\.6, 2\.6\] rad .*; planners in joint space')) as refusal:
        planned([UP[0], DOWN], WIDE, planner_id)
    assert refusal.value.via_point == 1
    with pytest.raises(InvalidInputError, match='^via point 0: along a path of the tip, from'):
        planned([DOWN], WIDE, planner_id, start=UP[0])
    turned = planned(UP + [2.0 * np.pi, 0.0, 0.0], WIDE, planner_id, stop_at=[True] * 3)
    assert turned.points.positions[0] == pytest.approx(UP[0] + [2.0 * np.pi, 0.0, 0.0], abs=HIT)


@pytest.mark.parametrize(('q', 'message'), [
    ([0.3, 3.2, 0.0], 'joint_2 is at 3.2 rad, limits 0 to 3.14159 rad$'),
    ([-1e-6, 1.4, 0.0], 'joint_1 is at -1e-06 rad, limits 0 to 1.5708 rad$'),
    ([17.0, 80.0, 5.0], r'joint_1 is at 17 rad, limits 0 to 1.5708 rad \(in degrees\?\)$'),
    ([1.0, 90.0, 0.0], r'joint_2 is at 90 rad, limits 0 to 3.14159 rad \(in degrees\?\)$'),
    ([1.0, 200.0, 0.0], 'joint_2 is at 200 rad, limits 0 to 3.14159 rad$')])  # nor as degrees
@pytest.mark.parametrize('planner_id', ['cycloid', 'line_arc'])
def test_positions_out_of_range_are_refused_with_joint_value_and_range(q, message, planner_id):
    with pytest.raises(JointRangeError, match=f'^via point 1: {message}') as refusal:
        planned([UP[0], q], planner_id=planner_id)
    assert refusal.value.via_point == 1
    assert refusal.value.value == q[['joint_1', 'joint_2', 'joint_3'].index(refusal.value.joint)]


def test_taught_positions_are_accepted_despite_rounding_at_the_end_of_a_range():
    answer = planned([UP[0], [-1e-10, 1.2, 0.1]])
    assert answer.points.positions[-1, 0] == 0.0


def test_a_point_that_the_motors_cannot_hold_is_refused():
    # By hand: 16 * 0.5 * 9.81 + 12 * 9.81 * (0.9 + 0.5) = 243.3 N m, the arm stretched forwards.
    with pytest.raises(LimitViolationError, match=(
            r'^via point 1: joint_2 needs 243\.3 N m to hold, limit 200 N m$')) as refusal:
        planned([UP[0], [0.3, 0.0, np.pi / 2]])
    assert refusal.value.via_point == 1


def test_start_state_may_come_first():
    answer = planned(UP[1:], start=UP[0], stop_at=[True, True], dwell=[0.5, 0.0])
    assert answer.points.positions[0].tolist() == UP[0].tolist()
    assert answer.trajectory(answer.via_times)[0] == pytest.approx(UP[1:], abs=HIT)
    one = planned(UP[1:2], start=UP[0])
    assert one.via_times == pytest.approx(answer.via_times[:1], abs=1e-9)


def test_a_repeated_position_is_one_point_and_the_same_tip_in_another_posture_is_not():
    same = planned(UP[[0, 0, 1]])
    assert same.via_times[:2].tolist() == [0.0, 0.0]
    low = plan(ARM, WIDE, PlanningRequest(
        [forward_kinematics(ARM, UP[0]), forward_kinematics(ARM, UP[1])], elbow='down'))
    other = low.points.positions[0]
    assert forward_kinematics(ARM, other) == pytest.approx(forward_kinematics(ARM, UP[0]))
    answer = planned([UP[0], other], WIDE)
    assert answer.trajectory.duration > 0.5
    assert answer.points.positions[-1] == pytest.approx(other, abs=HIT)
    with pytest.raises(InvalidInputError, match='^via point 1: along a path of the tip'):
        planned([UP[0], other], WIDE, 'line_arc')
