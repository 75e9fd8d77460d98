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

"""Speeds where pieces of a path meet: reached in time, and nowhere needlessly low."""

from dataclasses import replace

from helpers.path_terms import demands, terms_at
from helpers.random_paths import PathCase, PLANNERS, random_case
import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.planners.path_timing.constraints import (
    ACCELERATION,
    all_bounds,
    JERK,
    TORQUE,
    VELOCITY,
)
from rrr_traj_planner.planners.path_timing.initial_speeds import initial_speeds_of, PART
from rrr_traj_planner.planners.path_timing.mesh import path_mesh
from rrr_traj_planner.planners.path_timing.start import motion_with_speeds
from rrr_traj_planner.planners.path_timing.table import PathTable
from rrr_traj_planner.planners.request import PlanningRequest

SEEDS = range(12)


def limits_of(case):
    return replace(case.limits, max_jerk=[10.0] * 3)


@pytest.mark.parametrize('seed', SEEDS)
def test_speeds_are_zero_at_both_ends_only(seed):
    case = random_case(seed)
    speeds = initial_speeds_of(PathTable(case.arm_path), all_bounds(limits_of(case), np.inf))
    assert speeds[[0, -1]].tolist() == [0.0, 0.0]
    assert (speeds[1:-1] > 0.0).all()


@pytest.mark.parametrize('seed', SEEDS)
def test_a_motion_of_these_speeds_is_within_every_limit(seed):
    case = random_case(seed)
    limits = limits_of(case)
    table, bounds = PathTable(case.arm_path), all_bounds(limits, np.inf)
    mesh = path_mesh(len(table.ends) - 1)
    m = motion_with_speeds(mesh, table.ends, initial_speeds_of(table, bounds))
    at = np.concatenate(mesh.states(table.ends[:, np.newaxis], m), axis=-1)
    demand = terms_at(table, at[..., 0])
    x = np.abs(demands(demand, at))
    for kind in (VELOCITY, ACCELERATION, JERK):
        assert (x[..., kind] <= bounds[kind]).all()
    assert (x[..., TORQUE] <= np.maximum(bounds[TORQUE], 1.05 * np.abs(demand.g))).all()


@pytest.mark.parametrize('seed', SEEDS)
def test_every_speed_is_bounded_by_a_neighbour_or_by_a_limit(seed):
    case = random_case(seed)
    table, bounds = PathTable(case.arm_path), all_bounds(limits_of(case), np.inf)
    speeds = initial_speeds_of(table, bounds)
    d = table.values
    for k in range(1, len(speeds) - 1):
        own = np.inf
        for piece in (k - 1, k):
            with np.errstate(divide='ignore'):
                own = min(own, (PART * bounds[VELOCITY] / np.abs(d.dq[piece])).min(),
                          np.sqrt(PART * bounds[ACCELERATION] / np.abs(d.ddq[piece])).min(),
                          np.cbrt(PART * bounds[JERK] / np.abs(d.dddq[piece])).min(),
                          np.sqrt(PART * np.maximum(bounds[TORQUE] - np.abs(d.g[piece]), 0.0)
                                  / np.abs(d.c[piece])).min())
        changes = np.abs(speeds[k] - speeds[[k - 1, k + 1]]) > 1e-9 * speeds[k]
        assert speeds[k] == pytest.approx(own, rel=1e-6) or changes.any()
        assert speeds[k] <= own * (1.0 + 1e-9)


@pytest.mark.parametrize('planner_id', PLANNERS)
def test_a_tiny_zone_slows_the_tip_there_and_not_on_the_long_lines(planner_id):
    durations = []
    for size in (1e-4, 1e-6, 1e-8):
        tips = np.array([(0.9, 0.3, 0.6), (1.1, 0.3, 0.6), (1.1, 0.3 + size, 0.6),
                         (1.1, 0.3 + size, 0.8)])
        case = PathCase(RobotModel(), JointLimits(), PlanningRequest(
            tips, planner_id=planner_id, max_deviation=0.05, elbow='up'))
        speeds = initial_speeds_of(PathTable(case.arm_path), all_bounds(limits_of(case), np.inf))
        assert speeds[1:-1].min() <= 0.1 * speeds.max()
        found = case.planned()
        assert 'converged' not in found.note
        durations.append(found.trajectory.duration)
    # next to a stop, and all but the same
    assert durations == pytest.approx(durations[1:2] * 3, rel=5e-2)
