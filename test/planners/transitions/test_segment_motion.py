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

"""Transitions and cruises that fill segments: they arrive, in time and within the limits."""

import numpy as np
import pytest
from rrr_traj_planner.planners.transitions.largest_displacement import largest_displacement
from rrr_traj_planner.planners.transitions.segment_motion import (
    low_acceleration_parts,
    Parts,
    quick_parts,
    Segments,
    trajectory,
)
from rrr_traj_planner.planners.transitions.transition_law import SegmentLimits, TransitionLaw

ROUNDING = 1e-9
SEEDS = range(12)


def segments(seed, n=6):
    """Return a law, a limit and end velocities, durations and displacements within reach."""
    rng = np.random.default_rng(900 + seed)
    law = TransitionLaw(rng.uniform(0.5, 3.0, 3), rng.uniform(0.0, 1.5, 3) * (rng.random(3) < 0.6))
    limit = rng.uniform(0.5, 2.0, 3)
    v0, v1 = rng.uniform(-1.0, 1.0, (2, n, 3)) * limit
    v0, v1 = v0 * (rng.random((n, 3)) < 0.8), v1 * (rng.random((n, 3)) < 0.8)
    T = law.least_time(v1 - v0).max(axis=1, keepdims=True) * rng.uniform(1.0, 3.0, (n, 1)) + 1e-3
    most = largest_displacement(SegmentLimits(law, limit), v0, v1, T)
    least = -largest_displacement(SegmentLimits(law, limit), -v0, -v1, T)
    share = rng.choice([0.0, 0.02, 0.5, 1.0], (n, 3)) + 0.0
    share = np.where(share == 0.5, rng.random((n, 3)), share)
    return law, limit, v0, v1, T, least + share * (most - least)


def displacement(parts, v0, v1, T):
    """Return what transition, cruise, transition cover: mean velocity times time of each."""
    return (0.5 * (v0 + parts.cruise) * parts.first + parts.cruise * (T - parts.first - parts.last)
            + 0.5 * (parts.cruise + v1) * parts.last)


def parts_of(kind, law, limit, v0, v1, T, D):
    if kind == 'low acceleration':
        return low_acceleration_parts(SegmentLimits(law, limit), Segments(v0, v1, T, D))
    return quick_parts(law, Segments(v0, v1, T, D))


@pytest.mark.parametrize('kind', ['low acceleration', 'quick'])
@pytest.mark.parametrize('seed', SEEDS)
def test_parts_cover_the_displacement_within_time_and_limits(kind, seed):
    law, limit, v0, v1, T, D = segments(seed)
    parts = parts_of(kind, law, limit, v0, v1, T, D)
    assert displacement(parts, v0, v1, T) == pytest.approx(D, abs=ROUNDING)
    assert (parts.first >= 0.0).all()
    assert (parts.last >= 0.0).all()
    assert (parts.first + parts.last <= T + ROUNDING).all()
    assert (np.abs(parts.cruise) <= limit * (1.0 + ROUNDING)).all()
    for change, lasting in ((parts.cruise - v0, parts.first), (v1 - parts.cruise, parts.last)):
        # A transition's peaks are those of its law's least duration or below.
        assert (law.least_time(change) <= lasting * (1.0 + 1e-6) + 1e-7).all()


@pytest.mark.parametrize('kind', ['low acceleration', 'quick'])
@pytest.mark.parametrize('seed', SEEDS)
def test_parts_of_the_mirrored_motion_are_mirrored(kind, seed):
    law, limit, v0, v1, T, D = segments(seed)
    ours = parts_of(kind, law, limit, v0, v1, T, D)
    mirrored = parts_of(kind, law, limit, -v0, -v1, T, -D)
    assert mirrored.first == pytest.approx(ours.first, abs=ROUNDING)
    assert mirrored.cruise == pytest.approx(-ours.cruise, abs=ROUNDING)


