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

"""Whether motions of piecewise linear jerk keep their limits, against dense evaluation."""

from dataclasses import replace

from helpers.friction_arms import with_friction
from helpers.spline_cases import ARM, LIMITS, NONE, random_motion, share_of
import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.dynamics.motor_torque import motor_torque
from rrr_traj_planner.core.dynamics.rigid_body import inverse_dynamics
from rrr_traj_planner.planners.joint_timing.within_limits import (
    beyond_range,
    fitted,
    kinematic_time_scale,
    torque_fits,
)
from rrr_traj_planner.planners.tasks import JointTask

SEEDS = range(12)
WIDE = JointLimits([-40.0] * 3, [40.0] * 3, NONE, NONE, NONE, NONE)
SAMPLES = 4001           # in a motion
BETWEEN = 5e-4         # relative, of peaks between two samples
RANGE = 1e-4           # rad, likewise


class Case:
    """A random motion, and what it requires on a dense grid."""

    def __init__(self, seed):
        self.mesh, self.points, self.motion = random_motion(seed)
        self.trajectory = self.mesh.trajectory(self.points, self.motion)
        self.q, self.qd, self.qdd, self.jerk, self.torque = dense(self.trajectory)

    def task(self, **limits):
        return JointTask(ARM, replace(WIDE, **limits), self.points, None, 0.01)

    def largest(self, name):
        return np.abs(getattr(self, name)).max(axis=0)


def dense(trajectory):
    """Return position, velocity, acceleration, jerk and torque on a dense mesh."""
    t = np.union1d(np.linspace(0.0, trajectory.duration, SAMPLES), trajectory.knots)
    q, qd, qdd, jerk = trajectory(t)
    return q, qd, qdd, jerk, inverse_dynamics(ARM, q, qd, qdd)


def within(task, trajectory, factor=1.0):
    """Return whether a motion keeps all limits but the ranges on a dense mesh."""
    _, *values = dense(trajectory)
    limits = task.limits
    bounds = (limits.max_velocity, limits.max_acceleration, limits.max_jerk, limits.max_effort)
    return all((np.abs(x).max(axis=0) <= factor * bound).all() for x, bound in zip(values, bounds))


BOUNDED = [('max_velocity', 'qd', 1), ('max_acceleration', 'qdd', 2), ('max_jerk', 'jerk', 3)]


@pytest.mark.parametrize('seed', SEEDS)
@pytest.mark.parametrize(('limit', 'values', 'power'), BOUNDED)
def test_time_scale_is_the_root_of_the_excess(seed, limit, values, power):
    case = Case(seed)
    for part in (0.5, 0.9, 1.3):
        limits = np.append(part, [2.0, 2.0]) * case.largest(values)
        task = case.task(**{limit: limits})
        assert kinematic_time_scale(task, case.trajectory) == pytest.approx(
            part ** (-1.0 / power), rel=BETWEEN)


@pytest.mark.parametrize('seed', SEEDS)
def test_motions_within_their_limits_are_returned_unchanged(seed):
    case = Case(seed)
    more = 1.0 + BETWEEN
    task = case.task(max_velocity=more * case.largest('qd'), max_jerk=more * case.largest('jerk'),
                     max_effort=more * case.largest('torque'),
                     max_acceleration=more * case.largest('qdd'))
    assert torque_fits(task, case.trajectory)
    assert fitted(task, case.trajectory, may_scale=False) is case.trajectory


@pytest.mark.parametrize('seed', SEEDS)
@pytest.mark.parametrize('part', [0.98, 0.7])
def test_motions_beyond_a_limit_are_slowed_as_a_whole_just_enough(seed, part):
    case = Case(seed)
    strong = np.maximum(case.largest('torque'),
                        1.05 * share_of(case.task(max_effort=[1.0] * 3), case.q).max())
    task = case.task(max_velocity=part * case.largest('qd'), max_effort=strong)
    slowed = fitted(task, case.trajectory, may_scale=True)
    assert within(task, slowed, 1.0 + BETWEEN)
    factor = slowed.duration / case.trajectory.duration
    assert slowed.via_times == pytest.approx(factor * case.trajectory.via_times)
    s = np.linspace(0.0, 1.0, 101)
    assert slowed(s * slowed.duration)[0] == pytest.approx(
        case.trajectory(s * case.trajectory.duration)[0], abs=1e-9)
    assert not within(task, case.trajectory.time_scaled(factor * (1.0 - 1e-3)))
    assert fitted(task, case.trajectory, may_scale=False) is None


