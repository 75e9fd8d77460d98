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

"""Tables 6.3, B.1 and B.3 as printed and as corrected, and what gravity says to them."""

from helpers import table_5_1
from helpers import thesis_cases as thesis
from helpers.comparison import differ
from helpers.pinocchio_arm import PinocchioArm
from helpers.thesis_arm import ThesisArm
import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.kinematics.inverse import inverse_kinematics
from rrr_traj_planner.core.kinematics.postures import ELBOWS

TURN = 2.0 * np.pi
POINTS = {name: point for name, (point, _, _) in thesis.POINTS.items()}


def test_table_6_3_s_third_point_cannot_be_held():
    arm, limit = ThesisArm(), JointLimits().max_effort[1]
    assert limit == 200.0  # table B.3
    held = {}
    for name, point in POINTS.items():
        needed = [PinocchioArm(arm).gravity_torque(inverse_kinematics(arm, point, elbow))[1]
                  for elbow in ELBOWS]
        held[name] = min(needed) <= limit
    assert [name for name, can in held.items() if not can] == ['6.3 point 3']


def test_table_6_3_s_third_point_seems_light_with_5_53_as_printed():
    arm = ThesisArm()
    q = inverse_kinematics(arm, POINTS['6.3 point 3'])
    _, m2, m3 = arm.mass
    printed = (m2 * arm.l2 * np.cos(q[1]) + m3 * (
        arm.a2 * np.cos(q[1]) + arm.l3 * np.cos(q[1] + q[2]))) * arm.g
    true = PinocchioArm(arm).gravity_torque(q)[1]
    assert printed < 200.0 < true
    assert true == pytest.approx(218.9, abs=thesis.TORQUE_TOLERANCE)
    assert printed == pytest.approx(190.5, abs=thesis.TORQUE_TOLERANCE)


@pytest.mark.parametrize('elbow', ELBOWS)
def test_table_b_3_s_range_of_joint_2_holds_no_branch_of_the_thesis_s_points(elbow):
    angles = [inverse_kinematics(RobotModel(), point, elbow)[1] for point in POINTS.values()]
    inside = [np.pi <= angle % TURN <= TURN for angle in angles]
    assert not all(inside)


def test_table_b_3_mirrored_holds_all_points_elbow_up():
    limits = JointLimits()
    assert np.rad2deg((limits.min_position[1], limits.max_position[1])) == pytest.approx((0, 180))
    for point in POINTS.values():
        q = inverse_kinematics(RobotModel(), point, 'up')
        assert (limits.min_position <= q).all()
        assert (q <= limits.max_position).all()


def test_table_b_1_s_d3_is_d4():
    # As an offset along z2, 0.7 m could not bring the tip beyond 1.14 m from the shoulder.
    arm, point = ThesisArm(), np.array(POINTS['6.1 point 1'])
    as_offset = np.hypot(arm.a2, arm.d4)
    distance = np.linalg.norm(point - (0.0, 0.0, arm.d1))
    assert distance > as_offset
    q = inverse_kinematics(arm, point)
    assert table_5_1.tip(arm, q) == pytest.approx(point, abs=1e-12)
    second = table_5_1.frames(arm, q)[1]
    offset = second @ table_5_1.denavit_hartenberg(q[2], 0.0, arm.d4, np.pi / 2)
    assert differ(offset[:3, 3], point)
