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

"""Trajectories of cycloid pieces: evaluation, exact extremes, stretching, refusals."""

from helpers.random_cases import dense_times, joined, random_pieces, random_trajectory
import numpy as np
import pytest
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.motion_laws.cycloid import cruise, CycloidPiece, ramp, transition
from rrr_traj_planner.core.trajectory.joint_profile import JointProfile
from rrr_traj_planner.core.trajectory.piecewise import PiecewiseTrajectory

ROUNDING = 1e-12
# A parabola between samples of a two-thousandth of a piece: (pi / 2,000)^2 / 2.
SAMPLES_PER_PIECE = 2000
BETWEEN_SAMPLES = 1.3e-6
CASES = range(12)


def trajectory_of(seed):
    return random_trajectory(np.random.default_rng(seed))


def single(*pieces):
    """Return a trajectory whose three joints move alike."""
    profile = JointProfile(joined(pieces))
    return PiecewiseTrajectory([profile] * 3, [0.0, profile.duration])


def test_profile_is_its_pieces_one_after_the_other():
    rng = np.random.default_rng(81)
    durations = rng.uniform(0.1, 1.0, 6)
    pieces = random_pieces(rng, durations)
    profile = JointProfile(pieces)
    assert profile.duration == pytest.approx(durations.sum(), abs=ROUNDING)
    for i, start in enumerate(np.concatenate(([0.0], np.cumsum(durations)[:-1]))):
        piece = CycloidPiece(*(field[i] for field in pieces))
        s = rng.uniform(0.0, 1.0, 20)
        for ours, expected in zip(profile(start + s * durations[i]), piece.at(s)):
            assert ours == pytest.approx(expected, abs=1e-10)


def test_joints_of_a_trajectory_are_its_profiles():
    trajectory = trajectory_of(82)
    t = np.linspace(0.0, trajectory.duration, 50)[:-1]
    for order, values in enumerate(trajectory(t)):
        assert values.shape == (50 - 1, 3)
        for j, profile in enumerate(trajectory.profiles):
            assert (values[:, j] == profile(t)[order]).all()


def test_one_time_gives_what_many_give():
    trajectory = trajectory_of(83)
    t = np.linspace(-0.1, trajectory.duration + 0.1, 12)
    at_once = trajectory(t)
    for i, time in enumerate(t):
        for several, one in zip(at_once, trajectory(time)):
            assert one.shape == (3,)
            assert one == pytest.approx(several[i], abs=1e-15)


def test_no_times_give_no_values():
    assert [v.shape for v in trajectory_of(83)(np.array([]))] == [(0, 3)] * 4


def test_at_a_knot_the_piece_that_begins_there_counts():
    # Acceleration steps from 1 to -2 rad/s^2 at t = 0.5 s.
    first = ramp(0.5, 0.0, 0.0, 0.0, 1.0)
    second = ramp(0.5, *first.at(1.0)[:2], -2.0, 0.0)
    trajectory = single(first, second)
    assert trajectory(0.5)[2] == pytest.approx([-2.0] * 3, abs=ROUNDING)
    assert trajectory(np.nextafter(0.5, 0.0))[2] == pytest.approx([1.0] * 3, abs=ROUNDING)


@pytest.mark.parametrize('seed', CASES)
def test_position_velocity_and_acceleration_are_continuous_at_joins(seed):
    trajectory = trajectory_of(seed)
    knots = trajectory.knots[1:-1]
    before, after = trajectory(knots - 1e-12), trajectory(knots + 1e-12)
    for order in range(3):
        # Within 2e-12 s a jerk of up to 1e3 rad/s^3 changes acceleration by 2e-9.
        assert before[order] == pytest.approx(after[order], abs=1e-8)


def test_arm_rests_before_the_start_and_after_the_end():
    # The motion itself begins and ends at 0.5 and 1.5 rad/s.
    trajectory = single(transition(2.0, 1.0, 0.5, 1.5))
    for t, position in ((-1e-9, 1.0), (-10.0, 1.0), (2.0, 3.0), (50.0, 3.0)):
        q, qd, qdd, qddd = trajectory(t)
        assert q == pytest.approx([position] * 3, abs=1e-15)
        for derivative in (qd, qdd, qddd):
            assert derivative.tolist() == [0.0, 0.0, 0.0]
    assert trajectory(0.0)[1].tolist() == [0.5, 0.5, 0.5]


@pytest.mark.parametrize('seed', CASES)
def test_random_motion_starts_and_ends_exactly_at_rest(seed):
    trajectory = trajectory_of(seed)
    for derivative in trajectory(trajectory.duration)[1:]:
        assert derivative.tolist() == [0.0, 0.0, 0.0]
    for derivative in trajectory(0.0)[1:3]:
        assert derivative.tolist() == [0.0, 0.0, 0.0]


