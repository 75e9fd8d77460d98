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

"""Joint positions from tip positions: branches, edges, joint axis 1, whole turns."""

import re

from helpers import thesis_cases as thesis
from helpers.random_cases import ARMS
from helpers.thesis_arm import ThesisArm
import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.errors import InvalidInputError, UnreachableError
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.kinematics.inverse import inverse_kinematics, nearest_solution
from rrr_traj_planner.core.kinematics.postures import ELBOWS

ROUNDING = 5e-14      # m, of a tip position
MODEL = RobotModel()
SHOULDER = np.array([0.0, 0.0, 0.5])
TURN = 2.0 * np.pi


def random_directions(rng, n):
    """Return unit vectors."""
    vectors = rng.normal(size=(n, 3))
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


def distance_of_pose(model, position, elbow, **kwargs):
    """Return how far the tip is from where it should be."""
    q = inverse_kinematics(model, position, elbow, **kwargs)
    return np.linalg.norm(forward_kinematics(model, q) - position)


@pytest.mark.parametrize('name', thesis.POINTS)
def test_thesis_points_need_the_verified_joint_angles(name):
    position, angles, _ = thesis.POINTS[name]
    q = inverse_kinematics(MODEL, position, 'up')
    assert np.rad2deg(q) == pytest.approx(angles, abs=thesis.ANGLE_TOLERANCE)


@pytest.mark.parametrize('name', thesis.POINTS)
def test_thesis_points_are_within_the_mirrored_joint_ranges(name):
    limits = JointLimits()
    q = inverse_kinematics(MODEL, thesis.POINTS[name][0])
    assert (limits.min_position <= q).all()
    assert (q <= limits.max_position).all()


def test_thesis_printed_range_of_joint_2_holds_no_branch_of_its_own_points():
    low, high = np.pi, TURN
    kept = {elbow: all(low <= inverse_kinematics(MODEL, p, elbow)[1] % TURN <= high
                       for p, _, _ in thesis.POINTS.values()) for elbow in ELBOWS}
    assert kept == {'up': False, 'down': False}


@pytest.mark.parametrize('arm', ARMS)
@pytest.mark.parametrize('elbow', ELBOWS)
def test_tip_of_the_solution_is_the_point(arm, elbow):
    rng = np.random.default_rng(31)
    least, most = arm.reach
    for direction in random_directions(rng, 300):
        point = (0.0, 0.0, arm.d1) + direction * rng.uniform(least, most)
        assert distance_of_pose(arm, point, elbow) <= ROUNDING


@pytest.mark.parametrize('arm', ARMS)
def test_solution_of_a_tip_is_the_pose_it_came_from(arm):
    rng = np.random.default_rng(32)
    found = 0
    for elbow, low in (('up', -np.pi / 2), ('down', np.pi / 2)):
        for _ in range(300):
            q = np.array([*rng.uniform(-np.pi, np.pi, 2), rng.uniform(low, low + np.pi)])
            r = arm.a2 * np.cos(q[1]) + arm.d4 * np.sin(q[1] + q[2])
            if r > 1e-3 and abs(np.cos(q[2])) > 1e-3:  # leaning back: another theta_1
                solution = inverse_kinematics(arm, forward_kinematics(arm, q), elbow)
                # Near the edges of the workspace angles feel the point's rounding magnified.
                q[2] -= TURN * (q[2] > np.pi)
                assert solution == pytest.approx(q, abs=1e-11)
                found += 1
    assert found > 200


def test_elbow_is_above_the_line_to_the_tip_on_branch_up_and_below_on_branch_down():
    rng = np.random.default_rng(33)
    for _ in range(100):
        r, h = rng.uniform(0.3, 1.0, 2)
        for elbow, side in (('up', 1.0), ('down', -1.0)):
            q2 = inverse_kinematics(MODEL, (r, 0.0, 0.5 + h), elbow)[1]
            cross = r * np.sin(q2) - h * np.cos(q2)  # line to the tip x upper arm
            assert side * cross > 0.0


def test_joint_positions_are_in_their_documented_ranges():
    rng = np.random.default_rng(34)
    for direction in random_directions(rng, 300):
        point = SHOULDER + direction * rng.uniform(0.2, 1.6)
        for elbow in ELBOWS:
            q = inverse_kinematics(MODEL, point, elbow)
            assert (-np.pi < q).all()
            assert (q <= np.pi).all()
            assert (abs(q[2]) <= np.pi / 2) == (elbow == 'up')


@pytest.mark.parametrize('y', [0.0, -0.0])
def test_point_behind_the_base_has_theta_1_of_plus_half_a_turn(y):
    assert inverse_kinematics(MODEL, (-1.0, y, 0.5))[0] == np.pi


@pytest.mark.parametrize('elbow', ELBOWS)
@pytest.mark.parametrize(('edge', 'inward', 'theta_3'), [
    (1.6, -1.0, {'up': np.pi / 2, 'down': np.pi / 2}),
    (0.2, 1.0, {'up': -np.pi / 2, 'down': -np.pi / 2})])
