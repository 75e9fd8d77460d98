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

"""Motions one after another: the same motions, later."""

import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.trajectory.joined import joined, JoinedTrajectory
from rrr_traj_planner.core.trajectory.piecewise import PiecewiseTrajectory
from rrr_traj_planner.core.trajectory.trajectory import Peaks
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.request import PlanningRequest

POINTS = [(1.02, 0.59, 0.97), (0.46, 0.55, 1.44), (0.45, 0.38, 1.45), (0.8, 0.5, 1.2)]
ROUNDING = 1e-12


def motion(points, **request):
    return plan(RobotModel(), JointLimits(), PlanningRequest(points, **request)).trajectory


@pytest.fixture(scope='module', params=['cycloid', 'gauss', 'time_optimal', 'line_arc'])
def parts(request):
    there = motion(POINTS[:2], planner_id=request.param)
    on = motion(POINTS[2:], planner_id=request.param, start=there(there.duration)[0])
    return there, on


def test_each_motion_is_found_again_after_those_before_it(parts):
    whole, begin = joined(parts), 0.0
    assert isinstance(whole, JoinedTrajectory) == (not isinstance(parts[0], PiecewiseTrajectory))
    for part in parts:
        t = np.linspace(0.0, part.duration, 101)[1:-1]
        for value, expected in zip(whole(begin + t), part(t)):
            assert value == pytest.approx(expected, abs=1e-9)  # jerk times rounding of time
        begin += part.duration
    assert whole.duration == pytest.approx(begin, abs=ROUNDING)
    first, second = (part.via_times for part in parts)
    assert whole.via_times == pytest.approx(
        [*first, *(first[-1] + second[1:])], abs=ROUNDING)
    assert whole.via_times[-1] == whole.duration


def test_peaks_are_those_of_all_motions(parts):
    whole, (a, b) = joined(parts).peaks(), (part.peaks() for part in parts)
    for name in ('velocity', 'acceleration', 'jerk', 'max_position'):
        assert getattr(whole, name) == pytest.approx(
            np.maximum(getattr(a, name), getattr(b, name)), rel=1e-12)
    assert whole.min_position == pytest.approx(np.minimum(a.min_position, b.min_position))
    assert isinstance(whole, Peaks)


def test_knots_and_steps_are_those_of_all_motions(parts):
    whole, first = joined(parts), parts[0].duration
    knots = np.concatenate((parts[0].knots, first + parts[1].knots[1:]))
    assert whole.knots == pytest.approx(knots, abs=1e-9)
    assert (np.diff(whole.knots) > 0.0).all()
    for name in ('step_times', 'jerk_step_times'):
        assert getattr(whole, name) == pytest.approx(np.concatenate((
            getattr(parts[0], name), first + getattr(parts[1], name))), abs=ROUNDING)


def test_time_scaled_motions_are_the_motion_of_scaled_ones(parts):
    slower, same = joined(parts).time_scaled(1.5), joined([p.time_scaled(1.5) for p in parts])
    assert slower.duration == pytest.approx(same.duration, abs=ROUNDING)
    assert slower.via_times == pytest.approx(same.via_times, abs=ROUNDING)
    t = np.linspace(0.0, same.duration, 50)
    for value, expected in zip(slower(t), same(t)):
        assert value == pytest.approx(expected, abs=1e-9)


def test_one_motion_is_itself_and_none_is_refused(parts):
    assert joined(parts[:1], 'slow').note == 'slow'
    assert joined(parts[:1])(0.3)[0].tolist() == parts[0](0.3)[0].tolist()
    with pytest.raises(InvalidInputError, match='^no motion is given, at least one is needed$'):
        joined([])


def test_a_motion_that_begins_elsewhere_is_refused(parts):
    with pytest.raises(InvalidInputError, match=(
            r'^motion 1 begins 0\.\d+ rad from where motion 0 ends, at most 1e-09 rad are')):
        joined([parts[0], parts[0]])
