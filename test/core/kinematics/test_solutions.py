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

"""All inverse solutions of any chain of three revolute joints."""

from helpers.random_cases import ARMS
from helpers.random_chains import random_arm, with_axes
from helpers.thesis_arm import ThesisArm
import numpy as np
import pytest
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.kinematics.forward import forward_kinematics, jacobian
from rrr_traj_planner.core.kinematics.inverse import inverse_kinematics
from rrr_traj_planner.core.kinematics.postures import ELBOWS, SHOULDERS
from rrr_traj_planner.core.kinematics.solutions import all_solutions, solutions
from scipy.optimize import least_squares

POSES = 300
SINGULAR = 1e-4       # least singular value of the Jacobian, in sizes, of poses that are compared
MOST_SINGULAR = 9     # of the poses: 3 %
ANGLE_ROUNDING = 1e-15  # in sizes, of the tip's position; over the singular value, rad
TIP_ROUNDING = 1e-14  # in sizes: sums of up to 27 products
MISS = 1e-6           # m, of the nearest point that is reached

# Every kind of chain: skew, axes 1 and 2 meeting, all but meeting, axes 2 and 3 parallel.
CHAINS = {
    'thesis': ThesisArm(), **{f'random {seed}': random_arm(seed) for seed in range(6)},
    **{f'meeting {seed}': with_axes(random_arm(seed), 0.0) for seed in range(2)},
    **{f'axes at {d} m': with_axes(random_arm(1), d) for d in (1e-9, 1e-6, 3e-5, 1e-3, 1e-2)},
    'parallel': with_axes(random_arm(2), parallel=True),
    'meeting and parallel': with_axes(random_arm(3), 0.0, parallel=True),
    'parallel, axes at 1e-7 m': with_axes(random_arm(4), 1e-7, parallel=True)}


def distance(q, other):
    """Return the largest difference of joint positions, modulo whole turns."""
    return np.abs(np.remainder(q - other + np.pi, 2.0 * np.pi) - np.pi).max(axis=-1)


def distance_from(arm, point, start):
    """Return the tip's least distance from a point that a search finds [m]."""
    search = least_squares(lambda q: forward_kinematics(arm, q) - point, start, method='lm',
                           jac=lambda q: jacobian(arm, q), xtol=1e-12, ftol=1e-14)
    return np.sqrt(2.0 * search.cost)


def states(seed, n=POSES):
    return np.random.default_rng(seed).uniform(-np.pi, np.pi, (n, 3))


@pytest.mark.parametrize('name', CHAINS)
def test_joint_positions_are_among_the_solutions_for_their_tip(name):
    arm, q = CHAINS[name], states(1)
    singular = np.linalg.svd(jacobian(arm, q), compute_uv=False)[:, -1] / arm.chain.size
    regular = singular > SINGULAR
    assert np.count_nonzero(~regular) <= MOST_SINGULAR
    found, _ = all_solutions(arm, forward_kinematics(arm, q))
    nearest = np.nanmin(distance(found, q[:, np.newaxis]), axis=1)
    assert (nearest <= np.maximum(1e-9, 4.0 * ANGLE_ROUNDING / singular))[regular].all()
    assert nearest[regular].max() <= 1e-9


@pytest.mark.parametrize('name', CHAINS)
def test_every_solution_brings_the_tip_to_the_point(name):
    arm = CHAINS[name]
    points = forward_kinematics(arm, states(2))
    q, count = all_solutions(arm, points)
    present = np.arange(4) < count[:, np.newaxis]
    assert (np.isfinite(q).all(axis=-1) == present).all()
    assert (q[present] > -np.pi).all()
    assert (q[present] <= np.pi).all()
    tips = forward_kinematics(arm, q[present])
    misses = np.linalg.norm(tips - np.repeat(points, count, axis=0), axis=1)
    assert misses.max() <= TIP_ROUNDING * arm.chain.size


@pytest.mark.parametrize('name', CHAINS)
def test_solutions_are_distinct_and_even_in_number(name):
    arm, q = CHAINS[name], states(3)
    det = np.abs(np.linalg.det(jacobian(arm, q)))
    found, count = all_solutions(arm, forward_kinematics(arm, q[det > 1e-3 * det.max()]))
    assert np.isin(count, (2, 4)).all()
    for i in range(4):
        for j in range(i):
            assert np.nanmin(distance(found[:, i], found[:, j]), initial=np.inf) > 1e-6


@pytest.mark.parametrize('arm', ARMS)
def test_solutions_of_the_thesis_s_kind_of_arm_are_its_four_postures(arm):
    rng = np.random.default_rng(4)
    least, most = arm.reach
    for direction in rng.normal(size=(40, 3)):
        W = rng.uniform(least + 0.01 * most, 0.99 * most)
        point = (0.0, 0.0, arm.d1) + W * direction / np.linalg.norm(direction)
        found = solutions(arm, point)
        postures = np.array([inverse_kinematics(arm, point, elbow, shoulder=shoulder)
                             for elbow in ELBOWS for shoulder in SHOULDERS])
        apart = distance(found.q[:, np.newaxis], postures)
        assert found.nearest == 0.0
        assert len(found.q) == 4
        assert apart.min(axis=0).max() <= 1e-9
        assert apart.min(axis=1).max() <= 1e-9


