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

"""Statically feasible paths, against the connected parts of a fine mesh and dense evaluation."""

from dataclasses import replace
from functools import cache

from helpers.spline_cases import ARM, blocked_task, is_connected, LIMITS, NONE, share_of
import numpy as np
import pytest
from rrr_traj_planner.planners.joint_timing.feasible_path import (
    gravity_ratio,
    statically_feasible_path,
)
from rrr_traj_planner.planners.tasks import JointTask

SEEDS = range(24)
LEGS = 8
RANGE = 1e-9    # rad
GAP = 0.03      # of an effort limit
# How much longer than another path the one that is found may be, lengths weighted by the margin to
# the torque limits: by the eight directions of a mesh's steps (1.082), and by the margin along
# legs that replace steps, at least 0.7 of the steps' where possible.
LONGER = 1.082 / np.sqrt(0.7)


@cache
def found(seed, most_legs=LEGS):
    """Return a task whose straight path is infeasible, and the path that is found."""
    task = blocked_task(seed)
    return task, statically_feasible_path(task, *task.points, most_legs)


def dense(corners, per_leg=1001):
    """Return points of the legs between corners."""
    return np.concatenate(np.linspace(corners[:-1], corners[1:], per_leg, axis=1))


def weighted_length(task, corners, least_margin=0.0):
    """Return a path's length in the plane of joints 2 and 3, over the root of the margin."""
    q = dense(corners, 101)
    margin = 1.0 - 0.5 * (share_of(task, q[1:]) + share_of(task, q[:-1]))
    steps = np.hypot(*np.diff(q[:, 1:], axis=0).T)
    return float((steps / np.sqrt(margin)).sum()) if margin.min() > least_margin else np.inf


def test_random_tasks_with_and_without_a_path_occur():
    there = [found(seed)[1] is not None for seed in SEEDS]
    assert sum(there) >= 15
    assert there.count(False) >= 4


@pytest.mark.parametrize('seed', SEEDS)
def test_a_path_is_found_just_where_cells_within_the_limits_connect_the_poses(seed):
    task, path = found(seed)
    if is_connected(task, margin=2.0):
        assert path is not None
    if not is_connected(task, margin=-2.0):
        assert path is None


@pytest.mark.parametrize('seed', SEEDS)
@pytest.mark.parametrize('most_legs', [3, LEGS, 40])
def test_arm_can_be_held_all_along_the_path_within_the_joint_ranges(seed, most_legs):
    task, path = found(seed, most_legs)
    if path is None:
        return
    assert 2 <= len(path) <= most_legs + 1
    assert (path[[0, -1]] == task.points).all()
    q = dense(path)
    assert share_of(task, q).max() < 1.0
    assert (q >= task.limits.min_position - RANGE).all()
    assert (q <= task.limits.max_position + RANGE).all()


@pytest.mark.parametrize('seed', SEEDS)
def test_the_reverse_task_has_a_path_just_where_the_task_has_one(seed):
    task, path = found(seed, 40)
    back = statically_feasible_path(task, *task.points[::-1], 40)
    assert (back is None) == (path is None)


@pytest.mark.parametrize('seed', SEEDS[::3])
def test_joint_1_moves_monotonically_and_its_range_does_not_matter(seed):
    task, path = found(seed)
    aside = np.array([2.5, 0.0, 0.0])
    limits = replace(task.limits, min_position=task.limits.min_position + aside,
                     max_position=task.limits.max_position + aside)
    other = statically_feasible_path(replace(task, limits=limits, points=task.points + aside),
                                     *(task.points + aside), LEGS)
    if path is None:
        assert other is None
        return
    assert other == pytest.approx(path + aside, abs=1e-12)
    assert (np.diff(path[:, 0]) * (path[-1, 0] - path[0, 0]) >= 0.0).all()


def test_path_is_straight_where_joint_1_moves_alone():
    q = np.array([[0.2, 1.4, 0.1], [1.2, 1.4, 0.1]])
    task = JointTask(ARM, LIMITS, q, None, 0.01)
    assert statically_feasible_path(task, *q, LEGS) == pytest.approx(q)


@pytest.mark.parametrize('seed', SEEDS[::3])
def test_one_leg_is_enough_just_where_gravity_does_not_matter(seed):
    task, _ = found(seed)
    assert statically_feasible_path(task, *task.points, 1) is None
    free = replace(task, limits=replace(task.limits, max_effort=NONE))
    assert (statically_feasible_path(free, *free.points, LEGS) == free.points).all()


def test_paths_are_hardly_longer_than_others_weighted_by_the_margin_to_the_limits():
    ratios = {}
    for seed in SEEDS:
        task, path = found(seed)
        if path is None:
            continue
        # others of two and three legs, not through gaps narrower than the cells of a coarse mesh
        rng = np.random.default_rng(seed)
        low, high = task.limits.min_position, task.limits.max_position
        others = [np.vstack((task.points[0], rng.uniform(low, high, (corners, 3)),
                             task.points[1])) for corners in (1, 2) for _ in range(100)]
        least = min(weighted_length(task, other, least_margin=GAP) for other in others)
        if np.isfinite(least):
            ratios[seed] = weighted_length(task, path) / least
    assert len(ratios) >= 8
    assert {seed: ratio for seed, ratio in ratios.items() if ratio > LONGER} == {}


@pytest.mark.parametrize('seed', SEEDS[::6])
def test_gravity_ratio_is_the_largest_over_the_joints_and_infinite_outside_the_ranges(seed):
    task, rng = blocked_task(seed), np.random.default_rng(seed)
    low, high = task.limits.min_position, task.limits.max_position
    q = rng.uniform(low, high, (50, 3))
    assert gravity_ratio(task.model, task.limits, q) == pytest.approx(share_of(task, q))
    for j in range(3):
        for end, sign in ((low, -1.0), (high, 1.0)):
            outside = q[0].copy()
            outside[j] = end[j] + 1e-8 * sign
            assert gravity_ratio(task.model, task.limits, outside) == np.inf
