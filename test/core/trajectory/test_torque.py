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

"""Torques over a whole motion: their peaks, and the slowing down that fits them in."""

from helpers.random_cases import ARMS, dense_times, joined, random_trajectory
from helpers.thesis_arm import ThesisArm
import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.dynamics.rigid_body import gravity_torque, inverse_dynamics
from rrr_traj_planner.core.motion_laws.cycloid import cruise, transition
from rrr_traj_planner.core.trajectory.joint_profile import JointProfile
from rrr_traj_planner.core.trajectory.maximum import maximum_over_time
from rrr_traj_planner.core.trajectory.piecewise import PiecewiseTrajectory
from rrr_traj_planner.core.trajectory.torque import (
    peak_holding_torque,
    peak_torque,
    time_scale_for_torque,
)

# What the package promises for peaks, relative.
PEAK = 1e-6
# So many samples a piece that what they miss is far below that.
SAMPLES_PER_PIECE = 8000
CASES = [(arm, seed) for seed, arm in enumerate(ARMS * 3)]


def trajectory_of(seed, duration=None):
    return random_trajectory(np.random.default_rng(1000 + seed), duration)


def at_rest(q, duration=1.0):
    """Return a motion that stays in a pose."""
    return PiecewiseTrajectory(
        [JointProfile(joined([cruise(duration, x, 0.0)])) for x in q], [0.0, duration])


def limits_of(effort):
    return JointLimits(max_effort=effort)


def assert_is_peak(peak, trajectory, torque):
    """Check that nothing on a very dense grid is higher, and that the motion takes the value."""
    dense = np.abs(torque(*trajectory(dense_times(trajectory, SAMPLES_PER_PIECE))[:3]))
    assert (peak.value >= dense.max(axis=0) * (1.0 - PEAK)).all()
    for j in range(3):
        there = torque(*trajectory(peak.time[j])[:3])[j]
        assert abs(there) == pytest.approx(peak.value[j], rel=1e-12, abs=1e-12)


@pytest.mark.parametrize(('arm', 'seed'), CASES)
def test_peak_torque_is_that_of_a_very_dense_grid(arm, seed):
    trajectory = trajectory_of(seed)
    assert_is_peak(peak_torque(arm, trajectory), trajectory,
                   lambda *state: inverse_dynamics(arm, *state))


@pytest.mark.parametrize('duration', [0.02, 0.3, 20.0])
def test_peaks_are_found_in_motions_of_any_length(duration):
    arm = RobotModel()
    for seed in range(5):
        trajectory = trajectory_of(seed, duration)
        assert_is_peak(peak_torque(arm, trajectory), trajectory,
                       lambda *state: inverse_dynamics(arm, *state))


@pytest.mark.parametrize(('arm', 'seed'), CASES[:5])
def test_peak_holding_torque_is_that_of_a_very_dense_grid(arm, seed):
    trajectory = trajectory_of(seed)
    peak = peak_holding_torque(arm, trajectory)
    assert peak.value[0] == 0.0
    assert_is_peak(peak, trajectory, lambda q, qd, qdd: gravity_torque(arm, q))


def test_resting_arm_s_peak_torque_is_its_gravity_torque():
    q = (0.3, 0.2, 1.0)
    for peak in (peak_torque, peak_holding_torque):
        assert peak(RobotModel(), at_rest(q)).value == pytest.approx(
            np.abs(gravity_torque(RobotModel(), q)), abs=1e-12)


def test_weightless_resting_arm_needs_no_torque():
    peak = peak_torque(ThesisArm(g=0.0), at_rest((0.3, 0.2, 1.0)))
    assert peak.value.tolist() == [0.0, 0.0, 0.0]


@pytest.mark.parametrize(('arm', 'seed'), CASES)
def test_motion_slowed_down_by_the_factor_brings_the_peak_to_the_limit_exactly(arm, seed):
    trajectory = trajectory_of(seed)
    rng = np.random.default_rng(2000 + seed)
    hold = peak_holding_torque(arm, trajectory).value
    effort = hold + rng.uniform(0.05, 1.0, 3) * (peak_torque(arm, trajectory).value - hold + 1.0)
    limits = limits_of(effort)
    factors = time_scale_for_torque(arm, limits, trajectory).value
    moving = np.flatnonzero(factors)
    assert len(moving) >= 2  # a joint may rest by chance
    for j in moving:
        slowed = peak_torque(arm, trajectory.time_scaled(factors[j])).value
        assert slowed[j] == pytest.approx(effort[j], rel=1e-9)
    all_fit = peak_torque(arm, trajectory.time_scaled(factors.max())).value
    assert (all_fit <= effort * (1.0 + 1e-9)).all()


