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

"""Torques with friction over a motion: both sides of turning points, and time scaling."""

from __future__ import annotations

from dataclasses import replace

from helpers.friction_arms import torques, with_friction
from helpers.random_cases import dense_times, joined, random_trajectory
from helpers.random_chains import random_arm
import numpy as np
import pytest
from rrr_traj_planner.core.arm.friction import Friction
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.dynamics.motor_torque import motor_torque
from rrr_traj_planner.core.dynamics.rigid_body import gravity_torque, inverse_dynamics
from rrr_traj_planner.core.motion_laws.cycloid import cruise, transition
from rrr_traj_planner.core.trajectory.joint_profile import JointProfile
from rrr_traj_planner.core.trajectory.piecewise import PiecewiseTrajectory
from rrr_traj_planner.core.trajectory.torque import peak_torque, time_scale_for_torque
from rrr_traj_planner.core.trajectory.torque_sweep import torque_sweep

SEEDS = range(12)
PEAK = 1e-6  # relative, what the package promises
# Samples a piece; friction steps between two of them, where the torque without it may change by
# this part.
SAMPLES, BETWEEN = 8000, 1e-3
WEIGHTLESS = RobotModel(gravity=np.zeros(3), friction=Friction([3.0, 5.0, 2.0], [7.0, 4.0, 6.0]))


def rubbing_case(seed):
    return (with_friction(random_arm(seed), seed),
            random_trajectory(np.random.default_rng(1000 + seed)))


def profiles(*pieces):
    """Return a motion of joint 1 alone."""
    duration = sum(piece.duration for piece in pieces)
    still = [JointProfile(joined([cruise(duration, q, 0.0)])) for q in (0.4, 0.9)]
    return PiecewiseTrajectory([JointProfile(joined(pieces)), *still], [0.0, duration])


@pytest.mark.parametrize('seed', SEEDS)
def test_motor_torque_is_pinocchio_s_and_friction_against_the_motion(seed):
    arm, trajectory = rubbing_case(seed)
    state = trajectory(np.linspace(0.0, trajectory.duration, 50))[:3]
    found, expected = motor_torque(arm, *state), torques(arm, *state)
    np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-9)


def test_joints_at_rest_have_no_friction():
    q, still = np.array([0.1, 0.2, 0.3]), np.zeros(3)
    arm = with_friction(random_arm(0), 0)
    assert (motor_torque(arm, q, still, still) == gravity_torque(arm, q)).all()


@pytest.mark.parametrize('seed', SEEDS)
def test_peak_is_the_supremum_of_very_dense_samples(seed):
    arm, trajectory = rubbing_case(seed)
    t = dense_times(trajectory, SAMPLES)
    q, qd, qdd, _ = trajectory(t)
    rounded = np.where(np.abs(qd) > 1e-12 * np.abs(qd).max(), qd, 0.0)  # at the ends
    dense = np.abs(motor_torque(arm, q, rounded, qdd))
    peak = peak_torque(arm, trajectory)
    assert (peak.value >= dense.max(axis=0) * (1.0 - PEAK)).all()
    assert (peak.value <= dense.max(axis=0) * (1.0 + BETWEEN)).all()


@pytest.mark.parametrize('factor', [1.0, 1.0004, 0.7, 3.0])
def test_at_a_turning_point_the_peak_is_the_limit_from_the_side_that_counts(factor):
    # Joint 1 turns at full deceleration, where its torque is largest, and friction steps there
    # from against the deceleration to with it.
    motion = profiles(transition(1.0, 0.0, 1.0, -1.0), transition(1.0, 0.0, -1.0, 0.0))
    peak_torque(WEIGHTLESS, motion)
    scaled = motion.time_scaled(factor)
    smooth = inverse_dynamics(WEIGHTLESS, *scaled(0.5 * factor)[:3])[0]
    assert smooth < 0.0
    found = peak_torque(WEIGHTLESS, scaled)
    viscous = 3.0 * abs(scaled(0.5 * factor + 1e-9)[1][0])
    assert found.value[0] >= abs(smooth) + 7.0 - viscous - 1e-6
    dense = motor_torque(WEIGHTLESS, *scaled(dense_times(scaled, 100000))[:3])
    assert found.value[0] == pytest.approx(np.abs(dense[:, 0]).max(), rel=1e-6)


def test_a_joint_that_rests_for_a_while_has_no_friction_then():
    motion = profiles(transition(1.0, 0.0, 0.0, 1.0), transition(1.0, 0.5, 1.0, 0.0),
                      cruise(1.0, 1.0, 0.0), transition(1.0, 1.0, 0.0, -1.0),
                      transition(1.0, 0.5, -1.0, 0.0))
    sweep = torque_sweep(WEIGHTLESS, motion)
    resting = (sweep.times > 2.0) & (sweep.times < 3.0)
    assert resting.sum() > 5
    assert (sweep.parts.constant[resting] == 0.0).all()
    assert (sweep.parts.constant[:, 1:] == 0.0).all()
    before, after = (sweep.times > 0.0) & (sweep.times < 2.0), sweep.times > 3.0
    assert (sweep.parts.constant[before, 0] == 7.0).all()
    assert (sweep.parts.constant[after, 0][:-1] == -7.0).all()
    assert sweep.parts.constant[[0, -1], 0].tolist() == [0.0, 0.0]


def test_two_turning_points_between_two_samples_are_found():
    # Slowed to a creep backwards for a thousandth of the motion.
    dip = 1e-5
    motion = profiles(transition(1.0, 0.0, 1.0, -dip), transition(1.0, 0.5, -dip, 1.0))
    found = peak_torque(WEIGHTLESS, motion)
    dense = motor_torque(WEIGHTLESS, *motion(dense_times(motion, 100000))[:3])
    assert found.value[0] >= np.abs(dense[:, 0]).max() * (1.0 - PEAK)
    directions = torque_sweep(WEIGHTLESS, motion).parts.constant[:, 0]
    assert set(directions.tolist()) == {7.0, -7.0, 0.0} or set(directions.tolist()) == {7.0, -7.0}


@pytest.mark.parametrize('seed', SEEDS)
def test_motion_slowed_by_the_factor_brings_its_torque_to_the_limit(seed):
    arm, trajectory = rubbing_case(seed)
    rng = np.random.default_rng(seed)
    still = np.abs(torque_sweep(arm, trajectory).parts.constant).max(axis=0)
    peak = peak_torque(arm, trajectory).value
    effort = still + rng.uniform(0.1, 0.9, 3) * (peak - still + 1.0)
    limits = JointLimits(max_effort=effort)
    factors = time_scale_for_torque(arm, limits, trajectory).value
    for j in np.flatnonzero(factors > 1.0):
        slowed = peak_torque(arm, trajectory.time_scaled(factors[j])).value
        assert slowed[j] <= effort[j] * (1.0 + PEAK) or factors[j] < factors.max()


def test_effort_limits_count_coulomb_friction_as_torque_that_no_slowness_takes_away():
    arm = replace(WEIGHTLESS, friction=Friction(np.zeros(3), [7.0, 4.0, 6.0]))
    motion = profiles(transition(1.0, 0.0, 0.0, 1.0), transition(1.0, 0.5, 1.0, 0.0))
    enough, less = (JointLimits(max_effort=np.array([x, 50.0, 50.0])) for x in (7.1, 6.9))
    assert 1.0 < time_scale_for_torque(arm, enough, motion).value[0] < np.inf
    assert time_scale_for_torque(arm, less, motion).value[0] == np.inf
