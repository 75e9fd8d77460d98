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

"""Least durations of transitions, and the largest changes of velocity within given ones."""

import numpy as np
import pytest
from rrr_traj_planner.planners.transitions.transition_law import TransitionLaw


@pytest.mark.parametrize('seed', range(6))
def test_least_times_are_those_of_the_stricter_limit_and_change_most(seed):
    rng = np.random.default_rng(seed)
    law = TransitionLaw(rng.uniform(0.1, 2.0, 3), np.where(rng.random(3) < 0.3, 0.0,
                                                           rng.uniform(0.1, 2.0, 3)))
    change = rng.normal(size=(4, 5, 3)) * 10.0 ** rng.uniform(-4.0, 2.0, (4, 5, 3))
    T = law.least_time(change)
    by_acceleration, by_jerk = law.slope * np.abs(change), law.root * np.sqrt(np.abs(change))
    assert T == pytest.approx(np.maximum(by_acceleration, by_jerk), rel=1e-14)
    assert law.largest_change(T) == pytest.approx(np.abs(change), rel=1e-12)
    assert (law.largest_change(1.01 * T) > np.abs(change)).all()


def test_nothing_changes_in_no_time():
    law = TransitionLaw(np.ones(3), np.array([0.0, 1.0, 2.0]))
    assert law.least_time(np.zeros(3)).tolist() == [0.0] * 3
    assert law.largest_change(np.zeros(3)).tolist() == [0.0] * 3


def test_durations_broadcast_over_the_joints():
    law = TransitionLaw(np.array([1.0, 2.0, 0.5]), np.zeros(3))
    assert law.largest_change(np.array([[1.0], [3.0]])).tolist() == [
        [1.0, 0.5, 2.0], [3.0, 1.5, 6.0]]
