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

"""
`time_optimal`: its motion times, the bounds of every plan, prescribed durations and refusals.

Random tasks are planned once; every claim is then tested on all plans, by evaluating the motion on
a grid of 20 points a sample that meets every knot.
"""

from dataclasses import replace
from functools import cache
from itertools import count
import re

from helpers.hard_cases import HARD_CASES
from helpers.ramp_cases import blocked_task, is_connected
from helpers.random_tasks import Measured, random_task, Task
from helpers.thesis_cases import POINTS
import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.dynamics.rigid_body import (
    gravity_torque,
    inertia_matrix,
    inverse_dynamics,
)
from rrr_traj_planner.core.errors import InvalidInputError, LimitViolationError, TimingError
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.trajectory.quintic_spline import spline_through
from rrr_traj_planner.core.trajectory.torque import time_scale_for_torque
from rrr_traj_planner.planners.methods import time_optimal
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.request import PlanningRequest
from rrr_traj_planner.planners.sampling_jerk_limit import CONSTANT_JERK_FRACTION
from rrr_traj_planner.planners.tasks import JointTask

NONE = np.full(3, np.inf)
ARM, LIMITS = RobotModel(), JointLimits()
STRONG = replace(LIMITS, max_effort=[150.0, 250.0, 200.0])  # joint 2 as table 6.3 needs it
QUICK = {'max_acceleration': NONE, 'max_jerk': np.full(3, 100.0)}

HIT = 1e-9             # rad at the via points; rad, rad/s, rad/s^2 across a knot
LIMIT_ROOM = 1e-6      # relative
BETWEEN_POINTS = 1e-3  # relative, of the quintic through the sampled points
TORQUE_MISS = 2e-5     # relative, of a peak of torque between the points of its search
KEPT = 1e-9            # s, of prescribed durations
GAP = 2e-3             # relative: how far from the optimum the method may end
LIMITED = (('qd', 'max_velocity'), ('qdd', 'max_acceleration'), ('qddd', 'max_jerk'),
           ('torque', 'max_effort'))


def table(name, **request):
    return PlanningRequest([POINTS[f'{name} point {k}'][0] for k in (1, 2, 3)],
                           **{'planner_id': 'time_optimal', **request})


def through(q, **request):
    return PlanningRequest(forward_kinematics(ARM, np.asarray(q, dtype=float)),
                           **{'planner_id': 'time_optimal', **request})


def durations_of(answer):
    return np.diff(answer.via_times)


def excess(m):
    """Return the limits, position ranges and via points that a measured motion misses."""
    limits, q = m.task.limits, m.task.q[len(m.task.q) - len(m.plan.via_times):]
    found = [limit for values, limit in LIMITED
             if not (m.largest(values) <= getattr(limits, limit) * (1.0 + LIMIT_ROOM)).all()]
    if (m.q < limits.min_position - HIT).any() or (m.q > limits.max_position + HIT).any():
        found.append('range')
    if np.abs(m.plan.trajectory(m.plan.via_times)[0] - q).max() > HIT:
        found.append('via points')
    return found


def measured(limits, q, **request):
    """Return the plan through joint positions of the thesis arm, measured."""
    task = Task(0, '', ARM, limits, np.asarray(q, dtype=float), through(q, **request))
    return Measured(task, plan(ARM, limits, task.request))


# --- Motion times -----------------------------------------------------------------------------

# Table, limits, the least time of any motion whose jerk may jump (NOTES 3), what ours may take.
TIMES = [
    ('6.1', LIMITS, 2.1285, 2.16), ('6.3', STRONG, 2.5815, 2.615),
    ('6.1', replace(LIMITS, **QUICK), 1.0490, 1.07),
    ('6.3', replace(STRONG, **QUICK), 1.5389, 1.57),
    ('6.1', replace(LIMITS, max_acceleration=NONE, max_jerk=NONE), 0.9181, 0.935)]


@pytest.mark.parametrize(('name', 'limits', 'limit', 'most'), TIMES)
def test_tables_are_near_the_limit_and_not_below(name, limits, limit, most):
    answer = plan(ARM, limits, table(name))
    assert limit - 5e-5 <= answer.trajectory.duration <= most
    assert answer.note == ''


@pytest.mark.parametrize(('name', 'limits'), [('6.1', LIMITS), ('6.3', STRONG)])
def test_tables_take_at_most_nine_tenths_of_cycloid_s_time(name, limits):
    ours, cycloid = (plan(ARM, limits, table(name, planner_id=p)).trajectory.duration
                     for p in ('time_optimal', 'cycloid'))
    assert ours <= 0.9 * cycloid


@pytest.mark.parametrize(('D', 'v', 'a', 'J'), [
    (0.4, 10.0, 1.0, 1e4), (1.2, 0.5, 1.0, 1e3), (0.3, 10.0, 50.0, 5.0), (0.8, 0.4, 0.6, 3.0)])
