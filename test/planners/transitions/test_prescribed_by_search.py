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

"""Durations that are prescribed: accepted where there is a motion, else others are offered."""

from dataclasses import replace

import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.errors import TimingError
from rrr_traj_planner.core.motion_laws.cycloid import transition
from rrr_traj_planner.core.trajectory.joint_profile import JointProfile
from rrr_traj_planner.core.trajectory.piecewise import PiecewiseTrajectory
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.request import PlanningRequest
from rrr_traj_planner.planners.transitions.prescribed_by_search import feasible_motion

PROFILE = JointProfile(transition(*(np.array([x]) for x in (1.0, 0.0, 0.0, 0.0))))
MOTION = PiecewiseTrajectory([PROFILE] * 3, [0.0, 1.0])


def slower_than(least):
    """Return a planner of motions that have a motion where every duration is long enough."""
    return lambda durations: MOTION if (durations >= np.array(least)).all() else None


def test_durations_with_a_motion_are_accepted():
    assert feasible_motion(slower_than([1.0, 2.0]), np.array([1.0, 2.0])) is MOTION


def test_durations_in_the_same_proportion_are_offered():
    # The second needs twice its time, so both are doubled.
    with pytest.raises(TimingError, match=(
            r'^segment_durations \[1\.5, 1\.0\] s are too short: the least feasible in their '
            r'proportion are \[3\.0\d*, 2\.0\d*\] s$')) as no:
        feasible_motion(slower_than([1.0, 2.0]), np.array([1.5, 1.0]))
    assert no.value.least_durations == pytest.approx((3.0, 2.0), rel=1e-5)
    assert (np.array(no.value.least_durations) >= [3.0, 2.0]).all()


def test_durations_that_are_long_enough_stay_where_the_fastest_are_known():
    with pytest.raises(TimingError, match=(
            r'^segment_durations \[1\.5, 1\.0\] s are too short: feasible are \[1\.5, 2')) as no:
        feasible_motion(slower_than([1.0, 2.0]), np.array([1.5, 1.0]),
                        lambda: np.array([1.0, 2.0]))
    assert no.value.least_durations == pytest.approx((1.5, 2.0), rel=1e-5)


def test_where_no_multiple_is_feasible_none_is_offered():
    with pytest.raises(TimingError, match=(
            r'^segment_durations \[1\.0\] s are too short, and no multiple of them is fe')) as no:
        feasible_motion(lambda durations: None, np.array([1.0]))
    assert no.value.least_durations == ()


@pytest.mark.parametrize('planner_id', ['cycloid_approach_b', 'poly_414'])
@pytest.mark.parametrize('stay', [0, 1, 2])
def test_beside_a_stay_durations_too_short_are_refused_with_feasible_ones(planner_id, stay):
    tips = [(0.99, 0.54, 0.67), (0.42, 0.1, 1.56), (0.78, 0.66, 1.7)]
    tips.insert(stay, tips[stay])
    durations = [0.1] * 3
    durations[stay] = 2.0
    request = PlanningRequest(tips, planner_id=planner_id, segment_durations=durations)
    with pytest.raises(TimingError, match='are too short: feasible are') as caught:
        plan(RobotModel(), JointLimits(), request)
    offered = caught.value.least_durations
    assert offered[stay] == pytest.approx(2.0, rel=1e-5)
    found = plan(RobotModel(), JointLimits(), replace(request, segment_durations=offered))
    assert np.diff(found.via_times) == pytest.approx(offered, rel=1e-9)
