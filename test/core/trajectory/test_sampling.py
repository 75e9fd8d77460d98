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

"""The points of a message: every rule that a controller or a client relies on."""

from helpers.random_cases import joined, random_trajectory
import numpy as np
import pytest
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.motion_laws.cycloid import cruise, transition
from rrr_traj_planner.core.motion_laws.polynomial_piece import PolynomialPiece
from rrr_traj_planner.core.trajectory.joint_profile import JointProfile
from rrr_traj_planner.core.trajectory.piecewise import PiecewiseTrajectory
from rrr_traj_planner.core.trajectory.quintic_spline import spline_through, spline_where_divided
from rrr_traj_planner.core.trajectory.sampling import (
    points_at,
    sample,
    sample_times,
    with_states_at,
)

# Times are rounded to whole nanoseconds, by half of one at most.
NANOSECOND = 1e-9
HALF = 0.51 * NANOSECOND


def random_case(seed):
    """Return a motion and a period, some via points close to a regular sample's time."""
    rng = np.random.default_rng(3000 + seed)
    duration = rng.uniform(0.3, 4.0)
    period = rng.choice([0.001, 0.01, 0.0123456789, 0.05, 1.0 / 3.0])
    near = period * rng.integers(0, int(duration / period) + 1, 6)
    near += rng.choice([-1.0, 1.0], 6) * period * rng.choice([0.0, 0.099, 0.101, 0.3, 1e-9], 6)
    via_times = np.sort(np.clip(near, 0.0, duration))
    via_times = np.concatenate(([0.0], via_times, [duration]))
    return random_trajectory(rng, duration, via_times), period


CASES = [random_case(seed) for seed in range(20)]


def nanoseconds(points):
    """Return times as whole nanoseconds, having checked that they are."""
    counts = points.times / NANOSECOND
    whole = np.round(counts)
    assert np.abs(counts - whole).max() <= 1e-5  # rounding of a double of some seconds
    return whole.astype(np.int64)


@pytest.mark.parametrize(('trajectory', 'period'), CASES)
def test_times_are_whole_nanoseconds_strictly_increasing_from_zero_to_the_end(trajectory, period):
    stamps = nanoseconds(sample(trajectory, period))
    assert (np.diff(stamps) > 0).all()
    assert stamps[0] == 0
    assert stamps[-1] * NANOSECOND == pytest.approx(trajectory.duration, abs=HALF)


@pytest.mark.parametrize(('trajectory', 'period'), CASES)
def test_one_point_stands_exactly_at_every_via_point(trajectory, period):
    points = sample(trajectory, period)
    stamps = nanoseconds(points)
    # Via points less than 1.5 ns apart share one; velocities are of a few rad/s.
    apart = np.diff(trajectory.via_times)
    tolerance = 1e-8 if ((apart > 0.0) & (apart < 1.5e-9)).any() else 1e-14
    for via_time, position in zip(trajectory.via_times, trajectory(trajectory.via_times)[0]):
        at = np.abs(stamps - via_time / NANOSECOND) <= 2.01
        assert at.sum() == 1
        assert points.positions[at][0] == pytest.approx(position, abs=tolerance)


@pytest.mark.parametrize(('trajectory', 'period'), CASES)
def test_no_regular_point_is_nearer_to_another_than_a_tenth_of_the_period(trajectory, period):
    stamps = nanoseconds(sample(trajectory, period)) * NANOSECOND
    fixed = np.concatenate(([0.0], trajectory.via_times, [trajectory.duration]))
    distances = np.abs(stamps[:, np.newaxis] - fixed)
    regular = distances.min(axis=1) > 2.0 * NANOSECOND
    assert (distances[regular] >= 0.1 * period - 2.0 * NANOSECOND).all()
    assert (np.diff(stamps[regular]) >= period - 2.0 * NANOSECOND).all()


@pytest.mark.parametrize(('trajectory', 'period'), CASES)
def test_a_point_stands_at_every_period_that_is_not_near_a_via_point(trajectory, period):
    stamps = nanoseconds(sample(trajectory, period))
    fixed = np.concatenate(([0.0], trajectory.via_times, [trajectory.duration]))
    wanted = period * np.arange(1, int(np.ceil(trajectory.duration / period)))
    gaps = np.abs(wanted[:, np.newaxis] - fixed).min(axis=1)
    # dropped: nearer than a tenth of a period, or half a millisecond where that is half of one
    least = max(0.1 * period, min(0.5 * period, 5e-4))
    wanted = wanted[gaps >= least + 2.0 * NANOSECOND]
    assert np.isin(np.round(wanted / NANOSECOND).astype(np.int64), stamps).all()


@pytest.mark.parametrize(('trajectory', 'period'), CASES)
def test_motion_starts_and_ends_exactly_at_rest_at_its_positions(trajectory, period):
    points = sample(trajectory, period)
    for derivative in (points.velocities, points.accelerations):
        assert derivative[[0, -1]].tolist() == [[0.0] * 3] * 2
    assert points.positions[0].tolist() == trajectory(0.0)[0].tolist()
    assert points.positions[-1].tolist() == trajectory(trajectory.duration)[0].tolist()


