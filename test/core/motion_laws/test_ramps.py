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

"""Ramps against the thesis's function, quadrature of the jerk and dense grids."""

import numpy as np
import pytest
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.motion_laws.cycloid import ramp
from rrr_traj_planner.core.motion_laws.ramps import Ramps, RampShape
from rrr_traj_planner.core.trajectory.piecewise import JointProfile

CRUISES = (0.0, 0.3, 0.6, 0.9)
SEEDS = range(8)
EXACT = {'rel': 1e-12, 'abs': 1e-13}  # rounding

each_cruise = pytest.mark.parametrize('cruise', CRUISES)


def random_ramps(seed, cruise, n=20):
    rng = np.random.default_rng(seed)
    return Ramps(rng.uniform(0.1, 2.0, n), *rng.normal(0.0, 1.0, (4, n)), RampShape(cruise))


def trapezoid(s, cruise):
    """Return a jerk that rises as a quarter of a sine, stays at 1 and falls alike."""
    rise = 0.5 * (1.0 - cruise)
    return np.sin(0.5 * np.pi * np.minimum(1.0, np.minimum(s, 1.0 - s) / rise))


@pytest.mark.parametrize('seed', SEEDS)
def test_without_cruise_it_is_the_thesis_s_half_period(seed):
    found, s = random_ramps(seed, 0.0), np.random.default_rng(seed).uniform(0.0, 1.0, 20)
    thesis = ramp(found.duration, found.position, found.velocity, found.acceleration,
                  found.acceleration + found.rise)
    for value, expected in zip(found.at(s), thesis.at(s)):
        assert value == pytest.approx(expected, **EXACT)
    for value, expected in zip(found.peaks(), thesis.peaks()):
        assert value == pytest.approx(expected, **EXACT)


def test_a_ramp_is_a_half_period_if_nothing_is_said():
    assert RampShape().constant_jerk_fraction == 0.0
    assert RampShape().peak_jerk == pytest.approx(0.5 * np.pi, **EXACT)


@each_cruise
def test_shape_is_the_triple_integral_of_its_jerk(cruise):
    s = np.linspace(0.0, 1.0, 40_001)
    jerk = trapezoid(s, cruise)

    def integral(f):  # Simpson's rule over pairs of intervals
        pairs = (f[:-2:2] + 4.0 * f[1::2] + f[2::2]) * s[1] / 3.0
        return np.concatenate(([0.0], np.cumsum(pairs)))

    whole = integral(jerk)[-1]
    second, first, part, rate = RampShape(cruise)(s)
    assert rate == pytest.approx(jerk / whole, abs=1e-9)
    assert part[::2] == pytest.approx(integral(rate), abs=1e-9)
    assert first[::2] == pytest.approx(integral(part), abs=1e-9)
    assert second[::2] == pytest.approx(integral(first), abs=1e-9)
    assert RampShape(cruise).peak_jerk == pytest.approx(1.0 / whole, rel=1e-9)


@each_cruise
def test_jerk_is_zero_at_both_ends_and_the_gain_whole_at_the_end(cruise):
    start, end = RampShape(cruise)(0.0), RampShape(cruise)(1.0)
    assert [float(x) for x in start] == [0.0] * 4
    assert float(end[1]) == pytest.approx(0.5, **EXACT)  # symmetric
    assert (float(end[2]), float(end[3])) == (1.0, 0.0)


@each_cruise
def test_a_part_is_reached_when_the_shape_says_so(cruise):
    shape, part = RampShape(cruise), np.linspace(0.0, 1.0, 1001)
    assert shape(shape.reached(part))[2] == pytest.approx(part, abs=1e-13)


@each_cruise
@pytest.mark.parametrize('seed', SEEDS)
def test_peaks_and_ranges_are_those_of_a_dense_grid(seed, cruise):
    ramps = random_ramps(seed, cruise)
    for i in range(len(ramps.duration)):
        one = ramps.with_parameters(f[[i]] for f in ramps.parameters().values())
        profile, s = JointProfile(one), np.linspace(0.0, 1.0, 4001)
        q, qd, qdd, qddd = one.at(s)
        acceleration, jerk = one.peaks()
        assert acceleration[0] == pytest.approx(np.abs(qdd).max(), rel=1e-12)
        assert jerk[0] == pytest.approx(np.abs(qddd).max(), rel=1e-6)
        assert jerk[0] >= np.abs(qddd).max() * (1.0 - 1e-12)
        assert profile.peak_velocity == pytest.approx(np.abs(qd).max(), rel=1e-6)
        assert profile.position_range() == pytest.approx((q.min(), q.max()), abs=1e-6)


@each_cruise
def test_a_ramp_between_equal_accelerations_is_constant(cruise):
    one = Ramps(*(np.array([x]) for x in (2.0, 1.0, -1.0, 0.5, 0.0)), RampShape(cruise))
    q, qd, qdd, qddd = one.at(0.5)
    assert [float(x[0]) for x in (q, qd, qdd, qddd)] == pytest.approx([0.25, -0.5, 0.5, 0.0])
    with np.errstate(all='raise'):
        assert one.turning_points().tolist() == [[0.0, 0.0, 1.0]]


@each_cruise
@pytest.mark.parametrize('seed', SEEDS)
def test_velocity_turns_at_the_zero_of_acceleration_else_at_an_end(seed, cruise):
    ramps = random_ramps(seed, cruise)
    start, zero, end = ramps.turning_points().T
    assert (start.tolist(), end.tolist()) == ([0.0] * len(zero), [1.0] * len(zero))
    turns = ramps.acceleration * (ramps.acceleration + ramps.rise) < 0.0
    assert turns.any()
    assert ramps.at(zero)[2][turns] == pytest.approx(0.0, abs=1e-12)
    assert set(zero[~turns]) == {0.0, 1.0}


@each_cruise
def test_stretching_runs_through_the_same_positions(cruise):
    ramps, s = random_ramps(0, cruise), 0.3
    slower = ramps.time_scaled(2.0)
    assert (slower.duration == 2.0 * ramps.duration).all()
    for order, (value, before) in enumerate(zip(slower.at(s), ramps.at(s))):
        assert value == pytest.approx(before / 2.0 ** order, **EXACT)


@pytest.mark.parametrize('cruise', [-0.1, 1.0, np.nan])
def test_a_cruise_that_leaves_no_time_to_rise_is_refused(cruise):
    with pytest.raises(InvalidInputError, match=(
            r'^constant_jerk_fraction is .*, must be in \[0, 1\)$')):
        RampShape(cruise)
