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

"""Seeded random arms, states and motions, and numerical derivatives."""

from __future__ import annotations

from helpers.thesis_arm import ThesisArm
import numpy as np
from rrr_traj_planner.core.motion_laws.cycloid import (
    cruise,
    CycloidPiece,
    general_transition,
    ramp,
    transition,
)
from rrr_traj_planner.core.trajectory.joint_profile import JointProfile
from rrr_traj_planner.core.trajectory.piecewise import PiecewiseTrajectory


def random_model(rng):
    """Return an arm with random geometry, masses and inertias."""
    a2, d4 = rng.uniform(0.2, 1.5, 2)
    return ThesisArm(
        d1=rng.uniform(-0.5, 1.0), a2=a2, d4=d4, l2=rng.uniform(0.1, 1.0) * a2,
        l3=rng.uniform(0.1, 1.0) * d4, mass=rng.uniform(1.0, 50.0, 3),
        inertia=rng.uniform(0.01, 2.0, (3, 3)), g=rng.uniform(1.0, 25.0))


# The thesis's arm and four random ones, for properties of every arm.
ARMS = [ThesisArm(), *(random_model(np.random.default_rng(seed)) for seed in range(4))]


def random_states(rng, n):
    """Return random joint positions, velocities and accelerations, shape (n, 3) each."""
    return rng.uniform(-7.0, 7.0, (n, 3)), rng.normal(0.0, 2.0, (n, 3)), rng.normal(
        0.0, 5.0, (n, 3))


def central_difference(function, x, step):
    """Return df/dx of a function of one number by fourth-order differences."""
    return (8.0 * (function(x + step) - function(x - step))
            - (function(x + 2.0 * step) - function(x - 2.0 * step))) / (12.0 * step)


def joined(pieces):
    """Return single pieces as one with fields of shape (n,)."""
    return CycloidPiece(*(np.array(field, dtype=float) for field in zip(*pieces)))


def random_pieces(rng, durations):
    """Return pieces of every kind, from rest to rest, with continuous acceleration."""
    pieces = []
    position, velocity, acceleration = rng.uniform(-1.0, 1.0), 0.0, 0.0
    for duration in durations[:-2]:
        kind = rng.integers(3) if acceleration == 0.0 else 2
        if kind == 0:
            piece = transition(duration, position, velocity, rng.uniform(-1.0, 1.0))
        elif kind == 1:
            piece = cruise(duration, position, velocity)
        else:
            piece = ramp(duration, position, velocity, acceleration, rng.uniform(-2.0, 2.0))
        pieces.append(piece)
        position, velocity = piece.at(1.0)[:2]
        acceleration = float(piece.at(1.0)[2]) if kind == 2 else 0.0
    pieces.append(ramp(durations[-2], position, velocity, acceleration, 0.0))
    position, velocity = pieces[-1].at(1.0)[:2]
    pieces.append(transition(durations[-1], position, velocity, 0.0))
    return joined(pieces)


def random_general_transition(rng, fraction=None):
    """Return a transition between random accelerations, of either sign, and its ends."""
    peak = rng.uniform(0.5, 5.0)
    start = rng.uniform(-0.3, 0.9) * peak
    end = start + (rng.uniform() if fraction is None else fraction) * (peak - start)
    position, velocity = rng.normal(0.0, 2.0, 2)
    change, sign = rng.uniform(0.1, 3.0), rng.choice((-1.0, 1.0))
    ends = {'position': position, 'velocity': velocity, 'end_velocity': velocity + sign * change,
            'start_acceleration': sign * start, 'end_acceleration': sign * end,
            'peak_acceleration': sign * peak}
    return general_transition(**ends), ends


def _random_transition(rng):
    return transition(rng.uniform(0.1, 5.0), *rng.normal(0.0, 2.0, 3))


def _random_cruise(rng):
    return cruise(rng.uniform(0.1, 5.0), *rng.normal(0.0, 2.0, 2))


def _random_ramp(rng):
    return ramp(rng.uniform(0.1, 5.0), *rng.normal(0.0, 2.0, 4))


_KINDS = [_random_transition, _random_cruise, _random_ramp,
          lambda rng: random_general_transition(rng)[0]]


def pieces_of_every_kind(seed, n):
    """Return n pieces, of all kinds in turn."""
    rng = np.random.default_rng(seed)
    return [_KINDS[i % len(_KINDS)](rng) for i in range(n)]


def random_trajectory(rng, duration=None, via_times=None):
    """Return a smooth motion of three joints, each with three to nine pieces."""
    if duration is None:
        duration = rng.uniform(0.5, 5.0)
    profiles = []
    for _ in range(3):
        shares = rng.dirichlet(np.full(rng.integers(3, 10), 2.0))
        profiles.append(JointProfile(random_pieces(rng, duration * shares)))
    if via_times is None:
        between = np.sort(rng.uniform(0.0, duration, rng.integers(0, 5)))
        via_times = np.concatenate(([0.0], between, [duration]))
    return PiecewiseTrajectory(profiles, via_times)


def dense_times(trajectory, per_interval):
    """Return times on a fine grid that contains every knot, without the code under test."""
    knots = trajectory.knots
    grids = [np.linspace(a, b, per_interval, endpoint=False)
             for a, b in zip(knots[:-1], knots[1:])]
    return np.concatenate((*grids, knots[-1:]))
