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

"""Whole turns that bring joints into their ranges, and the error of one that is outside."""

import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.kinematics.joint_ranges import out_of_range, range_error, whole_turns

TURN = 2.0 * np.pi
FREE = JointLimits(min_position=np.full(3, -np.inf), max_position=np.full(3, np.inf))


def test_turns_are_those_that_trial_of_all_turns_finds():
    rng = np.random.default_rng(37)
    fitted = 0
    for _ in range(300):
        q = rng.uniform(-np.pi, np.pi, 3) + np.cumsum(rng.uniform(-1.0, 1.0, (4, 3)), axis=0)
        low = rng.uniform(-10.0, 5.0, 3)
        high = low + rng.uniform(0.5, 20.0, 3)  # up to more than three turns
        turned = q + whole_turns(q, JointLimits(low, high))
        for j in range(3):
            fitting = [q[:, j] + k * TURN for k in range(-12, 13)]
            fitting = [x for x in fitting if low[j] <= x.min() and x.max() <= high[j]]
            if fitting:
                fitted += 1
                best = min(fitting, key=lambda x: abs(x[0]))
                assert turned[:, j] == pytest.approx(best, abs=1e-12)
    assert fitted > 500


def test_motion_that_fits_with_no_turn_comes_as_near_to_its_range_as_turns_bring_it():
    rng = np.random.default_rng(38)
    for _ in range(100):
        low = rng.uniform(-10.0, 10.0, 3)
        high = low + rng.uniform(0.1, 1.0, 3)
        # Outside the range wherever it is turned: on the far side of the circle.
        q = 0.5 * (low + high) + rng.uniform(1.0, TURN - 1.0, 3) + TURN * rng.integers(-3, 4, 3)
        outside = q + whole_turns(q[np.newaxis], JointLimits(low, high))
        for j in range(3):
            distances = [max(low[j] - a, a - high[j]) for a in q[j] + TURN * np.arange(-9, 10)]
            distance = max(low[j] - outside[j], outside[j] - high[j])
            assert distance == pytest.approx(min(distances), abs=1e-12)


def test_a_start_is_where_the_motion_begins_even_if_it_then_leaves_its_range():
    q = np.array([[0.1, 0.2, 0.3], [3.0, 0.2, 0.3]])
    start = np.array([0.1 + 6 * TURN, 0.2 - 6 * TURN, 0.3])
    for limits in (FREE, JointLimits((-40.0, -40.0, 0.0), (38.0, 40.0, 1.0))):
        assert (q + whole_turns(q, limits, start))[0] == pytest.approx(start, abs=1e-12)


def test_ranges_open_on_one_side_are_entered_at_the_nearest_turn():
    half_open = JointLimits(min_position=(10.0, 10.0, 10.0), max_position=np.full(3, np.inf))
    q = np.array([[0.0, 0.0, 4.0]])
    assert q + whole_turns(q, half_open) == pytest.approx(
        np.array([[2 * TURN, 2 * TURN, 4.0 + TURN]]), abs=1e-12)
    assert whole_turns(q, FREE).tolist() == [0.0, 0.0, -TURN]


def test_only_rounding_is_tolerated_at_the_end_of_a_range():
    limits = JointLimits(min_position=(0.0, 0.0, 0.0), max_position=(1.0, 1.0, 1.0))
    q = np.array([[-0.9e-9, 1.0 + 0.9e-9, TURN - 0.9e-9], [-1e-6, 1.000001, 0.5]])
    assert whole_turns(q[:1], limits).tolist() == [0.0, 0.0, -TURN]
    assert out_of_range(q[:1] + whole_turns(q[:1], limits), limits).tolist() == [[False] * 3]
    assert out_of_range(q[1:], limits).tolist() == [[True, True, False]]


def test_error_has_digits_enough_to_tell_value_from_limit():
    # Elbow down, the tip behind joint axis 1: a2 cos q2 + d4 sin(q2 + q3) = -0.9 m - 0.7 sin 2 m.
    q = np.array((np.pi / 2 + 1e-8, np.pi, 2.0))
    error = range_error(RobotModel(), JointLimits(), 'via point 3', 0, q, 3)
    assert str(error) == (
        'via point 3: joint_1 would be at 1.57079634 rad (elbow down, shoulder back), '
        'limits 0 to 1.57079633 rad')
    assert (error.joint, error.limit, error.via_point) == ('joint_1', np.pi / 2, 3)