def slightly_scaled(arm, trajectory, factor):
    """Return a motion after a time scaling, the torque peaks before which are known."""
    peak_torque(arm, trajectory)
    return trajectory.time_scaled(factor)


@pytest.mark.parametrize(('arm', 'seed'), CASES)
def test_peaks_after_a_slight_time_scaling_are_those_of_a_very_dense_grid(arm, seed):
    rng = np.random.default_rng(seed)
    for factor in 1.0 + np.array([5e-4, -5e-4, rng.uniform(-5e-4, 5e-4)]):
        scaled = slightly_scaled(arm, trajectory_of(seed), float(factor))
        assert_is_peak(peak_torque(arm, scaled), scaled,
                       lambda *state: inverse_dynamics(arm, *state))


def test_of_two_peaks_the_one_counts_that_a_slight_time_scaling_makes_the_largest():
    # Joint 2 raises the stretched arm slowly from where gravity asks most, then swings it quickly
    # where it asks less. The time scaling at which both peaks are equal is found by bisection.
    arm, largest = RobotModel(), []
    raised = [transition(2.0, 0.0, 0.0, 0.6), transition(2.0, 0.6, 0.6, 0.0)]
    swung = [transition(0.5, 1.2, 0.0, 0.8), transition(0.5, 1.4, 0.8, -0.8),
             transition(0.5, 1.4, -0.8, 0.0)]
    others = [JointProfile(joined([cruise(5.5, q, 0.0)])) for q in (0.0, 0.5 * np.pi)]
    motion = PiecewiseTrajectory(
        [others[0], JointProfile(joined([*raised, *swung])), others[1]], [0.0, 5.5])

    def peaks(factor):
        scaled = motion.time_scaled(factor)
        t = dense_times(scaled, SAMPLES_PER_PIECE)
        torque = np.abs(inverse_dynamics(arm, *scaled(t)[:3]))[:, 1]
        return [torque[part].max() for part in (t < 4.0 * factor, t >= 4.0 * factor)]

    low, high = 0.1, 10.0
    assert peaks(low)[0] < peaks(low)[1]
    assert peaks(high)[0] > peaks(high)[1]
    for _ in range(50):
        middle = np.sqrt(low * high)
        low, high = (low, middle) if peaks(middle)[0] > peaks(middle)[1] else (middle, high)
    for factor in (1.0 + 4e-4, 1.0 - 4e-4):
        scaled = slightly_scaled(arm, motion.time_scaled(low * factor ** -0.5), factor)
        peak = peak_torque(arm, scaled)
        assert_is_peak(peak, scaled, lambda *state: inverse_dynamics(arm, *state))
        largest.append(peak.time[1] < 4.0 * low)
    assert len(set(largest)) == 2


def test_time_scale_below_one_reports_how_much_faster_is_feasible():
    trajectory = trajectory_of(3)
    effort = 4.0 * peak_torque(RobotModel(), trajectory).value
    factors = time_scale_for_torque(RobotModel(), limits_of(effort), trajectory).value
    assert (factors < 1.0).all()
    faster = peak_torque(RobotModel(), trajectory.time_scaled(factors.max())).value
    assert (faster / effort).max() == pytest.approx(1.0, rel=1e-9)


def test_factor_of_a_weightless_arm_is_the_root_of_the_excess():
    # Without gravity torque falls with the square of the factor.
    arm, trajectory = ThesisArm(g=0.0), trajectory_of(4)
    effort = peak_torque(arm, trajectory).value / (4.0, 9.0, 0.25)
    factors = time_scale_for_torque(arm, limits_of(effort), trajectory).value
    assert factors == pytest.approx([2.0, 3.0, 0.5], rel=1e-9)


def test_factor_s_time_is_where_the_slowed_motion_meets_its_limit():
    trajectory = trajectory_of(5)
    hold = peak_holding_torque(RobotModel(), trajectory).value
    effort = hold + 20.0
    factors = time_scale_for_torque(RobotModel(), limits_of(effort), trajectory)
    for j in range(3):
        slowed = trajectory.time_scaled(factors.value[j])
        torque = inverse_dynamics(
            RobotModel(), *slowed(factors.time[j] * factors.value[j])[:3])[j]
        assert abs(torque) == pytest.approx(effort[j], rel=1e-9)


def test_joint_without_an_effort_limit_asks_for_nothing():
    trajectory = trajectory_of(6)
    factors = time_scale_for_torque(
        RobotModel(), limits_of((np.inf, 1000.0, np.inf)), trajectory).value
    assert factors[[0, 2]].tolist() == [0.0, 0.0]
    assert factors[1] > 0.0
    none = time_scale_for_torque(RobotModel(), limits_of((np.inf, np.inf, np.inf)), trajectory)
    assert none.value.tolist() == [0.0, 0.0, 0.0]