@pytest.mark.parametrize('seed', SEEDS)
@pytest.mark.parametrize('part', [0.99, 0.8])
def test_torque_that_is_exceeded_is_slowed_where_gravity_leaves_a_margin_else_refused(seed, part):
    case = Case(seed)
    task = case.task(max_effort=part * case.largest('torque'))
    assert not torque_fits(task, case.trajectory)
    slowed = fitted(task, case.trajectory, may_scale=True)
    share = share_of(task, case.q).max()
    if slowed is None:
        assert share > 1.0 - 1e-3
        return
    assert share < 1.0
    assert within(task, slowed, 1.0 + BETWEEN)
    factor = slowed.duration / case.trajectory.duration
    assert not within(task, case.trajectory.time_scaled(factor * (1.0 - 1e-2)))


def test_both_outcomes_of_torque_occur():
    shares = []
    for seed in SEEDS:
        case = Case(seed)
        for part in (0.99, 0.8):
            shares.append(share_of(case.task(max_effort=part * case.largest('torque')),
                                   case.q).max())
    assert 3 <= sum(share > 1.0 for share in shares) <= len(shares) - 3


def hurried():
    """Return a motion that sinks past poses that it could not stop at, and its task."""
    for seed in range(200):
        case = Case(seed)
        task = case.task(max_effort=(1.0 + BETWEEN) * case.largest('torque'))
        if share_of(task, case.q).max() > 1.05:
            return case, task
    raise AssertionError('no such motion')


def test_a_motion_past_a_pose_that_cannot_be_held_is_accepted_but_not_slowed():
    case, task = hurried()
    assert fitted(task, case.trajectory, may_scale=True) is case.trajectory
    slower = replace(task, limits=replace(task.limits, max_velocity=0.5 * case.largest('qd')))
    assert fitted(slower, case.trajectory, may_scale=True) is None
    weaker = replace(task, limits=replace(task.limits, max_effort=0.98 * task.limits.max_effort))
    assert not torque_fits(weaker, case.trajectory)
    assert fitted(weaker, case.trajectory, may_scale=True) is None


@pytest.mark.parametrize('seed', SEEDS)
def test_beyond_range_is_what_each_joint_leaves_it_by_in_each_segment(seed):
    case = Case(seed)
    low, high = (np.quantile(case.q, part, axis=0) for part in (0.2, 0.8))
    task = case.task(min_position=low, max_position=high)
    found, starts = beyond_range(task, case.trajectory), case.trajectory.via_times
    for k, (start, end) in enumerate(zip(starts[:-1], starts[1:])):
        q = case.trajectory(np.linspace(start, end, SAMPLES))[0]
        expected = np.maximum([q.max(axis=0) - high, low - q.min(axis=0)], 0.0)
        assert found[:, k] == pytest.approx(expected, abs=RANGE)
    assert found.max() > 1e-2


@pytest.mark.parametrize('seed', SEEDS)
@pytest.mark.parametrize('side', ['min_position', 'max_position'])
def test_motions_that_leave_a_range_are_not_mended_by_slowing(seed, side):
    case = Case(seed)
    for j in range(3):
        ends = {'min_position': np.full(3, -40.0), 'max_position': np.full(3, 40.0)}
        sign, edge = (1.0, case.q.min(axis=0)) if side == 'min_position' else (
            -1.0, case.q.max(axis=0))
        ends[side][j] = edge[j] + sign * 1e-3
        assert fitted(case.task(**ends), case.trajectory, may_scale=True) is None
        ends[side][j] = edge[j] - sign * RANGE
        assert fitted(case.task(**ends), case.trajectory, may_scale=True) is case.trajectory


def test_without_torque_limits_every_motion_fits_them():
    case = Case(0)
    assert torque_fits(case.task(), case.trajectory)
    assert not torque_fits(replace(case.task(), limits=replace(LIMITS, max_effort=[1.0] * 3)),
                           case.trajectory)


@pytest.mark.parametrize('seed', range(20))
@pytest.mark.parametrize('slower', [1e-5, 6e-4])
def test_a_motion_that_needs_more_torque_if_slower_is_not_slowed_beyond_its_limit(slower, seed):
    # Slower, inertia takes less from the torque of gravity and viscous friction in this motion.
    mesh, points, motion = random_motion(18)
    trajectory, arm = mesh.trajectory(points, motion), with_friction(ARM, seed, viscous=20.0)
    t = np.linspace(0.0, trajectory.duration, 40001)

    def most(motion):
        states = motion(t * (motion.duration / trajectory.duration))[:3]
        return np.abs(motor_torque(arm, *states)).max(axis=0)

    now, later = most(trajectory), most(trajectory.time_scaled(1.0 + slower))
    joint = int((later / now).argmax())
    if later[joint] <= now[joint]:
        pytest.skip('this arm needs less torque for a slower motion')
    limits = replace(WIDE, max_effort=np.where(np.arange(3) == joint, now, np.inf),
                     max_velocity=np.abs(trajectory(t)[1]).max(axis=0) / (1.0 + slower))
    found = fitted(JointTask(arm, limits, points, None, 0.01), trajectory, True)
    assert found is None or most(found)[joint] <= (1.0 + 1.2e-7) * now[joint]
