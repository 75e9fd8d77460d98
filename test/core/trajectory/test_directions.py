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

"""Directions of motion: instants and intervals of rest, and torques on either side of them."""

from __future__ import annotations

from dataclasses import replace

from helpers.friction_arms import with_friction
from helpers.random_cases import dense_times, joined, random_pieces
from helpers.random_chains import random_arm
import numpy as np
import pytest
from rrr_traj_planner.core.dynamics.motor_torque import smooth_motor_torque
from rrr_traj_planner.core.motion_laws.cycloid import cruise, transition
from rrr_traj_planner.core.trajectory.directions import directions
from rrr_traj_planner.core.trajectory.joint_profile import JointProfile
from rrr_traj_planner.core.trajectory.piecewise import PiecewiseTrajectory
from rrr_traj_planner.core.trajectory.torque import peak_torque
from rrr_traj_planner.core.trajectory.torque_sweep import torque_grid, torque_sweep

SAMPLES = 4000       # of the dense grid, between two knots
PEAK = 1e-6          # relative, what the package promises
BETWEEN = 1e-3       # relative, by which a dense grid may miss a peak
STEPS_OF_A_REST = 6  # grid times that one joint's rest may add: either side of its ends, and stops


def there_and_back():
    """Return pieces that go on for 2 s, rest for 1 s, and come back in 2 s."""
    return joined([transition(1.0, 0.0, 0.0, 1.0), transition(1.0, 0.5, 1.0, 0.0),
                   cruise(1.0, 1.0, 0.0), transition(1.0, 1.0, 0.0, -1.0),
                   transition(1.0, 0.5, -1.0, 0.0)])


def motion(*joints):
    return PiecewiseTrajectory([JointProfile(pieces) for pieces in joints], [0.0, 5.0])


def still(q):
    return joined([cruise(5.0, q, 0.0)])


def without_a_pause():
    """Return pieces that stop for an instant after 2.5 s, and move on."""
    return joined([transition(1.0, 0.0, 0.0, 1.0), transition(1.5, 0.5, 1.0, 0.0),
                   transition(1.5, 1.25, 0.0, 1.0), transition(1.0, 2.0, 1.0, 0.0)])


def found_in(trajectory):
    return directions(trajectory, torque_grid(trajectory))


def test_a_joint_that_never_moves_has_direction_0_and_no_stops():
    found = found_in(motion(there_and_back(), still(0.4), still(0.9)))
    for j in (1, 2):
        assert found.stops[j].tolist() == found.times[j].tolist() == []
        assert found.signs[j].tolist() == [0.0]


def test_a_rest_between_motions_is_an_interval_and_only_instants_are_stops():
    found = found_in(motion(there_and_back(), still(0.4), without_a_pause()))
    assert found.stops[0].tolist() == [0.0, 5.0]
    assert found.times[0].tolist() == [2.0, 3.0]
    assert found.signs[0].tolist() == [1.0, 0.0, -1.0]
    assert found.stops[2].tolist() == [0.0, 2.5, 5.0]
    assert found.signs[2].tolist() == [1.0]
    at = found.at(np.array([0.0, 1.0, 2.0, 2.5, 3.0, 4.0, 5.0]))
    assert at[:, 0].tolist() == [0.0, 1.0, 0.0, 0.0, -1.0, -1.0, 0.0]
    assert at[:, 1].tolist() == [0.0] * 7
    assert at[:, 2].tolist() == [0.0, 1.0, 1.0, 0.0, 1.0, 1.0, 0.0]


def test_rests_at_the_start_and_at_the_end_are_intervals_too():
    late = joined([cruise(2.0, 0.0, 0.0), transition(0.5, 0.0, 0.0, 1.0),
                   transition(0.5, 0.25, 1.0, 0.0), cruise(2.0, 0.5, 0.0)])
    found = found_in(motion(late, still(0.4), there_and_back()))
    assert found.stops[0].tolist() == []
    assert found.times[0].tolist() == [2.0, 3.0]
    assert found.signs[0].tolist() == [0.0, 1.0, 0.0]
    assert found.at(np.array([0.0, 1.0, 2.5, 4.0, 5.0]))[:, 0].tolist() == [0, 0, 1, 0, 0]


