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

"""Paths that leave the workspace or a joint's range between their via points."""

from helpers import thesis_cases as thesis
from helpers.arm_paths import arm_path_in
import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.errors import LimitViolationError, RrrPlannerError, UnreachableError
from rrr_traj_planner.core.kinematics.inverse import inverse_kinematics
from rrr_traj_planner.core.kinematics.postures import in_posture, Posture
from rrr_traj_planner.core.kinematics.solutions import all_solutions
from rrr_traj_planner.core.path.design import line_arc, line_polynomial

MODEL = RobotModel()
FREE = JointLimits(min_position=np.full(3, -np.inf), max_position=np.full(3, np.inf))
TABLE_6_3 = [thesis.POINTS[f'6.3 point {i}'][0] for i in (1, 2, 3)]


@pytest.mark.parametrize('family', [line_arc, line_polynomial])
def test_thesis_path_is_followed_and_begins_at_its_joint_positions(family):
    found = arm_path_in(MODEL, JointLimits(), family(TABLE_6_3, 0.1))
    assert np.rad2deg(found.q[0]) == pytest.approx(
        thesis.POINTS['6.3 point 1'][1], abs=thesis.ANGLE_TOLERANCE)


def test_line_that_passes_the_hole_is_refused_where_it_is_nearest():
    # 0.19 m from the shoulder halfway: the arm folds no nearer than 0.2 m.
    path = line_arc([[0.19, 0.3, 0.5], [0.19, -0.3, 0.5]], [])
    with pytest.raises(UnreachableError,
                       match=r'^at 0\.3 m along the path, between via points 0 and 1 \(nearest: '
                             r"[01]\): the tip would be out of the arm's reach: it misses by "
                             r'0\.01 m$') as caught:
        arm_path_in(MODEL, FREE, path)
    assert caught.value.distance == pytest.approx(0.01, abs=1e-12)


def test_corner_cut_outward_beyond_the_reach_is_refused_near_its_via_point():
    # The via point is just within reach; the path bulges outside the polyline beside it.
    tip = 1.6 - 1e-7
    points = [[0.2, 1.0, 0.5], [0.0, tip, 0.5], [-1.0, 0.2, 0.5]]
    for family in (line_arc, line_polynomial):
        path = family(points, 0.3)
        with pytest.raises(UnreachableError, match=r'\(nearest: 1\).* it misses by ') as caught:
            arm_path_in(MODEL, FREE, path)
        assert caught.value.via_point == 1
        s = np.linspace(0.0, path.length, 100001)
        beyond = np.linalg.norm(path(s)[0] - (0.0, 0.0, 0.5), axis=1).max() - 1.6
        assert caught.value.distance == pytest.approx(beyond, rel=1e-5)


def test_line_that_all_but_crosses_joint_axis_1_is_refused():
    path = line_arc([[0.6, 0.8, 1.0], [-0.6, -0.8 + 1e-7, 1.2]], [])
    with pytest.raises(LimitViolationError,
                       match=r'^at 1\.00499 m along the path, between via points 0 and 1 .*: the '
                             r'tip would pass joint axis 1 \(singularity\) at .* m, where '
                             r'joint_1') as caught:
        arm_path_in(MODEL, FREE, path)
    assert caught.value.joint == 'joint_1'


def test_line_past_joint_axis_1_at_a_millimetre_is_followed_half_a_turn():
    found = arm_path_in(
        MODEL, FREE, line_arc([[0.001, 0.8, 1.0], [0.001, -0.8, 1.0]], []))
    assert np.ptp(found.q[:, 0]) == pytest.approx(
        2.0 * np.arctan(800.0), abs=1e-9)


def test_joint_range_that_is_left_by_a_nanoradian_between_points_is_refused():
    path = line_arc([[1.2, -0.5, 0.6], [1.2, 0.7, 0.6]], [])
    # Joint 3 is least where the line is nearest to the shoulder: between its ends, at y = 0.
    nearest = inverse_kinematics(MODEL, (1.2, 0.0, 0.6), 'up')[2]
    ends = [inverse_kinematics(MODEL, p, 'up')[2] for p in path.points]
    assert nearest < min(ends) - 0.05

    def limits(lowest):
        return JointLimits(min_position=(-4.0, -4.0, lowest), max_position=(4.0, 4.0, 4.0))

    found = arm_path_in(MODEL, limits(nearest - 1e-7), path)
    assert found.q[:, 2].min() == pytest.approx(nearest, abs=1e-7)
    with pytest.raises(LimitViolationError,
                       match=r'^at 0\.5\d* m along the path, between via points 0 and 1 \(nearest:'
                             r' 0\): joint_3 would be at') as caught:
        arm_path_in(MODEL, limits(nearest + 1e-6), path)
    assert caught.value.value == pytest.approx(nearest, abs=1e-7)
    assert caught.value.via_point == 0


def test_verdict_is_that_of_a_dense_scan():
    rng, verdicts = np.random.default_rng(91), []
    for _ in range(60):
        points = rng.uniform((0.2, -0.8, 0.2), (1.1, 0.8, 1.2), (4, 3))
        path = (line_arc if rng.random() < 0.5 else line_polynomial)(points, 0.1)
        limits = JointLimits(min_position=(-1.2, -0.2, -1.2), max_position=(1.2, 1.8, 1.2))
        p = path(np.linspace(0.0, path.length, 1001))[0]
        every = all_solutions(MODEL, p)[0].reshape(-1, 3)
        every = every[np.isfinite(every[:, 0])]
        q = every[in_posture(MODEL, every, Posture('up', 'front'))]
        margin = -1.0 if len(q) < len(p) else min(
            (q - limits.min_position).min(), (limits.max_position - q).min())
        try:
            found = arm_path_in(MODEL, limits, path)
        except RrrPlannerError:
            verdicts.append(False)
            assert margin < 1e-3
        else:
            verdicts.append(True)
            assert margin >= -1e-9
            assert (found.q.min(axis=0) <= q.min(axis=0) + 2e-8).all()
            assert (found.q.max(axis=0) >= q.max(axis=0) - 2e-8).all()
    assert 10 < sum(verdicts) < 50
