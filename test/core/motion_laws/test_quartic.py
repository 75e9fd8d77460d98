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

"""Paul's transition against 6.5 to 6.8."""

import numpy as np
import pytest
from rrr_traj_planner.core.motion_laws.quartic import QUARTIC

CASES = [(0.5, 1.3, -0.35, 0.8, 0.6), (0.2, 0.4, 0.1, 0.3, -1.0)]  # t_acc, T1, dB, dC, B


@pytest.mark.parametrize('case', CASES)
def test_transition_is_6_5_to_6_8(case):
    t_acc, T1, dB, dC, B = case
    h = np.linspace(0.0, 1.0, 21)
    change = dC * t_acc / T1 + dB
    expected = ((change * (2.0 - h) * h ** 2 - 2.0 * dB) * h + B + dB,
                (change * (1.5 - h) * 2.0 * h ** 2 - dB) / t_acc,
                change * (1.0 - h) * 3.0 * h / t_acc ** 2,
                change * (1.0 - 2.0 * h) * 3.0 / (2.0 * t_acc ** 3))
    # It starts at A = B + dB, t_acc before the via point, with the velocity of the line from A.
    ours = QUARTIC.transition(2.0 * t_acc, B + dB, -dB / t_acc, dC / T1).at(h)
    for values, printed in zip(ours, expected):
        assert values == pytest.approx(printed, abs=1e-12)


def test_position_is_of_fourth_order():
    s = np.linspace(0.0, 1.0, 6)
    fifth_differences = np.diff(QUARTIC.position(s), n=5)
    assert fifth_differences == pytest.approx([0.0], abs=1e-14)
    assert abs(np.diff(QUARTIC.position(s), n=4)).min() > 1e-3


def test_jerk_steps_at_the_ends_where_it_is_largest():
    assert QUARTIC.jerk(0.0) == QUARTIC.peak_jerk == 6.0
    assert QUARTIC.jerk(1.0) == -6.0
