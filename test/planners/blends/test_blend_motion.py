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

"""Motions with blends around the via points: where they go, and what they keep."""

import numpy as np
import pytest
from rrr_traj_planner.core.motion_laws.cycloid_transitions import CYCLOID
from rrr_traj_planner.core.motion_laws.quartic import QUARTIC
from rrr_traj_planner.core.motion_laws.septic import SEPTIC
from rrr_traj_planner.planners.blends.blend_motion import (
    BlendTimes,
    changes_of_velocity,
    excess,
    is_within_limits,
    shortest_transitions,
    trajectory,
)
from rrr_traj_planner.planners.transitions.transition_law import TransitionLaw
from rrr_traj_planner.planners.transitions.via_problem import ViaProblem

POINTS = np.array([[0.0, 0.2, 1.0], [0.6, 0.5, 0.4], [0.3, 0.9, 0.5], [1.0, 0.9, 0.1]])
TIMING = BlendTimes(np.array([1.1, 1.3, 1.2]), np.array([0.8, 1.0, 1.2, 0.5]))
ROUNDING = 1e-12

# How far the middle of a transition is from the corner, of change of velocity times duration: the
# position at h = 1/2 in 6.5, (D (3/2) (1/4) - 2 dB) / 2 + dB, is 3/16 D off, D = change * t_acc,
# half the duration; and of the cycloid's 3.7 1/8 - 2 / (2 pi)^2.
AT_THE_MIDDLE = {'quartic': 3.0 / 32.0, 'cycloid': 0.125 - 0.5 / np.pi ** 2}


@pytest.fixture(params=[CYCLOID, SEPTIC, QUARTIC], ids=lambda f: f.name)
def function(request):
    return request.param


def via_problem_of(law, limit=1.0):
    return ViaProblem(np.diff(POINTS, axis=0), law, np.full(3, limit), -np.ones((2, 3)),
                      np.ones((2, 3)))


def test_motion_lasts_as_long_as_its_lines_and_half_of_both_end_transitions(function):
    motion = trajectory(POINTS, TIMING, function)
    assert motion.duration == pytest.approx(3.6 + 0.5 * (0.8 + 0.5))
    assert motion.via_times == pytest.approx([0.0, 0.4 + 1.1, 0.4 + 2.4, 4.25])


def test_motion_starts_and_ends_in_its_points_at_rest(function):
    motion = trajectory(POINTS, TIMING, function)
    q, qd, qdd, _ = motion(np.array([0.0, motion.duration - 1e-9]))
    assert q == pytest.approx(POINTS[[0, -1]], abs=1e-9)
    assert qd == pytest.approx(np.zeros((2, 3)), abs=1e-7)
    assert np.abs(qdd[0]).max() <= ROUNDING


def test_between_transitions_the_arm_is_on_the_lines_that_meet_in_the_via_points(function):
    motion = trajectory(POINTS, TIMING, function)
    corners = np.array([0.4, 1.5, 2.8, 4.0])
    for k, line in enumerate(TIMING.lines):
        t = np.linspace(corners[k] + 0.5 * TIMING.transitions[k],
                        corners[k + 1] - 0.5 * TIMING.transitions[k + 1], 9)
        along = ((t - corners[k]) / line)[:, np.newaxis]
        assert motion(t)[0] == pytest.approx(
            POINTS[k] + along * (POINTS[k + 1] - POINTS[k]), abs=ROUNDING)


@pytest.mark.parametrize('function', [CYCLOID, QUARTIC], ids=lambda f: f.name)
def test_middle_of_a_transition_misses_by_a_hand_calculation(function):
    motion = trajectory(POINTS, TIMING, function)
    v = np.diff(POINTS, axis=0) / TIMING.lines[:, np.newaxis]
    missed = motion(motion.via_times[1:-1])[0] - POINTS[1:-1]
    assert missed == pytest.approx(AT_THE_MIDDLE[function.name] * (v[1:] - v[:-1])
                                   * TIMING.transitions[1:-1, np.newaxis], abs=ROUNDING)


def test_way_stays_within_the_box_of_the_points(function):
    motion = trajectory(POINTS, TIMING, function)
    peaks = motion.peaks()
    assert (peaks.min_position >= POINTS.min(axis=0) - ROUNDING).all()
    assert (peaks.max_position <= POINTS.max(axis=0) + ROUNDING).all()


def test_changes_of_velocity_begin_and_end_at_rest():
    D = np.array([[0.5, 0.0, -1.0], [1.0, 0.0, 1.0]])
    assert changes_of_velocity(D, np.array([1.0, 2.0])).tolist() == [
        [0.5, 0.0, -1.0], [0.0, 0.0, 1.5], [-0.5, -0.0, -0.5]]


def test_shortest_transitions_are_those_of_the_joint_that_needs_most():
    # 2 |change| / 1 rad/s^2, of 0.5, -1 and 1.5 rad/s.
    D = np.array([[0.5, 0.0, -1.0], [1.0, 0.0, 1.0]])
    law = TransitionLaw(np.full(3, 2.0), np.zeros(3))
    assert shortest_transitions(law, D, np.array([1.0, 2.0])) == pytest.approx(
        [2.0, 3.0, 1.0], abs=1e-8)  # lasting for rounding too


def test_excess_is_that_of_velocity_change_and_range():
    law = TransitionLaw(np.full(3, 2.0), np.zeros(3))
    problem = via_problem_of(law, limit=0.5)
    v = np.diff(POINTS, axis=0) / TIMING.lines[:, np.newaxis]
    changes = np.diff(np.vstack((np.zeros(3), v, np.zeros(3))), axis=0)
    found = excess(problem, TIMING)
    assert found[0] == pytest.approx(np.abs(v).max() / 0.5)
    assert found[1] == pytest.approx(
        (2.0 * np.abs(changes) / TIMING.transitions[:, np.newaxis]).max())
    assert found[2] == pytest.approx(max(0.9 / 1.1, 1.1 / 1.3, 0.85 / 1.2))
    assert not is_within_limits(problem, TIMING)
    assert is_within_limits(via_problem_of(TransitionLaw(np.full(3, 0.2), np.zeros(3))), TIMING)


def test_transitions_of_no_length_leave_the_line_alone():
    # Three points on a line at one speed: nothing changes at the middle one.
    points = np.array([[0.0, 0.0, 0.0], [0.5, 0.2, -0.1], [1.0, 0.4, -0.2]])
    motion = trajectory(points, BlendTimes(np.array([1.0, 1.0]), np.array([0.8, 0.0, 0.8])),
                        QUARTIC)
    assert motion(motion.via_times)[0] == pytest.approx(points, abs=ROUNDING)
    assert motion.duration == pytest.approx(2.8)
