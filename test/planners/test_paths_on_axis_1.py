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

"""Paths of the tip that end, begin or pass on joint axis 1: joint 1 must not turn at once."""

from dataclasses import replace

from helpers.random_paths import NONE, PLANNERS
import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.request import PlanningRequest

MODEL = RobotModel()
FREE = JointLimits((-np.pi, -6.0, -6.0), (np.pi, 6.0, 6.0), max_effort=NONE)
HIT = 2e-9        # m: via points are hit to 1e-9 rad
STILL = 1e-9      # rad, of joint 1 in a plane with its axis

each_planner = pytest.mark.parametrize('planner_id', PLANNERS)


def motion_of(planner_id, tips, limits=FREE, **request):
    """Return joint positions on a fine grid of the plan, which passes every via point."""
    found = plan(MODEL, limits, PlanningRequest(tips, planner_id=planner_id, **request))
    passed = forward_kinematics(MODEL, found.trajectory(found.via_times)[0])
    assert passed == pytest.approx(np.array(tips), abs=HIT)
    q = found.trajectory(np.linspace(0.0, found.trajectory.duration, 4001))[0]
    assert (q >= limits.min_position - STILL).all() and (q <= limits.max_position + STILL).all()
    assert np.abs(np.diff(q[:, 0])).max() < 2e-3  # at 1 rad/s for no more than 8 s: no jump
    return q


def near_axis(q, distance):
    """Return where the tip is on or near joint axis 1."""
    return np.hypot(*forward_kinematics(MODEL, q)[:, :2].T) < distance


@each_planner
@pytest.mark.parametrize(('tips', 'start'), [
    ([(0.44130084254927343, 0.17477090752754726, 1.6006372326031983),
      (0.0, 0.0, 1.6006372326031983)], (0.4078536585749296, 1.2, 0.3)),
    ([(0.37481218799, 0.48488482372, 1.12226094794), (0.28431934384, 0.11294030957, 1.59664926520),
      (0.0, 0.0, 1.59664926520)], None)])
def test_a_zone_leaves_a_part_of_the_line_that_ends_on_the_axis(planner_id, tips, start):
    q = motion_of(planner_id, tips, start=start)
    end = near_axis(q, 1e-5)
    assert end.sum() > 2
    assert np.ptp(q[end, 0]) < STILL


@each_planner
@pytest.mark.parametrize('reverse', [False, True])
def test_lines_to_the_axis_keep_within_the_range_that_holds_their_via_points(planner_id, reverse):
    # The larger a zone, the further the radial line beside it is turned away from its leg.
    tips = np.array([(0.9, -0.1, 0.7), (0.5, 0.8, 1.0), (0.0, 0.0, 1.6)])
    azimuth = np.arctan2(tips[:2, 1], tips[:2, 0])
    limits = replace(FREE, min_position=(azimuth[0] - 1e-3, -6.0, -6.0),
                     max_position=(azimuth[1] + 1e-3, 6.0, 6.0))
    motion_of(planner_id, tips[::-1] if reverse else tips, limits, max_deviation=0.25)