def test_both_edges_of_the_workspace_are_reached_to_rounding(elbow, edge, inward, theta_3):
    rng = np.random.default_rng(35)
    for direction in random_directions(rng, 50):
        # The angle grows with the root of the distance from the edge.
        for inside in (0.0, 1e-15, 1e-12, 1e-9, 1e-6):
            point = SHOULDER + direction * (edge + inward * inside)
            assert distance_of_pose(MODEL, point, elbow) <= ROUNDING
        q = inverse_kinematics(MODEL, SHOULDER + direction * edge, elbow)
        assert q[2] == pytest.approx(theta_3[elbow], abs=1e-7)


@pytest.mark.parametrize('elbow', ELBOWS)
@pytest.mark.parametrize(('distance', 'miss'), [(1.6, 0.9e-9), (0.2, -0.9e-9)])
def test_point_beyond_an_edge_by_rounding_is_on_it(elbow, distance, miss):
    point = SHOULDER + (0.6 * (distance + miss), 0.0, 0.8 * (distance + miss))
    assert distance_of_pose(MODEL, point, elbow) == pytest.approx(0.9e-9, rel=1e-5)


@pytest.mark.parametrize(('point', 'miss', 'text'), [
    ((2.0, 0.0, 0.5), 0.4,
     "(2, 0, 0.5) m is out of the arm's reach: it misses by 0.4 m"),
    ((0.0, 3.0, 4.5), 3.4,
     "(0, 3, 4.5) m is out of the arm's reach: it misses by 3.4 m"),
    ((0.05, 0.0, 0.5), 0.15,
     "(0.05, 0, 0.5) m is out of the arm's reach: it misses by 0.15 m"),
    ((0.0, 0.0, 0.5), 0.2,
     "(0, 0, 0.5) m is out of the arm's reach: it misses by 0.2 m")])
@pytest.mark.parametrize('elbow', ELBOWS)
def test_unreachable_point_is_refused_with_the_distance_it_misses_by(point, miss, text, elbow):
    with pytest.raises(UnreachableError, match=f'^{re.escape(text)}$') as caught:
        inverse_kinematics(MODEL, point, elbow)
    assert caught.value.distance == pytest.approx(miss, abs=1e-15)


def test_a_micrometre_beyond_the_reach_is_refused():
    with pytest.raises(UnreachableError, match='it misses by 1e-06 m$'):
        inverse_kinematics(MODEL, (1.600001, 0.0, 0.5))


@pytest.mark.parametrize('elbow', ELBOWS)
@pytest.mark.parametrize('offset', [0.0, 1e-10])
def test_on_joint_axis_1_theta_1_keeps_its_previous_value(elbow, offset):
    point = (offset, -offset, 1.7)
    q = inverse_kinematics(MODEL, point, elbow, previous=(-2.5, 9.0, 9.0))
    assert q[0] == -2.5
    assert inverse_kinematics(MODEL, point, elbow)[0] == 0.0
    assert distance_of_pose(MODEL, point, elbow) <= 1.5 * offset + ROUNDING


def test_off_joint_axis_1_the_previous_pose_changes_nothing():
    q = inverse_kinematics(MODEL, (0.3, 0.4, 0.9))
    assert inverse_kinematics(
        MODEL, (0.3, 0.4, 0.9), previous=(5.0, 5.0, 5.0)).tolist() == q.tolist()


@pytest.mark.parametrize('elbow', ELBOWS)
def test_arm_of_equal_links_folds_onto_its_shoulder(elbow):
    arm = ThesisArm(a2=0.8, d4=0.8)
    assert distance_of_pose(arm, SHOULDER, elbow) <= ROUNDING
    for direction in random_directions(np.random.default_rng(36), 50):
        for distance in (1e-6, 1e-3):
            assert distance_of_pose(arm, SHOULDER + distance * direction, elbow) <= ROUNDING


@pytest.mark.parametrize(('position', 'text'), [
    ((0.5, 0.5), r'^position has shape \(2,\), must have \(3\)$'),
    ((0.5, np.nan, 0.5), r'^position\[1\] is nan, must be finite$')])
def test_malformed_point_is_refused(position, text):
    with pytest.raises(InvalidInputError, match=text):
        inverse_kinematics(MODEL, position)


def test_unknown_elbow_is_refused():
    with pytest.raises(InvalidInputError, match="^elbow is 'left', must be 'up' or 'down'$"):
        inverse_kinematics(MODEL, (0.5, 0.5, 0.5), 'left')


@pytest.mark.parametrize(('point', 'hinted'), [
    ((1020.0, 590.0, 970.0), True), ((460.0, -550.0, 1440.0), True), ((0.0, 0.0, -300.0), True),
    ((1700.0, 1700.0, 0.0), False),                       # 2.4 m away is out of reach too
    ((3.0, 0.0, 0.5), False), ((0.0, 5.0, 0.0), False)])  # not far enough to be suspected
def test_refusal_asks_for_millimetres_where_they_explain_it(point, hinted):
    with pytest.raises(UnreachableError, match=r"m is out of the arm's reach: ") as refusal:
        nearest_solution(RobotModel(), point, np.zeros(3))
    assert str(refusal.value).endswith('; if these are millimetres, divide by 1000') == hinted
