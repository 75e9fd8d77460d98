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

"""Pieces of a path near singular positions, where joints turn within little of it."""

from helpers.arm_paths import arm_path_in
from helpers.path_terms import terms_at
from helpers.thesis_arm import ThesisArm
import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.kinematics.along_path import singular_distance
from rrr_traj_planner.core.path.design import line_arc
from rrr_traj_planner.planners.path_timing.pieces import NEAR, piece_ends
from rrr_traj_planner.planners.path_timing.table import PathTable
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.request import PlanningRequest

ARM = ThesisArm()
LIMITS = JointLimits(min_position=[-4.0, -1.0, -4.0], max_position=[4.0, 4.2, 4.0])
REACH = ARM.a2 + ARM.d4
V, A, J = 1.0, 1.0, 10.0       # joint_1's limits
TURN = np.pi / V + V / A + A / J  # s, half a turn of it alone, from rest to rest
NEVER_AT_REST = 1.05           # along a path, of what stopping to turn takes
DISTANCES = [3e-2, 1e-3, 1e-4, 1e-5, 1.2e-6]
EDGES = [1e-2, 1e-4, 1e-6, 1e-8]
PLANNERS = ['line_arc', 'line_polynomial']


def past_the_axis(distance, height=1.2):
    return [(0.5, distance, height), (-0.3, distance, height)]


def to_the_edge(distance):
    """Return a line upward that ends so far within reach, which leaves it radially."""
    W = REACH - distance
    end = np.array((0.6 * W, 0.0, ARM.d1 + 0.8 * W))
    return [end - (0.0, 0.0, 0.5), end]


def arm_path(tips):
    return arm_path_in(ARM, LIMITS, line_arc(np.array(tips), 0.01))


def duration(tips, planner_id):
    answer = plan(ARM, LIMITS, PlanningRequest(tips, planner_id=planner_id, elbow='up'))
    assert answer.note == ''
    return answer.trajectory.duration


@pytest.mark.parametrize('distance', DISTANCES)
@pytest.mark.parametrize('planner_id', PLANNERS)
def test_passing_joint_axis_1_takes_no_longer_than_to_stop_there_and_turn(planner_id, distance):
    # In a plane with the axis joint 1 stands still: to the axis, half a turn, and away from it.
    there = duration([(0.5, 0.0, 1.2), (0.0, 0.0, 1.2)], planner_id)
    onward = duration([(0.0, 0.0, 1.2), (-0.3, 0.0, 1.2)], planner_id)
    passing = duration(past_the_axis(distance), planner_id)
    assert passing <= NEVER_AT_REST * (there + TURN + onward)
    assert passing >= TURN - 2.0 * np.arctan(distance / 0.3)  # by so much joint 1 turns less


@pytest.mark.parametrize('planner_id', PLANNERS)
def test_time_to_the_edge_of_the_workspace_has_a_limit(planner_id):
    # joint_3 turns by sqrt(distance) on the last of the path, whatever the scale.
    times = [duration(to_the_edge(distance), planner_id) for distance in EDGES]
    assert (np.diff(times) > 0.0).all()  # each path is part of the next one, but for its end
    assert times[-1] <= 1.25 * times[0]
    joints = plan(ARM, LIMITS, PlanningRequest(
        to_the_edge(EDGES[-1]), planner_id='time_optimal')).trajectory.duration
    assert joints <= times[-1] <= 1.2 * joints


@pytest.mark.parametrize('tips', [
    *map(past_the_axis, DISTANCES), *map(to_the_edge, EDGES),
    [(0.6, 0.3, 1.1), (0.5, -0.2, 0.9)], [(0.25, -0.2, ARM.d1), (0.25, 0.2, ARM.d1)]])
def test_no_piece_is_longer_than_its_distance_to_a_singularity_allows(tips):
    path = arm_path(tips)
    ends = piece_ends(path)
    middle, (p, q) = 0.5 * (ends[1:] + ends[:-1]), np.array(tips)
    u = (q - p) / np.linalg.norm(q - p)
    p = p - (0.0, 0.0, ARM.d1)
    # (p + s u)^2 = R^2, of the horizontal part and of all of it, as polynomials of s.
    squares = [np.array([(u[:k] ** 2).sum(), 2.0 * p[:k] @ u[:k], (p[:k] ** 2).sum() - R * R])
               for k, R in ((2, 0.0), (3, REACH), (3, abs(ARM.a2 - ARM.d4)))]
    roots = np.concatenate([np.roots(np.trim_zeros(c, 'f')) for c in squares[int(p[1] == 0.0):]])
    nearest = np.abs(middle[:, np.newaxis] - roots).min(axis=1)
    ours = singular_distance(path.regularity(middle))
    assert (ours < 1.3 * nearest).all() and (ours > 0.5 * nearest).all()
    near = nearest < 0.01
    assert ours[near] == pytest.approx(nearest[near], rel=0.01)
    assert (np.diff(ends) <= NEAR * nearest * 1.3).all()
    assert len(ends) < 60


@pytest.mark.parametrize('tips', [*map(past_the_axis, DISTANCES), *map(to_the_edge, EDGES)])
def test_table_follows_the_joints_near_singularities_too(tips):
    path = arm_path(tips)
    table = PathTable(path)
    share = np.random.default_rng(1).uniform(size=(len(table.ends) - 1, 40))
    s = table.ends[:-1, np.newaxis] + np.diff(table.ends)[:, np.newaxis] * share
    _, dq, ddq, _ = (x.reshape(*s.shape, 3) for x in path(s.ravel()))
    for ours, exact in ((terms_at(table, s).dq, dq), (terms_at(table, s).ddq, ddq)):
        assert (np.abs(ours - exact).max(axis=1) <= 1e-3 * np.abs(exact).max(axis=(1, 2))[
            :, np.newaxis]).all()
