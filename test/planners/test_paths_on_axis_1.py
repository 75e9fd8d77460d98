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
    per_step = found.trajectory.duration / (len(q) - 1)  # at 1 rad/s: no joint jumps
    assert np.abs(np.diff(q, axis=0)).max() < 1.01 * per_step
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
def test_lines_to_the_axis_stay_in_the_range_of_their_via_points(planner_id, reverse):
    # The larger a zone, the further the radial line beside it is turned away from its leg.
    tips = np.array([(0.9, -0.1, 0.7), (0.5, 0.8, 1.0), (0.0, 0.0, 1.6)])
    azimuth = np.arctan2(tips[:2, 1], tips[:2, 0])
    limits = replace(FREE, min_position=(azimuth[0] - 1e-3, -6.0, -6.0),
                     max_position=(azimuth[1] + 1e-3, 6.0, 6.0))
    motion_of(planner_id, tips[::-1] if reverse else tips, limits, max_deviation=0.25)


P, Q = (0.9, -0.1, 0.7), (0.5, 0.8, 1.0)
LOW, HIGH = (0.0, 0.0, 1.4), (0.0, 0.0, 1.7)


@each_planner
@pytest.mark.parametrize('max_deviation', [0.002, 0.05, 0.3])
@pytest.mark.parametrize('tips', [
    (P, Q, LOW, HIGH), (HIGH, LOW, Q, P), (LOW, HIGH, Q, P), (P, (0.25, 0.4, 1.2), LOW, HIGH),
    (P, Q, LOW, (0.25, 0.4, 1.9)), (HIGH, LOW, Q, P, (1.0, 0.3, 0.8), (0.5, 0.5, 1.5), HIGH)])
def test_lines_along_the_axis_are_reached_in_one_plane(planner_id, max_deviation, tips):
    # Those legs that meet on the axis lie in one plane; no zone leads the path out of it.
    azimuths = np.unwrap(np.arctan2(*np.array([t for t in tips if t[0] > 0.0]).T[1::-1]))
    limits = replace(FREE, min_position=(azimuths.min() - 0.3, -6.0, -6.0),
                     max_position=(azimuths.max() + 0.3, 6.0, 6.0))
    q = motion_of(planner_id, tips, limits, max_deviation=max_deviation)
    near = near_axis(q, 0.05)
    parts = np.split(np.flatnonzero(near), np.flatnonzero(np.diff(np.flatnonzero(near)) > 1) + 1)
    assert all(np.ptp(q[part, 0]) < STILL for part in parts)


@each_planner
@pytest.mark.parametrize('back', [False, True])
@pytest.mark.parametrize('tips', [(Q, P), (Q, P, (1.0, 0.3, 0.8)), (HIGH, Q, P)])
def test_a_start_on_the_axis_begins_a_leg_in_the_direction_of_joint_1(planner_id, back, tips):
    # The arm stands with joint 1 in the leg's plane: to its azimuth, or half a turn from it.
    azimuth = np.arctan2(Q[1], Q[0])
    turn = np.pi if back else 0.0
    lift = 2.0  # of the upper arm; the forearm leads the tip back to the axis
    start = (azimuth - turn, lift, np.arcsin(-0.9 * np.cos(lift) / 0.7) - lift)
    limits = replace(FREE, min_position=(-4.0, -6.0, -6.0), max_position=(4.0, 6.0, 6.0))
    q = motion_of(planner_id, tips, limits, start=start)
    assert q[0] == pytest.approx(start, abs=1e-9)
    assert np.ptp(q[near_axis(q, 0.3), 0]) < STILL  # the first leg is 0.94 m long from the axis