def moving_through(q2, change):
    """Return a motion of joint 2 alone, the arm stretched."""
    up = JointProfile(joined([transition(1.0, q2, 0.0, change),
                              transition(1.0, q2 + 0.5 * change, change, 0.0)]))
    still = [JointProfile(joined([cruise(2.0, x, 0.0)])) for x in (0.0, np.pi / 2)]
    return PiecewiseTrajectory([still[0], up, still[1]], [0.0, 2.0])


@pytest.mark.parametrize('trajectory', [
    at_rest((0.0, 0.0, np.pi / 2)),      # gravity asks 243 N m of joint 2 of the level arm
    at_rest((0.0, np.pi, -np.pi / 2)),
    moving_through(0.0, 0.1),            # with the motion, and against it
    moving_through(0.0, -0.1)])
def test_limit_below_what_gravity_takes_can_be_met_by_no_slowing_down(trajectory):
    limits = limits_of((1000.0, 90.0, 1000.0))
    assert peak_holding_torque(RobotModel(), trajectory).value[1] > 90.0
    assert time_scale_for_torque(RobotModel(), limits, trajectory).value[1] == np.inf


def test_resting_arm_whose_limits_hold_it_asks_for_nothing():
    factors = time_scale_for_torque(
        RobotModel(), limits_of((1.0, 250.0, 60.0)), at_rest((0.0, 0.0, np.pi / 2))).value
    assert factors.tolist() == [0.0, 0.0, 0.0]


def test_maximum_between_the_points_of_a_grid_is_found():
    peaks = np.array([0.2137, 0.5, 0.91713])

    def bumps(t):
        return 5.0 - (t[:, np.newaxis] - peaks) ** 2

    found = maximum_over_time(bumps, np.linspace(0.0, 1.0, 11))
    assert found.value == pytest.approx([5.0] * 3, abs=1e-9)
    assert found.time == pytest.approx(peaks, abs=1e-4)


def test_highest_of_several_maxima_counts_even_if_the_grid_shows_another_as_higher():
    # The grid meets one bump at its top; the other, between two points, is higher by 2 %.
    def bumps(t):
        return np.stack([np.exp(-((t - 0.2) / 0.1) ** 2) + 1.02 * np.exp(-((t - 0.75) / 0.1) ** 2),
                         t, 1.0 - t], axis=-1)

    found = maximum_over_time(bumps, np.linspace(0.0, 1.0, 11))
    assert found.value == pytest.approx([1.02, 1.0, 1.0], abs=1e-6)
    assert found.time == pytest.approx([0.75, 1.0, 0.0], abs=1e-4)


def test_peaks_that_fall_less_steeply_than_they_rise_are_found():
    # t exp(1 - t) is 1 at t = 1; the grid is coarse and meets none of these tops.
    tops = np.array([0.2137, 0.35, 0.52713])

    def bumps(t):
        x = t[:, np.newaxis] / tops
        return x * np.exp(1.0 - x)

    found = maximum_over_time(bumps, np.linspace(0.0, 2.0, 21))
    assert found.value == pytest.approx([1.0] * 3, rel=1e-9)
    assert found.time == pytest.approx(tops, abs=1e-4)


def test_both_sides_of_a_step_count_and_so_does_what_is_beside_it():
    # Before 0.5 t rises to it; after it, a parabola whose top is between two points of the grid.
    def stepping(t):
        before = t < 0.5
        return np.stack([np.where(before, 4.0 * t, 1.0 - t),
                         np.where(before, 4.0 * t, 2.1 - 30.0 * (t - 0.537) ** 2)], axis=-1)

    grid = np.union1d(np.linspace(0.0, 1.0, 11), [0.5 - 1e-9])
    found = maximum_over_time(stepping, grid)
    assert found.value == pytest.approx([2.0, 2.1], abs=1e-8)
    assert found.time == pytest.approx([0.5, 0.537], abs=1e-4)


def test_tops_beside_which_curvature_jumps_are_found():
    # Up to c a line rises slowly, after it a parabola is taken away: as jerk does in a ramp.
    c, slope, k = 0.443, 0.1, np.array([5.0, 50.0, 500.0])

    def bent(t):
        late = np.maximum(t[:, np.newaxis] - c, 0.0)
        return slope * t[:, np.newaxis] + 1.0 - k * late ** 2

    found = maximum_over_time(bent, np.linspace(0.0, 1.0, 11))
    assert found.value == pytest.approx(slope * c + 1.0 + slope ** 2 / (4.0 * k), rel=1e-9)
    assert found.time == pytest.approx(c + slope / (2.0 * k), abs=1e-4)
