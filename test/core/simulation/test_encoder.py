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

"""What encoders tell: steps, noise of the right size, velocities without bias."""

from __future__ import annotations

from math import inf, nan

import numpy as np
import pytest
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.simulation.encoder import Encoder, EncoderSettings

STEP = 1e-3
AT_REST = (0.5, 1.1, -0.2, 0.0, 0.0, 0.0)


def readings(settings, states):
    encoder = Encoder(settings, STEP, states[0])
    return np.array([encoder.measured, *(encoder.read(state) for state in states[1:])])


def steady(rate, n=3000):
    return [(0.5 + rate * i * STEP, 1.1, -0.2, rate, 0.0, 0.0) for i in range(n)]


def test_positions_come_in_multiples_of_the_resolution():
    resolution = 2.0 ** -10
    seen = readings(EncoderSettings(resolution=resolution), steady(0.3))
    q = np.array(steady(0.3))[:, :3]
    assert (seen[:, :3] % resolution == 0.0).all()
    assert np.abs(seen[:, :3] - q).max() <= 0.5 * resolution


def test_noise_has_its_standard_deviation_and_no_bias():
    n, sigma = 3000, 1e-3
    error = readings(EncoderSettings(noise=sigma), [AT_REST] * n)[:, :3] - AT_REST[:3]
    assert np.std(error) == pytest.approx(sigma, rel=0.05)  # 9000 values: 0.7 %
    assert abs(np.mean(error)) < 5.0 * sigma / np.sqrt(3 * n)


def test_a_seed_gives_its_noise_again_and_another_seed_another():
    runs = [readings(EncoderSettings(noise=1e-3, seed=seed), [AT_REST] * 50)
            for seed in (7, 7, 8)]
    np.testing.assert_array_equal(runs[0], runs[1])
    assert (runs[0][:, :3] != runs[2][:, :3]).all()


def test_steady_velocity_is_seen_without_bias():
    seen = readings(EncoderSettings(noise=1e-12), steady(0.7))
    np.testing.assert_allclose(seen[500:, 3], 0.7, atol=1e-8)
    started = readings(EncoderSettings(noise=1e-12), [AT_REST, *steady(0.7)[1:]])
    np.testing.assert_allclose(started[500:, 3], 0.7, atol=1e-8)


@pytest.mark.parametrize('bandwidth', [100.0, 250.0])
def test_a_step_of_the_resolution_is_seen_as_a_velocity_of_that_times_bandwidth_over_e(bandwidth):
    # The loop's answer to a step r is r b^2 t exp(-b t), largest at t = 1 / b.
    r = 1e-4
    states = [(k * r, 0.0, 0.0, 0.0, 0.0, 0.0) for k in [0] * 10 + [1] * 300]
    seen = readings(EncoderSettings(resolution=r, bandwidth=bandwidth), states)
    assert np.abs(seen[:, 3]).max() == pytest.approx(r * bandwidth / np.e, rel=0.02)
    assert EncoderSettings().bandwidth * r / np.e < 0.01  # rad/s: at rest, to the planner


def test_velocity_lags_an_acceleration_by_twice_the_inverse_bandwidth():
    a, bandwidth = 2.0, 300.0
    states = [(0.5 * a * (i * STEP) ** 2, 0.0, 0.0, a * i * STEP, 0.0, 0.0) for i in range(1500)]
    seen = readings(EncoderSettings(noise=1e-15, bandwidth=bandwidth), states)
    lag = states[-1][3] - seen[-1, 3]
    assert lag == pytest.approx(2.0 * a / bandwidth, rel=0.2)  # sampled: half a step less


def test_restart_forgets_what_was_tracked():
    encoder = Encoder(EncoderSettings(noise=1e-12), STEP, steady(0.7)[0])
    for state in steady(0.7)[1:]:
        encoder.read(state)
    encoder.restart(AT_REST)
    np.testing.assert_allclose(encoder.read(AT_REST), AT_REST, atol=1e-8)


@pytest.mark.parametrize(('field', 'value', 'text'), [
    ('resolution', -1.0, r'^resolution is -1.0 rad, must not be negative'),
    ('noise', nan, r'^noise is nan rad'), ('bandwidth', inf, r'^bandwidth is inf'),
    ('bandwidth', 0.0, r'^bandwidth is 0.0 rad/s, must be positive')])
def test_settings_without_sense_are_refused(field, value, text):
    with pytest.raises(InvalidInputError, match=text):
        EncoderSettings(**{field: value})
