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

"""Joint positions by continuation along paths of any chain, and refusals of paths."""

from helpers.arm_paths import continued, least_singular_values, regular_path, rotated
from helpers.other_arms import OTHER_ARMS
from helpers.random_chains import random_arm
from helpers.thesis_arm import ThesisArm
import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.errors import LimitViolationError, UnreachableError
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.kinematics.inverse import inverse_kinematics
from rrr_traj_planner.core.kinematics.postures import ALL_POSTURES, posture_of
from rrr_traj_planner.core.kinematics.solutions import distances_out_of_reach
from rrr_traj_planner.core.path.design import line_arc
from rrr_traj_planner.core.path.following import followed_path, LEAST_SINGULAR_VALUE
from rrr_traj_planner.core.path.workspace_check import check_workspace
from scipy.spatial.transform import Rotation

FREE = JointLimits(min_position=np.full(3, -np.inf), max_position=np.full(3, np.inf))
ANY_ARM = {**{f'random {seed}': random_arm(seed) for seed in range(3)}, **OTHER_ARMS}
ON_PATH = 1e-12      # of the arm's size
SAME = 1e-9          # rad, of an arm and the same with a rotated base
ARM = ThesisArm()
ROTATIONS = [Rotation.random(random_state=seed).as_matrix() for seed in range(4)]


def gap(q, other):
    """Return the largest difference of positions modulo whole turns."""
    return np.abs(np.remainder(q - other + np.pi, 2.0 * np.pi) - np.pi).max()


@pytest.mark.parametrize('name', ANY_ARM)
def test_tip_is_on_the_path_and_positions_are_those_of_small_steps(name):
    arm, rng = ANY_ARM[name], np.random.default_rng(85)
    for _ in range(2):
        path, first = regular_path(arm, rng)
        for found in (followed_path(arm, path, first), check_workspace(arm, FREE, path, first,
                                                                       first)):
            s, q = continued(arm, path, first)
            own = found(s).q
            tip = forward_kinematics(arm, own)
            assert np.abs(tip - path(s)[0]).max() <= ON_PATH * arm.chain.size
            assert own == pytest.approx(q, abs=1e-9)
            assert found.q[0] == pytest.approx(first, abs=1e-12)
            assert found.s[[0, -1]].tolist() == [0.0, path.length]


@pytest.mark.parametrize('name', ANY_ARM)
def test_path_beyond_the_reach_is_refused_by_as_much_as_a_dense_scan_finds(name):
    arm, rng = ANY_ARM[name], np.random.default_rng(86)
    for _ in range(3):
        first = regular_path(arm, rng, 2)[1]
        tip = forward_kinematics(arm, first)
        away = rng.normal(size=3)
        away *= 3.0 * arm.chain.size / np.linalg.norm(away)
        path = line_arc([tip, arm.chain.point[0] + away, tip + 0.01 * arm.chain.size], 0.3)
        miss = distances_out_of_reach(arm, path(np.linspace(0.0, path.length, 1001))[0])
        with pytest.raises(UnreachableError, match='the tip would be out of ') as caught:
            followed_path(arm, path, first)
        assert miss.max() * (1.0 - 1e-9) <= caught.value.distance <= miss.max() * 1.01
        assert caught.value.via_point == 1


@pytest.mark.parametrize('name', ANY_ARM)
def test_verdict_is_that_of_the_least_singular_value_along_small_steps(name):
    arm, rng = ANY_ARM[name], np.random.default_rng(87)
    followed = refused = 0
    for _ in range(8):
        first = regular_path(arm, rng, 2)[1]
        line = forward_kinematics(arm, first) + np.outer((0.0, 1.0), rng.normal(
            0.0, 0.3 * arm.chain.size, 3))
        path = line_arc(line, [])
        with np.errstate(all='ignore'):
            try:
                q = continued(arm, path, first)[1]
                least = least_singular_values(arm, q).min()
                jumped = np.abs(np.diff(q, axis=0)).max() > 0.5
            except np.linalg.LinAlgError:
                least, jumped = 0.0, True
        try:
            found = followed_path(arm, path, first)
        except (UnreachableError, LimitViolationError):
            assert jumped or least < 0.02 * arm.chain.size
            refused += 1
        else:
            own = found(np.linspace(0.0, path.length, 1000)).q
            assert least_singular_values(arm, own).min() >= LEAST_SINGULAR_VALUE
            assert jumped or own[-1] == pytest.approx(q[-1], abs=1e-6)
            followed += 1
    assert followed
    assert refused