def test_solutions_are_in_ascending_order():
    for name in ('thesis', 'random 4', 'meeting 1'):
        for point in forward_kinematics(CHAINS[name], states(5, 40)):
            rounded = np.round(solutions(CHAINS[name], point).q, 6) + 0.0
            assert sorted(rounded.tolist()) == rounded.tolist()


@pytest.mark.parametrize('beyond', [0.0, 1e-12, 5e-10, 1e-6, 1e-3, 0.5])
def test_edges_of_the_workspace_are_found_and_misses_beyond_them_told(beyond):
    arm, rng = ThesisArm(), np.random.default_rng(6)
    least, most = arm.reach
    for W in (most + beyond, least - min(beyond, 0.9 * least)):
        direction = rng.normal(size=3)
        point = (0.0, 0.0, arm.d1) + W * direction / np.linalg.norm(direction)
        found = solutions(arm, point, 1e-9)
        miss = max(W - most, least - W)
        if miss <= 1e-9:
            assert len(found.q) == 2
            assert found.nearest == 0.0
            assert np.abs(forward_kinematics(arm, found.q) - point).max() <= miss + 1e-12
            assert np.abs(np.cos(found.q[:, 2])).max() <= 1e-4  # stretched or folded
        else:
            assert len(found.q) == 0
            assert found.nearest == pytest.approx(miss, abs=min(MISS, 1e-3 * miss))


@pytest.mark.parametrize('size', [1e12, 1e200, 1e307])
def test_a_point_far_away_is_missed_by_its_distance(size):
    assert solutions(random_arm(0), (-size, 0.0, size)).nearest == pytest.approx(2 ** 0.5 * size)


@pytest.mark.parametrize('seed', range(12))
def test_the_nearest_point_is_that_of_a_search_from_many_starts(seed):
    arm, rng = random_arm(seed), np.random.default_rng(seed)
    missed = 0
    for point in rng.normal(size=(8, 3)) * arm.chain.size:
        found = solutions(arm, point)
        least = min(distance_from(arm, point, start) for start in states(seed, 16))
        missed += not len(found.q)
        assert found.nearest <= least + MISS
        assert len(found.q) or found.nearest == pytest.approx(least, abs=MISS)
    assert missed


@pytest.mark.parametrize('name', ['thesis', 'random 0', 'axes at 3e-05 m'])
def test_a_tolerance_admits_points_out_of_reach(name):
    arm = CHAINS[name]
    point = np.full(3, arm.chain.size)
    miss = solutions(arm, point).nearest
    assert len(solutions(arm, point, 0.99 * miss).q) == 0
    q = solutions(arm, point, 1.01 * miss).q
    assert np.linalg.norm(forward_kinematics(arm, q) - point, axis=1).min() == pytest.approx(miss)


@pytest.mark.parametrize('off', [0.0, 1e-12, 5e-10])
def test_joint_1_keeps_its_position_where_the_tip_is_on_its_axis(off):
    arm, before = RobotModel(), (0.7, 0.0, 0.0)
    q = solutions(arm, (off, 0.0, 1.5), previous=before).q
    expected = [inverse_kinematics(arm, (0.0, 0.0, 1.5), elbow, before) for elbow in ELBOWS]
    assert len(q) == 2
    assert q[:, 0] == pytest.approx([0.7, 0.7], abs=1e-12)
    assert min(distance(q[i], expected[0]) + distance(q[1 - i], expected[1])
               for i in range(2)) <= 1e-9


def test_joint_2_keeps_its_position_where_the_tip_is_on_its_axis():
    # forearm and upper arm of one length and the arm folded: theta_3 = -90 deg
    arm, before = ThesisArm(a2=0.7, d4=0.7), (0.3, 0.4, 0.0)
    q = solutions(arm, (0.0, 0.0, arm.d1), previous=before).q
    assert distance(q, np.array((0.3, 0.4, -0.5 * np.pi))).min() <= 1e-9


@pytest.mark.parametrize('name', ['thesis', 'random 0', 'parallel'])
def test_results_do_not_depend_on_the_number_of_points(name):
    arm = CHAINS[name]
    points = forward_kinematics(arm, states(7, 50)) * np.random.default_rng(7).uniform(
        0.5, 1.5, (50, 1))
    q, count = all_solutions(arm, points)
    for i, point in enumerate(points):
        one, n = all_solutions(arm, point[np.newaxis])
        np.testing.assert_array_equal(one[0], q[i])
        assert n[0] == count[i]
        np.testing.assert_array_equal(solutions(arm, point).q, q[i, :count[i]])


def test_no_points_have_no_solutions():
    q, count = all_solutions(RobotModel(), np.empty((0, 3)))
    assert q.shape == (0, 4, 3)
    assert count.shape == (0,)


@pytest.mark.parametrize(('arguments', 'message'), [
    (((1.0, 2.0),), r'point has shape \(2,\)'), (((1.0, np.nan, 0.0),), 'point.* finite'),
    (((1.0, 0.0, 0.0), 0.0), 'tolerance is 0'),
    (((1.0, 0.0, 0.0), 1e-9, (0.0, 0.0)), r'previous has shape \(2,\)')])
def test_malformed_arguments_are_refused(arguments, message):
    with pytest.raises(InvalidInputError, match=message):
        solutions(RobotModel(), *arguments)
