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

"""Residual vibration: closed forms of pulses, the mode's equation integrated, laws."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.motion_laws.cycloid_transitions import CYCLOID
from rrr_traj_planner.core.trajectory.residual_vibration import residual_vibration

ROUNDING = 1e-8  # of the largest acceleration: the quadrature of smooth pieces
MODES = (8.0, 16.0, 32.0, 64.0)


def motion_of(acceleration):
    """Return a motion of which the acceleration alone is known, shape (n, joints)."""
    def motion(t):
        nothing = np.full((len(t), 1), np.nan)
        return nothing, nothing, acceleration(t[:, np.newaxis]), nothing
    return motion


@pytest.mark.parametrize('seed', range(5))
def test_rectangular_pulse_leaves_twice_the_sine_of_half_its_phase(seed):
    rng = np.random.default_rng(seed)
    height, length = rng.uniform(-3.0, 3.0, 3), rng.uniform(0.05, 2.0)
    f = rng.uniform(1.0, 80.0, 7)
    found = residual_vibration(
        motion_of(lambda t: height + 0.0 * t), [0.3, 0.3 + length], f, damping=0.0)
    # w times the Fourier transform, |a sin(w T / 2) / (w / 2)|
    expected = 2.0 * np.abs(np.outer(np.sin(pi * f * length), height))
    assert found == pytest.approx(expected, abs=3.0 * ROUNDING)


@pytest.mark.parametrize('seed', range(5))
def test_cycloid_leaves_its_fourier_transform(seed):
    rng = np.random.default_rng(seed)
    length, change = rng.uniform(0.1, 2.0), rng.uniform(0.1, 2.0)
    f = rng.uniform(1.0, 80.0, 7)
    piece = CYCLOID.transition(length, 0.0, 0.3, 0.3 + change)
    found = residual_vibration(
        motion_of(lambda t: piece.at(t / length)[2]), [0.0, length], f, damping=0.0)
    # w times the transform of (change / T) (1 - cos(w0 t)), w0 = 2 pi / T
    x = (f * length) ** 2
    expected = 2.0 * change / length * np.abs(np.sin(pi * f * length) / (1.0 - x))
    peak = 2.0 * change / length
    assert found[:, 0] == pytest.approx(expected, abs=peak * ROUNDING)


def test_damped_pulse_swings_to_its_first_extremum():
    """A push so short that it is a change of speed: y = -exp(-z w x) sin(s w x) dv / (s w)."""
    z, f, width, change = 0.1, 2.0, 1e-6, 0.7
    found = residual_vibration(
        motion_of(lambda t: change / width + 0.0 * t), [0.0, width], [f], z)[0, 0]
    s, w = np.sqrt(1.0 - z * z), 2.0 * pi * f
    x = np.arctan2(s, z) / (s * w)  # where tan(s w x) = s / z
    expected = w * change / s * np.exp(-z * w * x) * np.sin(s * w * x)
    assert found == pytest.approx(expected, rel=1e-5)  # width over period


def test_what_damping_has_ended_is_not_looked_at():
    """A week of motion costs no more than the last minutes, in which the modes forget."""
    week, seen = 604_800.0, []

    def late(t):
        seen.append(t.min())
        return np.where(t > week - 1.0, np.sin(pi * (week - t)) ** 2, 0.0)

    found = residual_vibration(motion_of(late), [0.0, week - 1.0, week], [8.0, 16.0])
    assert found == pytest.approx(residual_vibration(
        motion_of(lambda t: np.sin(pi * t) ** 2), [0.0, 1.0], [8.0, 16.0]), abs=ROUNDING)
    assert week - min(seen) < 100.0


def test_a_motion_of_no_length_leaves_nothing():
    for knots in ([1.0], [1.0, 1.0]):
        assert residual_vibration(motion_of(np.ones_like), knots, MODES).max() == 0.0


@pytest.mark.parametrize(('knots', 'frequencies', 'damping', 'text'), [
    ([], [1.0], 0.01, 'knots must be at least one and never decrease'),
    ([0.0, 2.0, 1.0], [1.0], 0.01, 'knots must be at least one and never decrease'),
    ([0.0, 1.0], [], 0.01, 'frequencies must be at least one, and positive'),
    ([0.0, 1.0], [8.0, 0.0], 0.01, 'frequencies must be at least one, and positive'),
    ([0.0, 1.0], [np.nan], 0.01, 'frequencies'),
    ([0.0, 1.0], [1.0], -0.1, 'damping is -0.1'),
    ([0.0, 1.0], [1.0], 1.0, 'damping is 1, must be below 1')])
def test_wrong_arguments_are_refused(knots, frequencies, damping, text):
    with pytest.raises(InvalidInputError, match=text):
        residual_vibration(motion_of(np.ones_like), knots, frequencies, damping)
