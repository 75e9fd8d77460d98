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

"""Motions along a path of the tip: against differences, dense grids and the path itself."""

from functools import cache

from helpers.arm_paths import arm_path_in
from helpers.random_cases import ARMS, central_difference, dense_times, joined
import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.kinematics.forward import forward_kinematics, jacobian
from rrr_traj_planner.core.motion_laws.cycloid import cruise, transition
from rrr_traj_planner.core.path.design import line_arc, line_polynomial
from rrr_traj_planner.core.path.path_trajectory import PathTrajectory
from rrr_traj_planner.core.trajectory.joint_profile import JointProfile
from rrr_traj_planner.core.trajectory.sampling import sample

FREE = JointLimits(min_position=np.full(3, -np.inf), max_position=np.full(3, np.inf))
SEEDS = range(8)
DIFFERENCE = 1e-6   # of the largest value
ON_PATH = 1e-11     # m


@cache
def random_motion(seed):
    """Return a motion of an arm that speeds up, keeps its speed and slows down along a path."""
    rng = np.random.default_rng(7700 + seed)
    model = ARMS[seed % len(ARMS)]
    least, most = model.reach
    points = []
    while len(points) < 2 + seed % 4:
        d = rng.normal(size=3) + (2.0, 0.0, 0.0)
        d[0] = abs(d[0])
        points.append(d / np.linalg.norm(d) * rng.uniform(0.5 * (least + most), 0.9 * most)
                      + (0.0, 0.0, model.d1))
    path = (line_arc, line_polynomial)[seed % 2](points, 0.1 * most)
    arm_path = arm_path_in(model, FREE, path, ('up', 'down')[seed // 2 % 2])
    # No join is passed while the speed changes: between its knots the motion is smooth.
    ends = np.unique(np.concatenate((path.via_s, path.joins)))
    v, first, last = rng.uniform(0.2, 1.0), 0.9 * ends[1], 0.9 * (path.length - ends[-2])
    if len(ends) == 2:
        first = last = 0.4 * path.length
    s = np.concatenate(([first], ends[1:-1], [path.length - last]))
    pieces = [transition(2.0 * first / v, 0.0, 0.0, v),
              *(cruise(length / v, at, v) for length, at in zip(np.diff(s), s)),
              transition(2.0 * last / v, s[-1], v, 0.0)]
    progress = JointProfile(joined(pieces))
    when = np.concatenate(([0.0], progress.knots[2:-2], [progress.duration]))
    return PathTrajectory(arm_path, progress, when[np.searchsorted(ends, path.via_s)],
                          when[np.searchsorted(ends, path.joins)])


def times_between(motion, n=40):
    """Return times away from knots, which the joins are among."""
    ends = motion.knots
    share = (np.arange(n) + 0.5) / n
    t = ends[:-1, np.newaxis] + np.diff(ends)[:, np.newaxis] * share
    return t[np.diff(ends) > 1e-2].ravel()


@pytest.mark.parametrize('seed', SEEDS)
def test_tip_is_on_the_path_where_progress_says(seed):
    motion = random_motion(seed)
    t = np.linspace(0.0, motion.duration, 300)
    tip = forward_kinematics(motion.arm_path.model, motion(t)[0])
    s = np.clip(motion.progress(t)[0], 0.0, motion.arm_path.path.length)
    assert np.abs(tip - motion.arm_path.path(s)[0]).max() < ON_PATH
    vias = forward_kinematics(motion.arm_path.model, motion(motion.via_times)[0])
    assert np.abs(vias - motion.arm_path.path.points).max() < ON_PATH


@pytest.mark.parametrize('seed', SEEDS)
def test_tip_s_speed_is_that_of_progress(seed):
    motion = random_motion(seed)
    t = np.linspace(0.0, motion.duration, 200)
    q, qd, _, _ = motion(t)
    speed = np.linalg.norm(np.einsum(
        'nij,nj->ni', jacobian(motion.arm_path.model, q), qd), axis=1)
    assert speed == pytest.approx(motion.progress(t)[1], abs=1e-10)


@pytest.mark.parametrize('seed', SEEDS)
@pytest.mark.parametrize('order', [0, 1, 2])
def test_each_derivative_is_that_of_the_one_before(seed, order):
    motion = random_motion(seed)
    t = times_between(motion)
    own = motion(t)[order + 1]
    assert own == pytest.approx(central_difference(lambda x: motion(x)[order], t, 2e-5),
                                abs=DIFFERENCE * (1.0 + np.abs(own).max()))


def test_path_coordinates_may_come_in_any_order_and_one_by_one():
    for seed in SEEDS:
        arm_path = random_motion(seed).arm_path
        s = np.random.default_rng(seed).uniform(0.0, arm_path.path.length, 20)
        together, alone = arm_path(s).q, np.array([arm_path(x).q[0] for x in s[:, np.newaxis]])
        assert together == pytest.approx(alone, abs=1e-12)


@pytest.mark.parametrize('seed', SEEDS)
def test_sides_of_joins_may_be_evaluated_one_by_one(seed):
    arm_path = random_motion(seed).arm_path
    joins = arm_path.path.joins
    mixed = arm_path(np.repeat(joins, 2), left=np.tile([True, False], len(joins)))
    for ours, before, after in zip(mixed, arm_path(joins, left=True), arm_path(joins)):
        assert ours == pytest.approx(np.stack((before, after), axis=1).reshape(-1, 3), abs=1e-12)


def test_whole_turns_are_kept_along_the_path():
    # A path around joint axis 1 by more than half a turn, in a range that lies a turn further.
    angle = np.linspace(0.5, 4.0, 8)
    points = np.stack((np.cos(angle), np.sin(angle), np.full(8, 0.7)), axis=1)
    limits = JointLimits(min_position=(6.0, -4.0, -4.0), max_position=(12.0, 4.0, 4.0))
    arm_path = arm_path_in(ARMS[0], limits, line_arc(points, 0.2), 'up')
    q = arm_path(np.linspace(0.0, arm_path.path.length, 500)).q[:, 0]
    assert q[[0, -1]] == pytest.approx(2.0 * np.pi + angle[[0, -1]], abs=1e-12)
    assert np.abs(np.diff(q)).max() < 0.05


@pytest.mark.parametrize('seed', SEEDS)
def test_arm_rests_before_and_after(seed):
    motion = random_motion(seed)
    for t in (-1.0, motion.duration, motion.duration + 1.0):
        q, *rest = motion(t)
        end = motion.arm_path.path.points[0 if t < 0.0 else -1]
        assert forward_kinematics(motion.arm_path.model, q) == pytest.approx(end, abs=1e-11)
        assert np.abs(rest).max() == 0.0


@pytest.mark.parametrize('seed', SEEDS)
def test_peaks_are_those_of_a_dense_grid(seed):
    motion, peaks = random_motion(seed), random_motion(seed).peaks()
    t = np.concatenate((dense_times(motion, 2000), motion.knots[1:] - 1e-9))
    q, qd, qdd, qddd = motion(t)
    for exact, dense in ((peaks.velocity, np.abs(qd)), (peaks.acceleration, np.abs(qdd)),
                         (peaks.jerk, np.abs(qddd))):
        assert (exact >= dense.max(axis=0) * (1.0 - 1e-6)).all()
        assert exact == pytest.approx(dense.max(axis=0), rel=1e-3)
    assert peaks.max_position == pytest.approx(q.max(axis=0), abs=1e-6)
    assert peaks.min_position == pytest.approx(q.min(axis=0), abs=1e-6)


@pytest.mark.parametrize('seed', SEEDS)
def test_slower_by_k_has_velocity_acceleration_and_jerk_less_by_powers_of_k(seed):
    motion, k = random_motion(seed), 1.7
    slow, t = motion.time_scaled(k), np.linspace(0.01, 0.99, 97) * motion.duration
    assert slow.duration == pytest.approx(k * motion.duration, rel=1e-14)
    assert slow.via_times == pytest.approx(k * motion.via_times, rel=1e-14)
    for order, (ours, theirs) in enumerate(zip(slow(k * t), motion(t))):
        assert ours * k ** order == pytest.approx(theirs, abs=1e-9 * (1 + np.abs(theirs).max()))


@pytest.mark.parametrize('seed', SEEDS)
def test_accelerations_step_at_the_joins_of_arcs_as_reported_and_nowhere_else(seed):
    motion, h = random_motion(seed), 1e-7
    t = motion.join_times
    before, after = motion(t - h)[2], motion(t + h)[2]
    size = 1.0 + np.abs(motion(t + h)[3]).max(initial=0.0) + np.abs(
        motion(t - h)[3]).max(initial=0.0)
    assert np.abs(after - before) == pytest.approx(motion.acceleration_steps(), abs=3.0 * h * size)
    stepping = motion.step_times
    if seed % 2:  # polynomial zones
        assert len(stepping) == 0
    else:
        assert stepping.tolist() == t.tolist()


def test_note_is_all_that_noting_changes():
    motion = random_motion(0)
    noted = motion.noted('a note')
    assert (noted.note, motion.note) == ('a note', '')
    t = np.linspace(0.0, motion.duration, 11)
    for ours, theirs in zip(noted(t), motion(t)):
        assert ours.tolist() == theirs.tolist()
    assert noted.time_scaled(2.0).note == 'a note'


@pytest.mark.parametrize('seed', SEEDS[::4])
def test_the_last_via_point_is_passed_at_the_end_exactly_however_long_the_motion(seed):
    # In 10^6 s, sums of pieces round by a nanosecond or so, by which two stamps would differ.
    for factor in np.random.default_rng(seed).uniform(1e5, 1e7, 20):
        slower = random_motion(seed).time_scaled(factor)
        assert slower.via_times[-1] == slower.duration
        points = sample(slower, slower.duration / 7.0)
        assert np.diff(points.times).min() > 1e-3 * slower.duration / 7.0