def test_a_single_segment_takes_about_the_closed_form_of_least_time(D, v, a, J):
    # From rest to rest with piecewise constant jerk: seven pieces or fewer.
    def least(J):
        def ramped(u):  # the least time of a change of velocity from 0 to u
            return u / a + a / J if u >= a * a / J else 2.0 * np.sqrt(u / J)

        low, high = 0.0, v
        for _ in range(100):
            u = 0.5 * (low + high)
            low, high = (u, high) if u * ramped(u) < D else (low, u)
        return 2.0 * ramped(u) + max(D - u * ramped(u), 0.0) / u

    limits = replace(LIMITS, max_velocity=[v] * 3, max_acceleration=[a] * 3, max_jerk=[J] * 3,
                     max_effort=NONE)
    q = [[0.2, 1.2, 0.1], [0.2 + D, 1.2, 0.1]]
    found = plan(ARM, limits, through(q, sample_period=0.002)).trajectory
    # A ramp's mean jerk is part of its peak; one ramp in twenty is lost where the sign turns.
    mean = J / found.profiles[0].pieces.shape.peak_jerk
    assert least(J) <= found.duration <= 1.04 * least(mean)


def test_answers_do_not_depend_on_the_unit_of_time():
    # Velocities by k, accelerations by k^2, jerk by k^3: the same motion, 1 / k as long.
    free = replace(LIMITS, max_effort=NONE, max_jerk=np.full(3, 1.0))
    fast = replace(free, max_velocity=2.0 * free.max_velocity,
                   max_acceleration=4.0 * free.max_acceleration, max_jerk=8.0 * free.max_jerk)
    slow, quick = (plan(ARM, limits, table('6.1')).trajectory.duration
                   for limits in (free, fast))
    assert quick == pytest.approx(0.5 * slow, rel=GAP)


def test_lower_limits_never_make_a_motion_faster():
    times = [plan(ARM, replace(LIMITS, max_effort=LIMITS.max_effort * k),
                  table('6.1')).trajectory.duration for k in (1.0, 0.9, 0.83)]
    assert times[0] <= times[1] * (1.0 + GAP)
    assert times[1] <= times[2] * (1.0 + GAP)


# --- What every plan keeps, on random tasks ---------------------------------------------------

SEEDS = range(66)