@pytest.mark.parametrize(('trajectory', 'period'), CASES)
def test_points_are_states_of_the_motion_at_their_times(trajectory, period):
    points = sample(trajectory, period)
    # Within a nanosecond velocity, acceleration and jerk of the motion move it so far at most.
    peaks = trajectory.peaks()
    for values, expected, rate in zip(
            (points.positions, points.velocities, points.accelerations), trajectory(points.times),
            (peaks.velocity, peaks.acceleration, peaks.jerk)):
        assert (np.abs(values - expected) <= 1e-9 * rate + 1e-12).all()


def test_rounding_at_the_start_is_removed():
    profile = JointProfile(joined([transition(1.0, 0.0, 1e-17, 1.0),
                                   transition(1.0, 0.5, 1.0, 0.0)]))
    points = sample(PiecewiseTrajectory([profile] * 3, [0.0, 2.0]), 0.5)
    assert points.velocities[0].tolist() == [0.0, 0.0, 0.0]


def test_exact_times_are_the_motion_s_own_and_stamps_their_nanoseconds():
    for trajectory, period in CASES:
        exact, stamps = sample_times(trajectory, period)
        assert len(exact) == len(stamps)
        assert (np.diff(exact) > 0.0).all()
        assert np.abs(exact - stamps * NANOSECOND).max() <= HALF * 2.0
        assert np.isin(trajectory.duration, exact)


def cruising(via_time, duration=3.0):
    """Return a motion at 1 rad/s between its transitions, with a via point between them."""
    profile = JointProfile(joined([
        transition(1.0, 0.0, 0.0, 1.0), cruise(duration - 2.0, 0.5, 1.0),
        transition(1.0, duration - 1.5, 1.0, 0.0)]))
    return PiecewiseTrajectory([profile] * 3, [0.0, via_time, duration])


@pytest.mark.parametrize('period', [0.001, 1.0 / 900.0, 0.01])
def test_rounding_of_times_puts_no_acceleration_into_a_controller_s_quintic(period):
    # A via point 0.5 ns off a whole nanosecond, a tenth of a period after a regular point: were
    # the two not rounded together, the quintic between them would need 0.003 to 0.3 rad/s^2.
    regular = 1.5 - 1.5 % period
    trajectory = cruising(round(regular + 0.1001 * period, 9) + 0.4999e-9)
    quintic = spline_through(sample(trajectory, period))
    t = np.linspace(regular - 8.0 * period, regular + 8.0 * period, 16001)
    assert np.abs(quintic.at(t)[2]).max() <= 1e-4


@pytest.mark.parametrize('seed', range(10))
def test_quintic_through_the_points_stays_within_the_motion_s_peaks(seed):
    # The promise of 0.1 %, for motions whose pieces last some ten periods or more.
    rng = np.random.default_rng(4000 + seed)
    trajectory = random_trajectory(rng, duration=rng.uniform(3.0, 6.0))
    shortest = min(p.pieces.duration.min() for p in trajectory.profiles)
    points = sample(trajectory, min(0.01, shortest / 10.0))
    quintic = spline_through(points)
    peaks = trajectory.peaks()
    t = np.linspace(0.0, trajectory.duration, 20 * len(points.times))
    q, qd, qdd, _ = quintic.at(t)
    assert (np.abs(qd).max(axis=0) <= peaks.velocity * 1.001).all()
    assert (np.abs(qdd).max(axis=0) <= peaks.acceleration * 1.001).all()
    assert q == pytest.approx(trajectory(t)[0], abs=1e-6)


def test_a_motion_shorter_than_a_period_has_its_ends_and_via_points():
    points = sample(cruising(1.25), 10.0)
    assert points.times == pytest.approx([0.0, 1.25, 3.0], abs=1e-12)


def test_via_points_at_the_ends_add_no_points():
    points = sample(cruising(3.0), 1.0)
    assert points.times == pytest.approx([0.0, 1.0, 2.0, 3.0], abs=1e-12)
    assert sample(cruising(0.0), 1.0).times == pytest.approx([0.0, 1.0, 2.0, 3.0], abs=1e-12)


def test_regular_point_is_left_out_within_a_tenth_of_the_period_of_a_via_point():
    assert sample(cruising(1.04), 0.5).times == pytest.approx(
        [0.0, 0.5, 1.04, 1.5, 2.0, 2.5, 3.0], abs=1e-12)
    assert sample(cruising(1.06), 0.5).times == pytest.approx(
        [0.0, 0.5, 1.0, 1.06, 1.5, 2.0, 2.5, 3.0], abs=1e-12)


def test_regular_point_is_left_out_beside_the_end_too():
    assert sample(cruising(1.5, duration=3.04), 0.5).times[-2:] == pytest.approx(
        [2.5, 3.04], abs=1e-12)