@pytest.mark.parametrize('seed', SEEDS)
def test_parts_of_the_motion_backwards_in_time_are_exchanged(seed):
    law, limit, v0, v1, T, D = segments(seed)
    v0 = np.where(v0 == v1, v0 + 1e-3, v0) * (1.0 - 1e-2)
    v1 = v1 * (1.0 - 1e-2)
    D = 0.5 * (largest_displacement(SegmentLimits(law, limit), v0, v1, T)
               - largest_displacement(SegmentLimits(law, limit), -v0, -v1, T))
    ours = low_acceleration_parts(SegmentLimits(law, limit), Segments(v0, v1, T, D))
    backwards = low_acceleration_parts(SegmentLimits(law, limit), Segments(v1, v0, T, D))
    assert backwards.first == pytest.approx(ours.last, abs=1e-6)
    assert backwards.cruise == pytest.approx(ours.cruise, abs=1e-6)


def test_with_time_to_spare_a_joint_takes_half_the_segment_for_each_transition():
    # 1 rad in 10 s from rest to rest: u = 0.2 rad/s, the acceleration 2 u / 5 s below its limit.
    law, rest = TransitionLaw(np.full(3, 2.0), np.zeros(3)), np.zeros((1, 3))
    parts = low_acceleration_parts(SegmentLimits(law, np.full(3, 5.0)), Segments(
        rest, rest, np.array([[10.0]]), np.ones((1, 3))))
    assert parts.first == pytest.approx(np.full((1, 3), 5.0))
    assert parts.last == pytest.approx(np.full((1, 3), 5.0))
    assert parts.cruise == pytest.approx(np.full((1, 3), 0.2))


def test_quick_parts_take_full_acceleration_and_the_lower_cruise():
    # 1 rad in 3 s at 1 rad/s^2: u (3 - 2 u) = 1, u = 0.5 rad/s, each transition 1 s.
    law, rest = TransitionLaw(np.full(3, 2.0), np.zeros(3)), np.zeros((1, 3))
    parts = quick_parts(law, Segments(rest, rest, np.array([[3.0]]), np.ones((1, 3))))
    assert parts.first == pytest.approx(np.full((1, 3), 1.0))
    assert parts.cruise == pytest.approx(np.full((1, 3), 0.5))


@pytest.mark.parametrize('seed', SEEDS)
def test_motion_passes_every_point_at_its_time_and_velocity(seed):
    law, limit, v0, v1, T, D = segments(seed)
    v0[1:], v0[0], v1[-1] = v1[:-1], 0.0, 0.0
    T = np.maximum(T, law.least_time(v1 - v0).max(axis=1, keepdims=True) * 1.01)
    D = 0.5 * (largest_displacement(SegmentLimits(law, limit), v0, v1, T)
               - largest_displacement(SegmentLimits(law, limit), -v0, -v1, T))
    points = np.vstack((np.zeros(3), np.cumsum(D, axis=0)))
    parts = low_acceleration_parts(SegmentLimits(law, limit), Segments(v0, v1, T, D))
    motion = trajectory(points, v0, v1, T, parts)
    assert motion.via_times == pytest.approx(np.concatenate(([0.0], np.cumsum(T))))
    q, qd, qdd, _ = motion(motion.via_times)
    assert q == pytest.approx(points, abs=ROUNDING)
    assert qd[1:-1] == pytest.approx(v1[:-1], abs=1e-8)
    assert qdd == pytest.approx(np.zeros_like(q), abs=1e-6)


def test_segment_in_which_nothing_moves_is_a_cruise_at_rest():
    still, T = np.zeros((1, 3)), np.array([[2.0]])
    motion = trajectory(np.full((2, 3), 0.7), still, still, T, Parts(still, still, still))
    assert motion.duration == 2.0
    assert [p.pieces.b.tolist() for p in motion.profiles] == [[0.0]] * 3
    assert motion(1.0)[0].tolist() == [0.7, 0.7, 0.7]