@pytest.mark.parametrize('points', [
    [(1.6, 0.0, 0.5), (1.0, 0.3, 0.6)], [(1.0, 0.3, 0.6), (1.6, 0.0, 0.5)]])
def test_path_that_begins_or_ends_at_the_edge_of_the_workspace_is_refused_there(points):
    path = line_arc(points, [])
    edge = int(points[1][0] == 1.6)
    with pytest.raises(UnreachableError, match='end of its reach in this posture') as caught:
        followed_path(ARM, path, inverse_kinematics(ARM, points[0]))
    assert caught.value.via_point == edge


@pytest.mark.parametrize('distance', [1e-3, 1e-4, 1e-5, 2e-6])
@pytest.mark.parametrize('seed', range(4))
def test_rotated_base_changes_nothing_on_a_path_past_joint_axis_1(seed, distance):
    R, points = ROTATIONS[seed], np.array([[distance, 0.8, 1.0], [distance, -0.8, 1.1]])
    own, turned = line_arc(points, []), line_arc(points @ R.T, [])
    first = inverse_kinematics(ARM, points[0])
    arm = rotated(ARM, R)
    expected, found = (check_workspace(a, FREE, path, first, first)
                       for a, path in ((ARM, own), (arm, turned)))
    s = np.linspace(0.0, own.length, 501)
    # Rounding of the tip turns joint 1 by its angle as seen from the axis.
    assert found(s).q == pytest.approx(expected(s).q, abs=max(SAME, 1e-15 / distance))
    assert np.ptp(found.q[:, 0]) == pytest.approx(2.0 * np.arctan(0.8 / distance), abs=1e-8)


@pytest.mark.parametrize('distance', [0.6e-6, 1e-7])
@pytest.mark.parametrize('R', [np.eye(3), *ROTATIONS[:2]])
def test_path_nearer_to_joint_axis_1_than_the_least_singular_value_is_refused(R, distance):
    points = np.array([[distance, 0.8, 1.0], [distance, -0.8, 1.1]]) @ R.T
    arm = rotated(ARM, R)
    with pytest.raises(LimitViolationError, match='would pass joint axis 1 .*joint_1') as caught:
        followed_path(arm, line_arc(points, []), inverse_kinematics(arm, points[0]))
    assert caught.value.value == pytest.approx(distance, rel=1e-3)


@pytest.mark.parametrize('posture', ALL_POSTURES)
@pytest.mark.parametrize('seed', range(4))
def test_joint_axis_1_is_crossed_in_plane_in_every_posture_with_joint_1_at_rest(seed, posture):
    R, arm = ROTATIONS[seed], rotated(ARM, ROTATIONS[seed])
    azimuth = np.random.default_rng(seed).uniform(-np.pi, np.pi)
    out = np.array((np.cos(azimuth), np.sin(azimuth), 0.0))
    points = np.array([0.6 * out, -0.5 * out]) + [(0.0, 0.0, 1.3), (0.0, 0.0, 1.5)]
    own, path = line_arc(points, []), line_arc(points @ R.T, [])
    first = inverse_kinematics(ARM, points[0], posture.elbow, shoulder=posture.shoulder)
    elbow, shoulder = posture_of(arm, first)  # up is towards the upper end of joint axis 1
    assert gap(inverse_kinematics(arm, path.points[0], elbow, shoulder=shoulder), first) <= SAME
    s = np.linspace(0.0, path.length, 301)
    expected, found = check_workspace(ARM, FREE, own, first)(s), check_workspace(
        arm, FREE, path, first)(s)
    for ours, theirs in zip(found, expected):
        assert ours == pytest.approx(theirs, abs=SAME * (1.0 + np.abs(theirs).max()))
    tip = forward_kinematics(arm, found.q)
    assert np.abs(tip - path(s)[0]).max() <= ON_PATH * arm.chain.size
    assert np.ptp(found.q[:, 0]) == 0.0
    assert np.abs(found.dq[:, 0]).max() == 0.0
    over = {'front': 'back', 'back': 'front'}[posture.shoulder]
    assert posture_of(arm, found.q[0]) == (elbow, shoulder)
    assert posture_of(arm, found.q[-1]) == (elbow, over)