class Bent(PiecewiseTrajectory):
    """From rest with a jerk of 1 rad/s^3, which turns to -1 at given times, and so on."""

    def __init__(self, bends, duration):
        pieces, state = [], (0.0, 0.0, 0.0)
        for k, h in enumerate(np.diff([0.0, *bends, duration])):
            pieces.append(PolynomialPiece(h, *state, (-1.0) ** k, 0.0))
            state = pieces[-1].at(1.0)[:3]
        profile = JointProfile(PolynomialPiece(*map(np.array, zip(*pieces))))
        super().__init__([profile] * 3, [0.0, duration])
        self._bends = bends

    @property
    def jerk_step_times(self):
        return self._bends


def test_a_point_stands_where_jerk_steps_unless_a_tenth_of_the_period_from_another():
    bends = np.array([0.03, 0.61, 1.34, 1.36, 2.98])
    assert sample(Bent(bends, 3.0), 0.5).times == pytest.approx(
        [0.0, 0.5, 0.61, 1.0, 1.34, 1.5, 2.0, 2.5, 3.0], abs=1e-12)


def test_quintics_beside_a_step_of_jerk_keep_to_the_jerk_on_both_sides():
    # Across it a quintic would overshoot by up to 0.37 of the step of 2 rad/s^3.
    bend = 1.0 + 0.645 * 0.1
    quintic = spline_through(sample(Bent(np.array([bend]), 3.0), 0.1))
    t = np.linspace(0.05, 2.85, 20001)  # the end is not at rest, but set so
    jerk = quintic.at(t)[3]
    assert np.abs(jerk).max() <= 1.0 + 1e-6


@pytest.mark.parametrize('period', [0.0, -0.01, np.nan, np.inf])
def test_impossible_period_is_refused(period):
    with pytest.raises(InvalidInputError, match=f'^period is {period} s, must be (pos|fin)it'):
        sample(cruising(1.5), period)


@pytest.mark.parametrize('period', [0.05, 0.1, 0.25, 0.3, 1.0, 7.0])
def test_bound_on_points_is_met_exactly(period):
    trajectory = cruising(1.23, duration=3.04)
    size = len(sample(trajectory, period).times)
    assert len(sample(trajectory, period, size).times) == size
    with pytest.raises(InvalidInputError, match=f'has more than {size - 1} points'):
        sample(trajectory, period, size - 1)


def test_more_points_than_memory_holds_are_refused_before_they_are_made():
    trajectory = cruising(1.0, duration=1e9)
    with pytest.raises(InvalidInputError, match='has more than 200000 points'):
        sample(trajectory, 0.01)


@pytest.mark.parametrize(('trajectory', 'period'), CASES)
def test_points_added_between_are_those_of_all_times_together(trajectory, period):
    times = sample_times(trajectory, period)
    rng = np.random.default_rng(len(times.stamps))
    width = np.diff(times.stamps)
    index = np.flatnonzero((width > 10.0) & (rng.random(len(width)) < 0.4))
    cuts = (times.stamps[index] + rng.uniform(0.3, 0.7, len(index)) * width[index]) * NANOSECOND
    together, further = times.divided(index, cuts)
    assert (np.diff(together.stamps) > 0.0).all()
    assert (np.diff(together.exact) > 0.0).all()
    assert set(together.stamps) == {*times.stamps, *further.stamps}
    assert np.abs(together.exact - together.stamps * NANOSECOND).max() <= HALF
    found = with_states_at(points_at(trajectory, times), trajectory, further, index + 1)
    expected = points_at(trajectory, together)
    for name in ('times', 'positions', 'velocities', 'accelerations'):
        assert getattr(found, name) == pytest.approx(getattr(expected, name), rel=1e-13, abs=1e-13)
    spline = spline_where_divided(spline_through(points_at(trajectory, times)), found, index)
    assert (spline.coefficients == spline_through(found).coefficients).all()


@pytest.mark.parametrize('apart', [1e-5, 1e-4, 2e-3])
def test_rounded_times_of_points_close_together_do_not_change_the_acceleration_between(apart):
    first = 0.5 + 0.4e-9  # rounded down; the second one up
    steady = JointProfile(cruise(np.array([1.0]), np.array([0.2]), np.array([1.0])))
    motion = PiecewiseTrajectory([steady] * 3, [0.0, first, first + apart + 0.2e-9, 1.0])
    points = sample(motion, 0.01)
    k = int(np.abs(points.times - 0.5).argmin())
    assert points.times[k + 1] - points.times[k] == pytest.approx(apart, abs=1.5e-9)
    between = spline_through(points).within([0.2, 0.5, 0.8], np.array([k]))
    assert between[2] == pytest.approx(0.0, abs=1e-3)
    assert points.positions[[k, k + 1]] == pytest.approx(
        motion(motion.via_times[1:3])[0], abs=1.5e-9)
