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

"""Cycloid transitions between accelerations that are not zero: the corrected 4.6."""

from helpers.random_cases import random_general_transition
import numpy as np
import pytest
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.motion_laws.cycloid import general_transition, ramp, transition

# Values are of the order of 1 to 100.
ROUNDING = 1e-12
# A peak between two of 20,001 samples differs from theirs by (pi / 20,000)^2 / 2 at most.
DENSE = np.linspace(0.0, 1.0, 20001)
BETWEEN_SAMPLES = 2e-8


def test_general_transition_meets_its_accelerations_velocities_and_peak():
    rng = np.random.default_rng(64)
    for _ in range(300):
        piece, ends = random_general_transition(rng)
        start, end = piece.at(0.0), piece.at(1.0)
        assert start[:3] == pytest.approx(
            (ends['position'], ends['velocity'], ends['start_acceleration']), abs=ROUNDING)
        assert end[1:3] == pytest.approx(
            (ends['end_velocity'], ends['end_acceleration']), abs=ROUNDING)
        acceleration = np.sign(ends['peak_acceleration']) * piece.at(DENSE)[2]
        peak = abs(ends['peak_acceleration'])
        assert acceleration.max() <= peak + ROUNDING
        assert acceleration.max() == pytest.approx(peak, rel=BETWEEN_SAMPLES * 10)


def test_general_transition_s_phase_is_4_6_corrected():
    # cos(1/a) = 1 - 2 (end - start) / (peak - start), past the peak: 1/a in [pi, 2 pi].
    rng = np.random.default_rng(65)
    for _ in range(100):
        piece, ends = random_general_transition(rng)
        start = ends['start_acceleration']
        fraction = (ends['end_acceleration'] - start) / (ends['peak_acceleration'] - start)
        assert np.cos(piece.w) == pytest.approx(1.0 - 2.0 * fraction, abs=ROUNDING)
        assert np.pi <= piece.w <= 2.0 * np.pi


def test_general_transition_between_equal_accelerations_is_a_full_period():
    rng = np.random.default_rng(66)
    for _ in range(50):
        piece, ends = random_general_transition(rng, fraction=0.0)
        mean = 0.5 * (ends['start_acceleration'] + ends['peak_acceleration'])
        assert piece.w == 2.0 * np.pi
        assert piece.duration == pytest.approx(
            (ends['end_velocity'] - ends['velocity']) / mean, rel=1e-12)
        assert piece.at(1.0)[2] == pytest.approx(ends['start_acceleration'], abs=ROUNDING)


def test_general_transition_from_rest_to_rest_of_acceleration_is_the_plain_one():
    piece = general_transition(0.3, -0.2, 0.7, 0.0, 0.0, 1.5)
    plain = transition(2.0 * 0.9 / 1.5, 0.3, -0.2, 0.7)
    assert list(piece) == pytest.approx(list(plain), abs=ROUNDING)


def test_general_transition_that_ends_at_its_peak_is_a_ramp():
    for sign in (-1.0, 1.0):
        piece = general_transition(0.3, -0.2, -0.2 + sign * 0.9, sign * 0.25, sign * 1.5,
                                   sign * 1.5)
        half_period = ramp(0.9 / (0.5 * (0.25 + 1.5)), 0.3, -0.2, sign * 0.25, sign * 1.5)
        assert piece.w == np.pi
        assert list(piece) == pytest.approx(list(half_period), abs=ROUNDING)


@pytest.mark.parametrize(('start', 'end', 'peak'), [
    (0.5, 1.0, 0.8),      # the end beyond the peak
    (-0.5, -1.0, -0.8),
    (0.5, 0.2, 1.0),      # the end behind the start
    (0.5, 1.0, 0.2),      # the peak on the other side
    (0.5, 0.5, 0.5)])     # no peak
def test_end_acceleration_that_the_function_never_takes_is_refused(start, end, peak):
    text = (rf'^end acceleration {end} rad/s\^2 must lie between the start, {start} rad/s\^2, '
            rf'and the peak beyond it, {peak} rad/s\^2$')
    with pytest.raises(InvalidInputError, match=text):
        general_transition(0.0, 0.0, 1.0, start, end, peak)


@pytest.mark.parametrize('end_velocity', [-0.5, 0.5])
def test_change_of_velocity_against_the_accelerations_is_refused(end_velocity):
    with pytest.raises(InvalidInputError, match=(
            r'^a change of velocity of -?[\d.]+ rad/s has no transition of mean acceleration '
            r'0\.75 rad/s\^2$')):
        general_transition(0.0, 0.5, end_velocity, 0.0, 0.0, 1.5)
