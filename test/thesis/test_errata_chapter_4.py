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

"""Chapter 4 as printed and as corrected: normalised time, transition, cruise."""

from helpers.comparison import differ, rate, ROUNDING
import numpy as np
import pytest
from rrr_traj_planner.core.motion_laws.cycloid import cruise, general_transition, transition

# A transition: duration [s], position [rad], velocities [rad/s].
DURATION, START, V0, V1 = 1.7, 0.4, -0.3, 0.9
A = 1.0 / (2.0 * np.pi)
B = C = DURATION * (V1 - V0)          # 4.7
D, E = DURATION * V0, START - B * A ** 2  # 4.8, 4.9
T = np.linspace(0.0, 1.0, 11)


def position(s):
    """Return 3.7 with normalised time: the position whose derivative 4.3 has to be."""
    return 0.5 * C * s ** 2 + D * s + B * A ** 2 * np.cos(s / A) + E


def test_4_1_runs_from_the_knot_before():
    before, knot, after = 0.3, 0.8, 1.7

    def normalised(t):
        return (t - before) / (knot - before)

    printed = [normalised(t) for t in (after, knot)]  # t in [t_(j+1), t_j]
    assert differ(printed, (0.0, 1.0))
    assert [normalised(t) for t in (before, knot)] == pytest.approx([0.0, 1.0])


def test_rate_of_normalised_time_takes_the_same_knots_as_4_1():
    before, knot, after = 0.3, 0.8, 1.7
    true = rate(lambda t: (t - before) / (knot - before), 0.5)
    assert differ(1.0 / (after - knot), true)
    assert 1.0 / (knot - before) == pytest.approx(true)


def test_boundary_conditions_are_at_normalised_time_1():
    piece = transition(DURATION, START, V0, V1)
    end = (START + 0.5 * DURATION * (V0 + V1), V1)
    at_one_second = piece.at(1.0 / DURATION)[:2]
    assert differ(at_one_second, end)
    assert piece.at(1.0)[:2] == pytest.approx(end, abs=ROUNDING)


def test_continuity_is_of_one_segment_s_end_with_the_next_one_s_start():
    first = transition(DURATION, START, V0, V1)
    second = cruise(0.8, first.at(1.0)[0], V1)
    assert differ(second.at(1.0)[0], first.at(1.0)[0])  # t_(j+1) ends the next segment
    assert second.at(0.0)[:3] == pytest.approx(first.at(1.0)[:3], abs=ROUNDING)


def test_4_3_takes_normalised_time_throughout():
    true = rate(position, T) / DURATION
    printed = (C * (DURATION * T) - B * A * np.sin(T / A) + D) / DURATION
    corrected = (C * T - B * A * np.sin(T / A) + D) / DURATION
    assert differ(printed, true)
    assert corrected == pytest.approx(true, abs=ROUNDING)
    assert transition(DURATION, START, V0, V1).at(T)[1] == pytest.approx(corrected, abs=ROUNDING)


def test_4_6_takes_the_end_acceleration_too():
    start, end, peak = 0.3, 0.5, 1.4  # rad/s^2
    piece = general_transition(0.0, 0.0, 1.0, start, end, peak)
    # The definition: (c - b) at the start, c + b at the peak, c - b cos(1/a) at the end.
    b, c = 0.5 * (peak - start), 0.5 * (peak + start)
    true = (c - end) / b
    assert differ(1.0 - 2.0 * start / (peak - start), true)
    assert 1.0 - 2.0 * (end - start) / (peak - start) == pytest.approx(true, abs=ROUNDING)
    assert np.cos(piece.w) == pytest.approx(true, abs=ROUNDING)
    assert float(piece.at(1.0)[2]) == pytest.approx(end, abs=ROUNDING)


def test_4_6_has_its_sign_lost_where_the_end_acceleration_is_0():
    start, peak = -0.3, 1.4
    piece = general_transition(0.0, 0.0, 1.0, start, 0.0, peak)
    printed, corrected = (1.0 + sign * 2.0 * start / (peak - start) for sign in (-1.0, 1.0))
    assert printed > 1.0  # no cosine
    assert np.cos(piece.w) == pytest.approx(corrected, abs=ROUNDING)
    assert float(piece.at(1.0)[2]) == pytest.approx(0.0, abs=ROUNDING)


def test_4_7_holds_for_a_start_without_acceleration_alone():
    start, peak = 0.3, 1.4
    piece = general_transition(0.0, V0, V1, start, 0.5, peak)
    printed = piece.duration * (V1 - V0)
    for ours, corrected in ((piece.b, 0.5 * (peak - start)), (piece.c, 0.5 * (peak + start))):
        assert differ(ours * piece.duration ** 2, printed)
        assert ours == pytest.approx(corrected, abs=ROUNDING)
    assert float(piece.at(0.0)[2]) == pytest.approx(start, abs=ROUNDING)
    plain = general_transition(0.0, V0, V1, 0.0, 0.0, peak)
    for ours in (plain.b, plain.c):
        assert ours * plain.duration == pytest.approx(V1 - V0, abs=ROUNDING)


@pytest.mark.parametrize(('v0', 'v1'), [(0.2, 1.0), (1.0, -0.6)])
def test_4_10_takes_the_modulus(v0, v1):
    largest = 1.5
    corrected = 2.0 * abs(v1 - v0) / largest
    assert float(transition(corrected, 0.0, v0, v1).at(0.5)[2]) == pytest.approx(
        np.sign(v1 - v0) * largest, abs=ROUNDING)
    printed = 2.0 * (v0 - v1) / largest
    assert (printed < 0.0) == (v1 > v0)  # no duration where the joint speeds up


def test_4_11_with_4_12_takes_normalised_time():
    duration, offset = 0.8, 0.6
    slope = V1 * duration  # 4.12
    t = np.linspace(0.0, duration, 5)
    true = cruise(duration, offset, V1).at(t / duration)
    assert differ(slope * t + offset, offset + V1 * t)
    assert slope * (t / duration) + offset == pytest.approx(offset + V1 * t, abs=ROUNDING)
    assert true[0] == pytest.approx(offset + V1 * t, abs=ROUNDING)


def test_4_13_starts_from_the_position_not_its_rate():
    end = position(1.0)
    assert differ(D + 0.5 * C + V0, end)
    assert D + 0.5 * C + START == pytest.approx(end, abs=ROUNDING)
    assert float(transition(DURATION, START, V0, V1).at(1.0)[0]) == pytest.approx(
        end, abs=ROUNDING)