@pytest.mark.parametrize('seed', CASES)
def test_exact_peaks_bound_dense_samples_and_are_reached(seed):
    trajectory = trajectory_of(seed)
    peaks = trajectory.peaks()
    t = dense_times(trajectory, SAMPLES_PER_PIECE)
    q, qd, qdd, qddd = trajectory(t)
    for exact, values in ((peaks.velocity, np.abs(qd)), (peaks.acceleration, np.abs(qdd)),
                          (peaks.jerk, np.abs(qddd)), (peaks.max_position, q),
                          (-peaks.min_position, -q)):
        sampled = values.max(axis=0)
        assert (sampled <= exact + ROUNDING * (1.0 + np.abs(exact))).all()
        assert sampled == pytest.approx(exact, rel=BETWEEN_SAMPLES, abs=BETWEEN_SAMPLES)


def test_peaks_of_a_swing_there_and_back_are_what_a_hand_calculation_gives():
    # From 1 to -1 rad/s in 2 s: c = b = -1 rad/s^2, the velocity is zero at half the time.
    peaks = single(transition(2.0, 0.0, 1.0, -1.0)).peaks()
    assert peaks.velocity == pytest.approx([1.0] * 3, abs=ROUNDING)
    assert peaks.acceleration == pytest.approx([2.0] * 3, abs=ROUNDING)
    assert peaks.jerk == pytest.approx([np.pi] * 3, abs=ROUNDING)
    assert peaks.max_position == pytest.approx([0.5 + 2.0 / np.pi ** 2] * 3, abs=ROUNDING)
    assert peaks.min_position == pytest.approx([0.0] * 3, abs=ROUNDING)


@pytest.mark.parametrize('seed', CASES)
def test_times_of_positions_are_when_the_profile_passes_them(seed):
    rng = np.random.default_rng(seed)
    velocities = np.concatenate(([0.0], 10.0 ** rng.uniform(-4.0, 1.0, 5), [0.0]))
    pieces, position = [], rng.normal()
    for begin, end in zip(velocities, velocities[1:]):
        pieces.append(transition(10.0 ** rng.uniform(-3.0, 1.0), position, begin, end))
        position = float(pieces[-1].at(1.0)[0])
    profile = JointProfile(joined(pieces))
    times = np.sort(np.append(rng.uniform(0.0, profile.duration, 20), profile.knots[1:-1]))
    positions = profile(times)[0]
    found = profile.passed(positions)
    assert (found >= 0.0).all() and (found <= profile.duration).all()
    size = np.abs(positions).max() + profile.duration * velocities.max()
    assert profile(found)[0] == pytest.approx(positions, abs=1e-14 * size)


def test_rest_is_passed_at_the_start_and_the_same_position_twice():
    profile = JointProfile(joined([transition(2.0, 1.0, 0.0, 3.0)]))  # 3 rad in between
    assert profile.passed(np.array([1.0, 2.5, 2.5])) == pytest.approx(
        [0.0, *[profile.passed(np.array([2.5]))[0]] * 2], abs=ROUNDING)
    assert profile.passed(np.array([])).shape == (0,)


def test_peaks_of_a_joint_at_rest_are_zero():
    peaks = single(cruise(1.5, 0.7, 0.0)).peaks()
    for peak in (peaks.velocity, peaks.acceleration, peaks.jerk):
        assert peak.tolist() == [0.0, 0.0, 0.0]
    assert peaks.min_position.tolist() == peaks.max_position.tolist() == [0.7, 0.7, 0.7]


@pytest.mark.parametrize('factor', [0.25, 1.0, 1.7, 40.0])
def test_time_scaling_has_the_same_path_and_scales_its_derivatives(factor):
    for seed in range(10):
        trajectory = trajectory_of(seed)
        stretched = trajectory.time_scaled(factor)
        assert stretched.duration == pytest.approx(factor * trajectory.duration, rel=1e-14)
        assert stretched.via_times == pytest.approx(factor * trajectory.via_times, rel=1e-14)
        t = np.random.default_rng(seed).uniform(0.0, trajectory.duration, 100)
        for order, (slow, fast) in enumerate(zip(stretched(factor * t), trajectory(t))):
            assert slow * factor ** order == pytest.approx(fast, rel=1e-9, abs=1e-9)
        slow, fast = stretched.peaks(), trajectory.peaks()
        for order, name in enumerate(('velocity', 'acceleration', 'jerk'), start=1):
            assert getattr(slow, name) * factor ** order == pytest.approx(
                getattr(fast, name), rel=1e-12)
        for name in ('min_position', 'max_position'):
            assert getattr(slow, name) == pytest.approx(getattr(fast, name), abs=ROUNDING)


def test_via_points_are_passed_where_they_were_before_stretching():
    trajectory = trajectory_of(84)
    stretched = trajectory.time_scaled(1.3)
    assert stretched(stretched.via_times)[0] == pytest.approx(
        trajectory(trajectory.via_times)[0], abs=ROUNDING)


