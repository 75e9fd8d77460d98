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

"""The time of a change of velocity, against values by hand."""

import numpy as np
import pytest
from rrr_traj_planner.core.kinematics.travel_time import ramp_time


@pytest.mark.parametrize(('change', 'acceleration', 'jerk', 'expected'), [
    (0.5, 1.0, 10.0, 0.6),          # acceleration rises for 0.1 s, stays for 0.4 s, falls
    (0.1, 1.0, 10.0, 0.2),          # and only just reaches its limit
    (0.025, 1.0, 10.0, 0.1),        # rises and falls for 0.05 s each, to 0.5 rad/s^2
    (0.025, np.inf, 10.0, 0.1),
    (0.0, 1.0, 10.0, 0.0)])
def test_a_ramp_takes_the_time_of_its_phases(change, acceleration, jerk, expected):
    found = ramp_time(*map(np.array, (change, acceleration, jerk)))
    assert found == pytest.approx(expected, abs=1e-15)