@pytest.mark.parametrize('joint', range(3))
def test_a_joint_that_rests_does_not_make_the_grid_of_torques_denser(joint):
    joints = [there_and_back(), without_a_pause(), there_and_back()]
    joints[joint] = still(0.4)
    resting = motion(*joints)
    arm = with_friction(random_arm(0), 0)
    steps = len(torque_sweep(arm, resting).times) - len(torque_grid(resting))
    assert steps <= STEPS_OF_A_REST * 3


def resting_case(seed):
    """Return an arm with friction and a motion in which one joint never moves, another rests."""
    rng = np.random.default_rng(seed)
    move = [random_pieces(rng, 5.0 * rng.dirichlet(np.full(n, 2.0))) for n in (4, 7)]
    first = random_pieces(rng, rng.dirichlet(np.full(4, 2.0)))
    end = float(first.at(1.0)[0][-1])
    pause = joined([cruise(rng.uniform(0.5, 2.0), end, 0.0)])
    rest = 4.0 - float(pause.duration[0])
    second = random_pieces(rng, rest * rng.dirichlet(np.full(5, 2.0)))
    shift = end - second.at(0.0)[0][0]
    second = second._replace(position=second.position + shift)
    paused = type(first)(*(np.concatenate(parts) for parts in zip(first, pause, second)))
    joints = [still(rng.uniform(-1.0, 1.0)), paused, move[0]]
    order = rng.permutation(3)
    arm = random_arm(seed)
    return with_friction(arm, seed), motion(*(joints[k] for k in order))


@pytest.mark.parametrize('seed', range(12))
def test_peak_of_a_motion_with_rests_is_the_supremum_of_both_sides_on_a_dense_grid(seed):
    arm, trajectory = resting_case(seed)
    t = dense_times(trajectory, SAMPLES)
    q, qd, qdd, _ = trajectory(t)
    smooth = smooth_motor_torque(arm, q, qd, qdd)
    sign = np.where(np.abs(qd) > 1e-12 * np.abs(qd).max(), np.sign(qd), 0.0)
    # Either side of an instant at rest: what moves just before or after it has friction there.
    before, after = (np.where(sign == 0.0, np.vstack(beside), sign) for beside in (
        (sign[:1], sign[:-1]), (sign[1:], sign[-1:])))
    dense = np.max([np.abs(smooth + arm.friction.coulomb * s) for s in (before, sign, after)],
                   axis=(0, 1))
    peak = peak_torque(arm, trajectory).value
    assert (peak >= dense * (1.0 - PEAK)).all()
    assert (peak <= dense * (1.0 + BETWEEN)).all()


@pytest.mark.parametrize('factor', [1.0002, 0.5, 4.0])
def test_of_a_slower_motion_rests_are_where_they_were(factor):
    trajectory = motion(there_and_back(), still(0.4), without_a_pause())
    found = found_in(trajectory)
    searched = found_in(trajectory.time_scaled(factor))
    scaled = found.scaled(factor)
    for a, b in zip((*scaled.times, *scaled.signs, *scaled.stops),
                    (*searched.times, *searched.signs, *searched.stops)):
        np.testing.assert_allclose(a, b, rtol=1e-12)


def test_without_weight_a_rest_needs_no_torque_and_the_motion_beside_it_its_friction():
    arm = replace(with_friction(random_arm(3), 3), gravity=np.zeros(3))
    sweep = torque_sweep(arm, motion(still(0.4), there_and_back(), still(0.9)))
    resting = (sweep.times >= 2.0) & (sweep.times < 3.0)
    assert (sweep.parts.constant[resting] == 0.0).all()
    beside = (np.abs(sweep.times - 2.0) < 1e-8) & (sweep.times < 2.0) | (sweep.times == 3.0)
    assert np.abs(sweep.parts.constant[beside, 1]).tolist() == [arm.friction.coulomb[1]] * 2
