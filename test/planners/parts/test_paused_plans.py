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

"""Pauses at via points: the motion waits, and is otherwise the same."""

import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.trajectory.paused import PausedTrajectory
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.request import PlanningRequest

POINTS = [(1.02, 0.59, 0.97), (0.46, 0.55, 1.44), (0.45, 0.38, 1.45)]
REST = [True, True, True]
ROUNDING = 1e-12


@pytest.fixture(scope='module')
def moving():
    """Return a motion that stops at every via point."""
    return plan(RobotModel(), JointLimits(), PlanningRequest(
        POINTS, planner_id='cycloid_approach_c')).trajectory


def paused(moving, pauses, at_rest=REST, index=(0, 1, 2)):
    return PausedTrajectory(moving, np.array(index), at_rest, pauses)


def test_arm_rests_for_each_pause_and_moves_as_before_in_between(moving):
    motion, (_, middle, end) = paused(moving, [0.5, 0.25, 1.0]), moving.via_times
    assert motion.via_times == pytest.approx([0.0, 0.5 + middle, 0.75 + end], abs=ROUNDING)
    assert motion.duration == pytest.approx(1.75 + end, abs=ROUNDING)
    for arrival, pause, where in zip(motion.via_times, (0.5, 0.25, 1.0), moving.via_times):
        q, qd, qdd, qddd = motion(arrival + pause * np.linspace(0.0, 0.999, 9))
        assert q == pytest.approx(np.tile(moving(where)[0], (9, 1)), abs=ROUNDING)
        assert not qd.any() and not qdd.any() and not qddd.any()
    for before, begin, until in ((0.5, 0.0, middle), (0.75, middle, end)):
        t = np.linspace(begin, until, 51)[1:-1]
        for value, expected in zip(motion(before + t), moving(t)):
            assert value == pytest.approx(expected, abs=1e-9)


def test_without_pauses_it_rests_exactly_at_its_stops(moving):
    motion = paused(moving, [0.0, 0.0, 0.0])
    _, qd, qdd, _ = motion(motion.via_times)
    assert not qd.any() and not qdd.any()
    assert motion.duration == moving.duration
    assert motion.via_times.tolist() == moving.via_times.tolist()


def test_two_pauses_at_one_place_follow_one_another(moving):
    motion = paused(moving, [0.0, 0.5, 0.5, 0.0], [True] * 4, (0, 1, 1, 2))
    middle = moving.via_times[1]
    assert motion.via_times[1:3] == pytest.approx([middle, middle + 0.5], abs=ROUNDING)
    assert motion(middle + 0.7)[0] == pytest.approx(moving(middle)[0], abs=ROUNDING)
    assert motion(middle + 1.3)[0] == pytest.approx(moving(middle + 0.3)[0], abs=ROUNDING)


def test_slowed_motion_pauses_as_long_as_before(moving):
    slower = paused(moving, [0.5, 0.25, 1.0]).time_scaled(2.0)
    assert slower.duration == pytest.approx(2.0 * moving.duration + 1.75, abs=ROUNDING)
    assert slower.pauses.tolist() == [0.5, 0.25, 1.0]
    assert slower.peaks().velocity == pytest.approx(0.5 * moving.peaks().velocity)


def test_knots_meet_both_ends_of_every_pause_and_points_are_wanted_where_it_moves_on(moving):
    motion = paused(moving, [0.5, 0.25, 1.0])
    ends = motion.via_times + motion.pauses
    for t in (*motion.via_times, *ends):
        assert np.abs(motion.knots - t).min() < 1e-9
    assert (np.diff(motion.knots) > 0.0).all()
    assert (motion.knots[0], motion.knots[-1]) == (0.0, motion.duration)
    for t in ends:
        assert np.abs(motion.jerk_step_times - t).min() < 1e-9


@pytest.mark.parametrize(('pauses', 'at_rest'), [
    ([0.0, -0.1, 0.0], REST), ([0.0, 0.1, 0.0], [True, False, True])])
def test_negative_pauses_and_pauses_in_motion_are_refused(moving, pauses, at_rest):
    with pytest.raises(InvalidInputError, match='must not be negative, and 0 where the motion'):
        paused(moving, pauses, at_rest)