def test_knots_are_all_joints_knots_with_start_and_end():
    for seed in range(10):
        trajectory = trajectory_of(seed)
        knots = trajectory.knots
        assert knots[0] == 0.0
        assert knots[-1] == trajectory.duration
        assert (np.diff(knots) > 0.0).all()
        for profile in trajectory.profiles:
            nearest = np.abs(profile.knots[:, np.newaxis] - knots).min(axis=1)
            assert nearest.max() <= 1e-11


def test_a_very_short_piece_moves_neither_start_nor_end():
    short = joined([cruise(1e-13, 0.0, 0.0), transition(1.0, 0.0, 0.0, 1.0),
                    transition(1.0, 0.5, 1.0, 0.0), cruise(1e-13, 1.0, 0.0)])
    long = joined([transition(1.0, 0.0, 0.0, 1.0), transition(1.0, 0.5, 1.0, 0.0)])
    trajectory = PiecewiseTrajectory(
        [JointProfile(short), JointProfile(long), JointProfile(long)], [0.0, 2.0])
    assert trajectory.knots == pytest.approx([0.0, 1.0, 2.0], abs=1e-12)
    assert trajectory.knots[0] == 0.0
    assert trajectory.knots[-1] == trajectory.duration


def test_pieces_of_no_duration_are_dropped():
    pieces = joined([cruise(0.0, 0.0, 1.0), transition(1.0, 0.0, 0.0, 1.0), cruise(0.0, 0.5, 1.0)])
    profile = JointProfile(pieces)
    assert profile.pieces.duration.tolist() == [1.0]
    assert profile.knots.tolist() == [0.0, 1.0]
    assert np.isfinite(profile(np.array([0.0, 0.5, 1.0]))).all()


@pytest.mark.parametrize('durations', [[1.0, -0.5], [0.0, 0.0], []])
def test_profile_of_impossible_durations_is_refused(durations):
    pieces = CycloidPiece(np.array(durations), *(np.ones(len(durations)) for _ in range(5)))
    with pytest.raises(InvalidInputError, match=(
            r'^piece durations are \[.*\] s, must not be negative, nor all zero$')):
        JointProfile(pieces)


@pytest.mark.parametrize('field', CycloidPiece._fields)
def test_piece_that_is_not_finite_is_refused_by_field(field):
    pieces = joined([transition(1.0, 0.0, 0.0, 1.0), cruise(1.0, 0.5, 1.0)])
    bad = getattr(pieces, field).copy()
    bad[1] = np.nan
    with pytest.raises(InvalidInputError, match=rf'^{field}\[1\] is nan, must be finite$'):
        JointProfile(pieces._replace(**{field: bad}))


def test_joints_out_of_step_are_refused():
    profiles = [JointProfile(joined([cruise(T, 0.0, 0.0)])) for T in (1.0, 1.0, 1.5)]
    with pytest.raises(InvalidInputError, match=(
            r'^joints move for \[1\. +1\. +1\.5\] s, must be in step$')):
        PiecewiseTrajectory(profiles, [0.0, 1.0])


def test_joints_out_of_step_by_rounding_are_accepted():
    profiles = [JointProfile(joined([cruise(T, 0.0, 1.0)])) for T in (1.0, 1.0, 1.0 + 9e-10)]
    trajectory = PiecewiseTrajectory(profiles, [0.0, 1.0])
    assert trajectory.duration == 1.0
    assert trajectory.knots[-1] == 1.0
    for t in (1.0, 2.0):  # every joint is at its own end
        assert trajectory(t)[0].tolist() == [1.0, 1.0, 1.0 + 9e-10]


@pytest.mark.parametrize('via_times', [[0.0, 0.6, 0.5, 1.0], [0.0, 1.1], [-0.1, 1.0]])
def test_via_times_that_do_not_rise_within_the_motion_are_refused(via_times):
    profile = JointProfile(joined([cruise(1.0, 0.0, 0.0)]))
    with pytest.raises(InvalidInputError, match=r'^via_times \[.*\] s must rise within'):
        PiecewiseTrajectory([profile] * 3, via_times)


def test_via_points_may_share_a_time():
    profile = JointProfile(joined([cruise(1.0, 0.0, 0.0)]))
    trajectory = PiecewiseTrajectory([profile] * 3, [0.0, 0.5, 0.5, 1.0])
    assert trajectory.via_times.tolist() == [0.0, 0.5, 0.5, 1.0]


def test_arrays_handed_out_are_read_only():
    trajectory = trajectory_of(85)
    profile = trajectory.profiles[0]
    for array in (trajectory.via_times, profile.knots, *profile.pieces):
        with pytest.raises(ValueError, match='read-only'):
            array[0] = 5.0


def test_values_handed_out_are_the_caller_s_own():
    trajectory = trajectory_of(86)
    t = np.array([0.0, 0.1, trajectory.duration])
    for values in trajectory(t):
        values[:] = np.nan
    assert np.isfinite(trajectory(t)).all()