def task_of(seed):
    """Return a random task, a third of them without jerk, a third without acceleration limits."""
    task = random_task(seed)
    change = {1: {'max_jerk': NONE}, 2: {'max_acceleration': np.where(
        np.isfinite(task.limits.max_effort), np.inf, task.limits.max_acceleration)}}
    limits = replace(task.limits, **change.get(seed // 8 % 3, {}))
    return replace(task, limits=limits, request=task.asked_of('time_optimal'))


@cache
def outcomes():
    """Return the measured plans, and the refusals with their tasks."""
    planned, refused = {}, {}
    for seed in SEEDS:
        task = task_of(seed)
        try:
            planned[seed] = Measured(task, plan(task.model, task.limits, task.request))
        except LimitViolationError as error:
            refused[seed] = (task, error)
    return planned, refused


def broken(value):
    """Return the seeds of motions for which a measure is above 0, with it."""
    found = {seed: float(np.max(value(m))) for seed, m in outcomes()[0].items()}
    return {seed: value for seed, value in found.items() if not value <= 0.0}


def test_at_least_60_tasks_are_planned_all_to_the_optimum():
    planned, _ = outcomes()
    assert len(planned) >= 60
    left = {seed: part_left(m.plan) for seed, m in planned.items()}
    assert {seed: part for seed, part in left.items() if part > 1.0} == {}


def part_left(answer):
    """Return the percentage that a plan's note says could be saved; 0 where it says nothing."""
    note = answer.trajectory.note
    if not note:
        return 0.0
    if answer.note == 'planning ended before it converged: faster motions may be possible':
        return 100.0  # no useful bound is known
    said = re.fullmatch(r'planning ended before it converged: at most ([\d.]+) % of the time '
                        r'could be saved', note)
    assert said, note
    return float(said[1])


def test_refusals_name_a_torque_that_the_straight_way_needs():
    for task, error in outcomes()[1].values():
        joint = task.model.joint_names.index(error.joint)
        k = int(re.match(r'segment (\d+): no path found', str(error))[1])
        way = np.linspace(task.q[k], task.q[k + 1], 2001)
        torque = np.abs(gravity_torque(task.model, way))[:, joint].max()
        assert error.limit == task.limits.max_effort[joint]
        assert torque >= error.limit * (1.0 - 1e-5)
        assert torque == pytest.approx(error.value, rel=2e-2)


def segment(task, k):
    """Return two poses of a random task as a task of their own."""
    return JointTask(task.model, task.limits, task.q[k:k + 2], None, 0.01)


def test_tasks_are_refused_only_where_no_cells_with_room_connect_the_poses():
    for task, error in outcomes()[1].values():
        k = int(re.match(r'segment (\d+)', str(error))[1])
        assert not is_connected(segment(task, k), margin=2.0)


@pytest.mark.parametrize('seed', range(12))
def test_where_straight_is_no_way_it_goes_around_if_there_is_another(seed):
    task = blocked_task(seed)
    try:
        trajectory = time_optimal.plan(task)
    except LimitViolationError:
        assert not is_connected(task, margin=2.0)
        return
    assert is_connected(task, margin=-2.0)
    q, qd, qdd, _ = trajectory(np.linspace(0.0, trajectory.duration, 2001))
    assert q[[0, -1]] == pytest.approx(task.points, abs=HIT)
    assert (q >= task.limits.min_position - HIT).all()
    assert (q <= task.limits.max_position + HIT).all()
    torque = np.abs(inverse_dynamics(task.model, q, qd, qdd)) / task.limits.max_effort
    assert torque.max() <= 1.0 + LIMIT_ROOM


def test_joint_3_is_refused_only_where_no_other_way_exists():
    # What gravity asks of joint 3 depends on theta_2 + theta_3 alone, which passes, on any way,
    # all that lies between its ends.
    for task, error in outcomes()[1].values():
        if error.joint != task.model.joint_names[2]:
            continue
        k = int(re.match(r'segment (\d+)', str(error))[1])
        ends = task.q[k:k + 2, 1] + task.q[k:k + 2, 2]
        q = np.zeros((2001, 3))
        q[:, 2] = np.linspace(*ends, 2001)
        assert np.abs(gravity_torque(task.model, q))[:, 2].max() >= error.limit * (1.0 - 1e-5)


def test_via_points_are_hit_and_ranges_kept_between_them():
    def miss(m):
        q = m.task.q[len(m.task.q) - len(m.plan.via_times):]
        outside = np.maximum(m.task.limits.min_position - m.q, m.q - m.task.limits.max_position)
        return max(np.abs(m.plan.trajectory(m.plan.via_times)[0] - q).max(), outside.max()) - HIT

    assert broken(miss) == {}


def test_motion_starts_and_ends_at_rest_where_it_should():
    for m in outcomes()[0].values():
        q, qd, qdd, _ = m.plan.trajectory(np.array([0.0, m.plan.trajectory.duration]))
        assert q == pytest.approx(m.task.q[[0, -1]], abs=HIT)
        assert max(np.abs(qd).max(), np.abs(qdd).max()) <= HIT
        assert m.plan.points.velocities[[0, -1]].tolist() == [[0.0] * 3] * 2
        assert m.plan.points.accelerations[[0, -1]].tolist() == [[0.0] * 3] * 2


def test_position_velocity_and_acceleration_are_continuous_across_knots():
    def jump(m):
        jumps = []
        for profile in m.plan.trajectory.profiles:
            ends, starts = profile.pieces.at(1.0), profile.pieces.at(0.0)
            jumps += [np.abs(e[:-1] - s[1:]).max(initial=0.0)
                      for e, s in zip(ends[:3], starts[:3])]
        return max(jumps) - HIT

    assert broken(jump) == {}


def steepest_jerk(ramps):
    """Return how fast jerk changes: it rises as a sine does, in (1 - cruise) / 2 of a ramp."""
    rising = (1.0 - ramps.shape.constant_jerk_fraction) * ramps.duration
    return (ramps.peaks()[1] * np.pi / rising).max()


def test_jerk_is_zero_at_every_knot_and_continuous():
    def jump(m):
        steepest = [0.0 if m.plan.via_times[-1] == 0.0 else steepest_jerk(p.pieces)
                    for p in m.plan.trajectory.profiles]
        at_knots = max(np.abs(np.concatenate((p.pieces.at(0.0)[3], p.pieces.at(1.0)[3]))).max()
                       for p in m.plan.trajectory.profiles)
        scale = m.plan.peaks.jerk.max()
        slope = np.abs(np.diff(m.qddd, axis=0)) - steepest * np.diff(m.t)[:, np.newaxis]
        return max(at_knots, slope.max()) - 1e-9 * scale

    assert broken(jump) == {}


def test_jerk_cruises_only_where_every_joint_s_own_limit_shapes_the_motion():
    cruises = {True: set(), False: set()}
    for m in outcomes()[0].values():
        if m.plan.via_times[-1] > 0.0:
            cruises[bool(np.isfinite(m.task.limits.max_jerk).all())] |= {
                p.pieces.shape.constant_jerk_fraction for p in m.plan.trajectory.profiles}
    assert cruises[False] == {0.0}
    assert CONSTANT_JERK_FRACTION in cruises[True]


@pytest.mark.parametrize(('values', 'limit'), LIMITED)
def test_limits_are_kept_over_the_continuous_motion(values, limit):
    assert broken(lambda m: m.largest(values) - getattr(m.task.limits, limit) * (
        1.0 + LIMIT_ROOM)) == {}


def test_quintic_through_the_points_keeps_velocity_and_acceleration_limits():
    def above(m):
        times = m.plan.points.times
        t = (times[:-1, np.newaxis] + np.diff(times)[:, np.newaxis] * np.linspace(
            0.0, 1.0, 21)).ravel()
        _, qd, qdd, _ = spline_through(m.plan.points).at(t)
        room = 1.0 + BETWEEN_POINTS
        return max((np.abs(qd).max(axis=0) - room * m.task.limits.max_velocity).max(),
                   (np.abs(qdd).max(axis=0) - room * m.task.limits.max_acceleration).max())

    assert broken(above) == {}


def test_peaks_are_those_of_the_dense_grid():
    for m in outcomes()[0].values():
        peaks = m.plan.peaks
        for exact, dense in ((peaks.velocity, m.largest('qd')),
                             (peaks.acceleration, m.largest('qdd')),
                             (peaks.jerk, m.largest('qddd')),
                             (peaks.max_position, m.q.max(axis=0)),
                             (-peaks.min_position, -m.q.min(axis=0))):
            assert (dense <= exact + 1e-9 * (1.0 + np.abs(exact))).all()
        assert (m.largest('torque') <= m.plan.effort * (1.0 + TORQUE_MISS) + 1e-9).all()
        # Between two points of the grid, a step apart, a value rises by half a step at most.
        half = 0.5 * np.diff(m.t).max()
        assert (peaks.velocity <= m.largest('qd') + half * peaks.acceleration + HIT).all()
        assert (peaks.acceleration <= m.largest('qdd') + half * peaks.jerk + HIT).all()


def stops_everywhere(task):
    """Return how long full-period cycloids take from stop to stop, jerk as of a chain of ramps."""
    limits, s = task.limits, np.linspace(0.0, 1.0, 801)[:, np.newaxis]
    inertia = np.diagonal(inertia_matrix(task.model, task.q), axis1=1, axis2=2)
    torque = limits.max_effort + np.abs(gravity_torque(task.model, task.q))
    level = np.minimum(limits.max_acceleration, (torque / inertia).max(axis=0))
    samples = np.where(np.isfinite(limits.max_acceleration), 4.0, 2.0)
    jerk = np.minimum(limits.max_jerk, np.pi * level / (samples * task.request.sample_period))
    total = 0.0
    for start, end in zip(task.q[:-1], task.q[1:]):
        D = end - start
        q = start + D * (s - np.sin(2.0 * np.pi * s) / (2.0 * np.pi))
        qd, qdd = D * (1.0 - np.cos(2.0 * np.pi * s)), D * 2.0 * np.pi * np.sin(2.0 * np.pi * s)
        gravity = gravity_torque(task.model, q)
        moving = inverse_dynamics(task.model, q, qd, qdd) - gravity
        room = np.maximum(limits.max_effort - np.sign(moving) * gravity, 0.0)
        with np.errstate(divide='ignore', invalid='ignore'):
            torque = np.sqrt(np.nanmax(np.abs(moving) / room))
        # A chain of ramps between samples of a sine has pi / 2 times the sine's jerk.
        total += max((2.0 * np.abs(D) / limits.max_velocity).max(),
                     np.sqrt((2.0 * np.pi * np.abs(D) / limits.max_acceleration).max()),
                     np.cbrt((2.0 * np.pi ** 3 * np.abs(D) / jerk).max()), torque)
    return total


def test_motion_is_never_slower_than_with_a_stop_at_every_via_point():
    def slower(m):
        least = 2.5 * m.task.request.sample_period  # too few samples for more speed
        return m.plan.trajectory.duration - max(stops_everywhere(m.task), least)

    assert broken(slower) == {}


def test_motion_is_much_faster_than_cycloid_on_most_tasks_and_slower_on_none():
    ratios = {}
    for seed, m in list(outcomes()[0].items())[::4]:
        try:
            cycloid = plan(m.task.model, m.task.limits, m.task.asked_of('cycloid'))
        except (LimitViolationError, InvalidInputError):
            continue
        if m.plan.via_times[-1] > 20.0 * m.task.request.sample_period:
            ratios[seed] = float(m.plan.via_times[-1] / cycloid.via_times[-1])
    assert {seed: ratio for seed, ratio in ratios.items() if ratio > 1.0} == {}
    assert np.median(list(ratios.values())) <= 0.75


def test_same_request_gives_the_same_answer_bit_for_bit():
    planned, _ = outcomes()
    for seed in list(planned)[::12]:
        first, task = planned[seed].plan, task_of(seed)
        again = plan(task.model, task.limits, task.request)
        for name in ('times', 'positions', 'velocities', 'accelerations'):
            assert getattr(first.points, name).tobytes() == getattr(again.points, name).tobytes()
        assert first.via_times.tobytes() == again.via_times.tobytes()
        assert first.effort.tobytes() == again.effort.tobytes()


# --- Special tasks ----------------------------------------------------------------------------

SMOOTH = np.stack([0.8 + 0.6 * np.sin(np.linspace(0.0, 9.0, 40)),
                   1.5 + 0.3 * np.cos(np.linspace(0.0, 13.0, 40)),
                   0.4 * np.sin(np.linspace(0.0, 17.0, 40))], axis=1)
A, B, C = [0.3, 1.4, 0.0], [1.0, 1.8, 0.3], [0.2, 1.3, -0.5]
NEAR = [1.0 + 6e-5, 1.8 - 6e-5, 0.3 + 5e-5]  # 1e-4 rad from B
SPECIAL = {
    'close pair': [A, B, NEAR, C], 'close pair at the start': [B, NEAR, A],
    'close pair alone': [B, NEAR], 'close pair and back': [A, B, NEAR, B, C],
    'repeated points': [A, A, B, B, B, C, C], 'reversal': [A, B, A, B], 'forty points': SMOOTH,
    'one joint moves': [A, [0.3, 1.4, 0.9], [0.3, 1.4, 0.2]],
    'points at the ends of ranges': [A, [0.0, 1.6, 0.2], [np.pi / 2, 1.5, -0.3],
                                     [0.0, 1.3, 0.1], [0.0, 1.5, 0.4]],
    'a joint stays at the end of its range': [[0.0, 1.3, 0.1], [0.0, 1.8, -0.3], [0.0, 1.5, 0.2]],
}


@pytest.mark.parametrize('name', SPECIAL)
@pytest.mark.parametrize('limits', [LIMITS, replace(LIMITS, **QUICK)], ids=['a', 'torque'])
def test_special_tasks_are_planned_to_the_optimum_within_every_limit(limits, name):
    m = measured(limits, SPECIAL[name])
    assert excess(m) == []
    assert part_left(m.plan) < 1.0


@pytest.mark.parametrize('name', HARD_CASES)
def test_hard_cases_are_planned_within_every_limit(name):
    q, changes = HARD_CASES[name]
    assert excess(measured(replace(LIMITS, **changes), q)) == []


def test_repeated_points_share_their_time_and_cost_none():
    once, more = (measured(LIMITS, q).plan for q in ([A, B, C], [A, A, B, B, C]))
    assert (once.via_times == more.via_times[[0, 2, 4]]).all()
    assert more.via_times[0] == more.via_times[1] == 0.0
    assert more.via_times[2] == more.via_times[3]


@pytest.mark.parametrize('limits', [LIMITS, replace(LIMITS, **QUICK)], ids=['a', 'torque'])
def test_a_point_in_the_way_costs_hardly_anything_where_it_is_hardly_off_it(limits):
    # Every joint turns at B: a point next to it costs the little time of going there.
    with_pair, without = (measured(limits, q).plan.via_times[-1]
                          for q in ([A, B, NEAR, C], [A, B, C]))
    assert without * (1.0 - GAP) <= with_pair <= 1.01 * without


@pytest.mark.parametrize('effort', [100.0, 20.0, 5.0, 1.0])
def test_joint_1_alone_is_moved_in_time_however_weak_its_motor(effort):
    q = [[0.2, 1.4, 0.1], [1.2, 1.4, 0.1]]
    limits = replace(LIMITS, max_velocity=NONE, max_acceleration=NONE, max_jerk=NONE,
                     max_effort=[effort, 250.0, 200.0])
    m = measured(limits, q)
    assert excess(m) == []
    # full torque forth and back at the inertia of the two poses; ramps lose a part of it
    most = 1.05 * 2.0 * np.sqrt(inertia_matrix(ARM, q[0])[0, 0] / effort)
    assert m.plan.via_times[-1] <= most


@pytest.mark.parametrize('joint_1', [-1.4, 1.4])
def test_ways_around_do_not_depend_on_where_joint_1_is(joint_1):
    q, torque = blocked_way()
    limits = replace(LIMITS, min_position=[-3.0, *LIMITS.min_position[1:]],
                     max_position=[3.0, *LIMITS.max_position[1:]],
                     max_effort=[150.0, 0.5 * (max(torque[[0, -1]]) + torque.max()), 200.0])
    aside = np.array([joint_1, 0.0, 0.0])
    # a range that zero is not in
    moved = replace(limits, min_position=[joint_1 + 0.3, *LIMITS.min_position[1:]],
                    max_position=[joint_1 + 1.2, *LIMITS.max_position[1:]])
    if joint_1 < 0.0:
        moved = replace(moved, min_position=[-2.0, *LIMITS.min_position[1:]],
                        max_position=[-0.1, *LIMITS.max_position[1:]])
    here, there = (measured(x, q + d).plan.via_times[-1] for x, d in (
        (limits, 0.0), (moved, aside)))
    assert there == pytest.approx(here, rel=GAP)


def test_a_start_state_is_the_first_point_of_the_same_problem():
    away = plan(ARM, LIMITS, through([B, C], start=A))
    whole = plan(ARM, LIMITS, through([A, B, C]))
    assert away.trajectory.duration == pytest.approx(whole.trajectory.duration, rel=GAP)
    assert len(away.via_times) == 2
    assert away.trajectory(np.zeros(1))[0][0] == pytest.approx(A, abs=HIT)
    # no stop at the first via point
    assert np.abs(away.trajectory(away.via_times[:1])[1]).max() > 0.01


def test_a_joint_that_need_not_move_may_and_ends_where_it_was():
    m = measured(LIMITS, [A, [0.3, 1.4, 0.9], A])
    assert excess(m) == []
    assert m.q[[0, -1], 0] == pytest.approx([0.3, 0.3], abs=HIT)


@pytest.mark.parametrize('heavy', [0, 1, 2])
def test_gravity_may_take_99_percent_of_a_torque_at_a_via_point(heavy):
    lighter = [[0.8, 1.57, -0.4], [0.5, 1.5, 0.0]]
    q = np.insert(lighter, heavy, C, axis=0)
    holding = np.abs(gravity_torque(ARM, q))[:, 1]
    assert holding.argmax() == heavy
    limits = replace(LIMITS, max_effort=[150.0, holding[heavy] / 0.99, 200.0])
    assert excess(measured(limits, q)) == []


def blocked_way():
    """Return two poses that joint 2 can hold, and a torque that it lacks straight between."""
    q = np.array([[0.88, 1.29, -1.47], [0.51, 1.56, 0.91]])
    way = np.linspace(*q, 401)
    torque = np.abs(gravity_torque(ARM, way))[:, 1]
    return q, torque


def test_a_way_that_gravity_blocks_is_gone_around():
    q, torque = blocked_way()
    limit = 0.5 * (max(torque[[0, -1]]) + torque.max())
    assert torque.max() > 1.02 * limit  # straight is no way
    limits = replace(LIMITS, max_effort=[150.0, limit, 200.0])
    with pytest.raises(LimitViolationError, match='along the segment'):
        plan(ARM, limits, through(q, planner_id='cycloid'))
    m = measured(limits, q)
    assert excess(m) == []
    straight = q[0] + (m.q[:, :1] - q[0, 0]) / (q[1, 0] - q[0, 0]) * (q[1] - q[0])
    assert np.abs(m.q - straight).max() > 0.1


def test_a_joint_with_neither_acceleration_nor_effort_limit_is_refused_by_name():
    limits = replace(LIMITS, max_acceleration=[1.0, np.inf, 1.0],
                     max_effort=[150.0, np.inf, 200.0])
    with pytest.raises(InvalidInputError, match=(
            'fastest motion needs an acceleration or an effort limit on every joint, '
            'joint_2 has neither')):
        plan(ARM, limits, table('6.1'))
    plan(ARM, replace(limits, max_effort=STRONG.max_effort), table('6.1'))


# --- Prescribed durations ---------------------------------------------------------------------

DURATIONS = [
    ([3.0, 3.0], [A, B, C]), ([2.5, 6.0], [A, B, C]), ([9.0, 2.4], [A, B, C]),
    ([np.nan, 4.0], [A, B, C]), ([3.0, np.nan], [A, B, C]),
    ([2.5, np.nan, 3.0, np.nan], [A, B, C, B, A]), ([np.nan, 2.0, np.nan], [A, B, B, C]),
    ([5.0], [A, B])]


@pytest.mark.parametrize(('asked', 'q'), DURATIONS)
@pytest.mark.parametrize('limits', [LIMITS, replace(STRONG, **QUICK)], ids=['a', 'torque'])
def test_prescribed_durations_are_kept(limits, asked, q):
    m, given = measured(limits, q, segment_durations=asked), ~np.isnan(asked)
    assert durations_of(m.plan)[given] == pytest.approx(np.array(asked)[given], abs=KEPT)
    assert excess(m) == []


def test_a_free_segment_beside_a_prescribed_one_takes_no_longer_than_from_stop_to_stop():
    def alone(q):
        return plan(ARM, LIMITS, through(q)).via_times[-1]

    for asked, k, q in (([np.nan, 4.0], 0, [A, B]), ([3.0, np.nan], 1, [B, C])):
        free = durations_of(plan(ARM, LIMITS, through([A, B, C], segment_durations=asked)))[k]
        assert free <= alone(q) * (1.0 + GAP)
        assert free >= 0.3 * alone(q)


def test_a_fastest_plan_s_own_durations_given_for_one_segment_leave_the_other_as_it_was():
    free = durations_of(plan(ARM, LIMITS, table('6.1')))
    for k in range(2):
        asked = np.where(np.arange(2) == k, 1.0001 * free, np.nan)
        found = durations_of(plan(ARM, LIMITS, table('6.1', segment_durations=asked)))
        assert found[1 - k] == pytest.approx(free[1 - k], rel=2.0 * GAP)


@pytest.mark.parametrize('slower', [1.2, 2.0, 5.0])
@pytest.mark.parametrize('limits', [LIMITS, replace(STRONG, **QUICK)], ids=['a', 'torque'])
def test_prescribed_motions_are_no_harder_than_the_fastest_one_slowed_down(limits, slower):
    fastest = plan(ARM, limits, table('6.1'))
    asked = slower * durations_of(fastest)
    gentle = plan(ARM, limits, table('6.1', segment_durations=asked))
    scale = np.where(np.isinf(limits.max_acceleration), 1.0, limits.max_acceleration)
    slowed = (fastest.peaks.acceleration / scale).max() / slower ** 2
    assert (gentle.peaks.acceleration / scale).max() <= slowed * (1.0 + 1e-6)


def test_the_gentlest_motion_from_rest_to_rest_is_near_the_least_peak_there_is():
    # D = a (T / 2)^2 at constant acceleration forth and back: no motion has a lower peak. Of 20
    # ramps, two of which pass through zero: v = 9 a h half-way, D = 90 a h^2, h = T / 20.
    q, T = [A, [1.3, 1.4, 0.0]], 4.0
    gentle = plan(ARM, LIMITS, through(q, segment_durations=[T]))
    assert 4.0 / T ** 2 <= gentle.peaks.acceleration[0] <= 1.02 * (400.0 / 90.0) / T ** 2


@pytest.mark.parametrize('asked', [[0.5, 0.5], [1.0, 20.0], [np.nan, 0.4], [0.3, np.nan]])
@pytest.mark.parametrize('limits', [LIMITS, replace(LIMITS, **QUICK)], ids=['a', 'torque'])
def test_durations_too_short_are_refused_with_feasible_ones(limits, asked):
    free = durations_of(plan(ARM, limits, table('6.1')))
    asked = np.array(asked) * (0.9 * free if np.isinf(limits.max_acceleration).all() else 1.0)
    with pytest.raises(TimingError, match=(
            r'^segment_durations \[.*\] s are too short: the least feasible are')) as refusal:
        plan(ARM, limits, table('6.1', segment_durations=asked))
    offered = np.array(refusal.value.least_durations)
    given = ~np.isnan(asked)
    assert (offered[given] >= asked[given]).all()
    answer = plan(ARM, limits, table('6.1', segment_durations=offered))
    assert durations_of(answer) == pytest.approx(offered, abs=KEPT)


def test_durations_that_are_offered_waste_no_more_than_a_hundredth():
    free = durations_of(plan(ARM, LIMITS, table('6.1')))
    with pytest.raises(TimingError) as refusal:
        plan(ARM, LIMITS, table('6.1', segment_durations=0.9 * free))
    assert np.sum(refusal.value.least_durations) <= 1.01 * free.sum()


def test_durations_refused_are_truly_too_short():
    # rest to rest over 1 rad at 1 rad/s^2: no motion takes less than 2 s
    q = [A, [1.3, 1.4, 0.0]]
    with pytest.raises(TimingError):
        plan(ARM, LIMITS, through(q, segment_durations=[1.999]))
    fastest = plan(ARM, LIMITS, through(q)).via_times[-1]
    with pytest.raises(TimingError):
        plan(ARM, LIMITS, through(q, segment_durations=[fastest * (1.0 - 2.0 * GAP)]))
    assert plan(ARM, LIMITS, through(
        q, segment_durations=[fastest * (1.0 + 1e-6)])).via_times[-1] == pytest.approx(
            fastest, rel=1e-5)


def test_cycloid_refuses_durations_of_some_segments_only_by_name():
    with pytest.raises(InvalidInputError, match=(
            r'segment_durations\[1\] is nan: planner cycloid takes every duration or none')):
        plan(ARM, LIMITS, table('6.1', planner_id='cycloid', segment_durations=[3.0, np.nan]))


def test_durations_that_are_all_nan_are_as_none():
    free, none = (plan(ARM, LIMITS, table('6.1', segment_durations=d))
                  for d in ([np.nan, np.nan], None))
    assert (free.via_times == none.via_times).all()


# --- Planning that is stopped early -----------------------------------------------------------

def stops_after(calls):
    """Return a function that answers True from so many calls on."""
    counter = count()
    return lambda: next(counter) >= calls


@pytest.mark.parametrize('calls', [0, 1, 3, 5])
@pytest.mark.parametrize('limits', [LIMITS, replace(LIMITS, **QUICK)], ids=['a', 'torque'])
def test_planning_stopped_early_gives_a_valid_motion_and_says_how_far_it_may_be(limits, calls):
    best = plan(ARM, limits, through([A, B, C])).via_times[-1]
    m = measured(limits, [A, B, C], should_stop=stops_after(calls))
    assert excess(m) == []
    part = part_left(m.plan)
    assert 0.0 < part <= 100.0
    # the bound is sound, but for a problem that torque makes not quite convex
    assert m.plan.via_times[-1] * (1.0 - 0.01 * part) <= best * (1.0 + GAP)


def test_more_time_to_plan_gives_faster_motions():
    times = [measured(LIMITS, [A, B, C], should_stop=stops_after(k)).plan.via_times[-1]
             for k in (0, 4, 8, 1000)]
    assert (np.diff(times) <= 1e-9).all()
    assert times[-1] < 0.9 * times[0]


def test_prescribed_durations_are_kept_even_when_planning_is_stopped_early():
    for calls in (0, 2, 5):
        m = measured(LIMITS, [A, B, C], segment_durations=[5.0, 6.0],
                     should_stop=stops_after(calls))
        assert excess(m) == []
        assert durations_of(m.plan) == pytest.approx([5.0, 6.0], abs=KEPT)


# Gravity alone is 1.04 times joint 3's limit on the way of the fastest motion.
WEAK_JOINT_3 = JointLimits(
    min_position=[-1.40188418, 0.84157753, -1.23443453],
    max_position=[0.0531041, 2.30419673, 1.1562909],
    max_velocity=[2.81122301, 2.4985027, 0.51311566],
    max_acceleration=[1.46388941, 0.51223958, 0.68577841], max_jerk=NONE,
    max_effort=[3.08132901, 157.30897877, 54.64090592])
HURRIED_TIPS = [(0.46996464, -0.02130729, 0.88146230), (0.29513201, -0.10969616, 1.06199934),
                (0.43890897, -0.58788287, 1.03682936), (0.51175404, -0.05552639, 0.53294995)]


def test_a_motion_that_hurries_past_a_pose_has_closer_points_instead_of_being_slowed():
    limits = WEAK_JOINT_3  # no slower motion on the same way keeps them
    found = plan(ARM, limits, PlanningRequest(HURRIED_TIPS, planner_id='time_optimal'))
    assert np.isinf(time_scale_for_torque(ARM, limits, found.trajectory).value[2])
    assert np.diff(found.points.times).min() <= 0.0055 and 'slower' not in found.note
    t = np.linspace(0.0, found.points.times[-1], 20_001)
    q, qd, qdd, _ = spline_through(found.points).at(t)
    assert (np.abs(qd) <= limits.max_velocity * (1.0 + BETWEEN_POINTS)).all()
    assert (np.abs(qdd) <= limits.max_acceleration * (1.0 + BETWEEN_POINTS)).all()
    assert (found.effort <= limits.max_effort * (1.0 + LIMIT_ROOM)).all()


@pytest.mark.parametrize('slower', [1.2, 3.0, 30.0])
def test_durations_that_leave_no_hurry_past_a_pose_are_kept_on_another_way(slower):
    fastest = plan(ARM, WEAK_JOINT_3, PlanningRequest(HURRIED_TIPS, planner_id='time_optimal'))
    asked = slower * durations_of(fastest)
    try:
        found = plan(ARM, WEAK_JOINT_3, PlanningRequest(
            HURRIED_TIPS, planner_id='time_optimal', segment_durations=asked))
    except TimingError:
        assert slower < 3.0  # the ways around may take longer than asked
        return
    assert durations_of(found) == pytest.approx(asked, abs=KEPT)
    q = fastest.trajectory(fastest.via_times)[0]
    task = Task(0, '', ARM, WEAK_JOINT_3, q, PlanningRequest(HURRIED_TIPS))
    assert excess(Measured(task, found)) == []


def test_long_durations_are_kept_where_the_shortest_way_is_held_but_for_a_millionth():
    q = [(0.1, 1.3, 0.7), (1.2, 1.4, 0.4), (1.3, 0.8, 0.8), (0.2, 1.6, 0.4), (0.4, 0.7, 0.8),
         (1.5, 0.8, 0.4), (1.0, 0.8, -0.1), (0.9, 1.4, 0.0), (0.8, 0.8, 0.6), (1.1, 0.7, 0.3)]
    m = measured(LIMITS, q, segment_durations=[20.8] * 9, velocity_scaling=0.3)
    assert durations_of(m.plan) == pytest.approx([20.8] * 9, abs=KEPT)
    assert excess(m) == []
