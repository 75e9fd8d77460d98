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

"""The script `planner` in a process of its own: every error code, and what an answer is like."""

from __future__ import annotations

from math import inf, nan, pi
import re
import signal

from helpers.places import CONFIG
from helpers.plan_requests import (
    is_refused,
    NAMES,
    plan_request,
    points_of,
    SECOND,
    stamps,
    START,
    TABLE_6_1,
    TABLE_6_3,
)
from helpers.scripts import python, Script, script
import numpy as np
import pytest
from rcl_interfaces.srv import GetParameters
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.control.trajectory_validation import check_trajectory
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.trajectory.quintic_spline import spline_through
from rrr_traj_planner.nodes.arm_node.arm_messages import incoming_trajectory
from rrr_traj_planner_interfaces.srv import PlanTrajectory

CODES = PlanTrajectory.Response
INVALID, BAD_START = CODES.INVALID_GOAL_CONSTRAINTS, CODES.START_STATE_INVALID

# Rounding of a few thousand operations on numbers of about 1.
ROUNDING = 1e-9

# A planner that fails, and one that never ends and says that it has begun.
BUGS = """
import sys, threading
from rrr_traj_planner.planners.registration import register
@register('broken')
def broken(task): raise RuntimeError('no idea')
@register('endless')
def endless(task): print('begun', flush=True); threading.Event().wait()
from rrr_traj_planner.nodes.scripts.planner import main
sys.exit(main())
"""


@pytest.fixture(scope='module')
def ask(module_ros):
    """Return a function that has the planner's process answer a request."""
    with Script(script('planner'), '--ros-args', '--log-level', 'error') as planner:
        yield lambda request: module_ros.call(PlanTrajectory, 'plan_trajectory', request)
        assert planner.process.poll() is None


def assert_refused(ask, request, code, text, via_point=-1):
    """Assert that a request is refused, and the node continues as before."""
    is_refused(ask(request), code, text, via_point)
    assert ask(plan_request()).error_code == CODES.SUCCESS


# Refusals


@pytest.mark.parametrize(('points', 'text', 'via_point'), [
    (TABLE_6_3, 'via point 2: joint_2 needs 218.9 N m to hold, limit 200 N m', 2),
    ((TABLE_6_1[0], (1.0, -0.5, 0.9)), 'via point 1: joint_1 would be at -0.463648 rad (elbow '
     'up), limits 0 to 1.5708 rad', 1)])
def test_via_point_that_breaks_a_limit_is_blamed(ask, points, text, via_point):
    assert_refused(ask, plan_request(points), CODES.GOAL_CONSTRAINTS_VIOLATED, text, via_point)


@pytest.mark.parametrize(('point', 'text'), [
    ((3.0, 0.0, 0.5), "via point 1: (3, 0, 0.5) m is 3 m from the shoulder, beyond the arm's "
     'reach of 1.6 m: it misses by 1.4 m'),
    ((0.05, 0.0, 0.5), 'nearer than the arm can fold, 0.2 m: it misses by 0.15 m')])
def test_point_out_of_reach_is_blamed_with_its_distance(ask, point, text):
    assert_refused(ask, plan_request((TABLE_6_1[0], point)), CODES.NO_IK_SOLUTION, text, 1)


@pytest.mark.parametrize('planner_id', ['cycloid', 'cycloid_approach_a'])
@pytest.mark.parametrize('asked', [(0.1, 2.0), (1.0, 0.9)])
def test_short_durations_are_refused_with_feasible_ones(ask, planner_id, asked):
    request = plan_request(segment_durations=list(asked), planner_id=planner_id)
    refused = ask(request)
    is_refused(refused, CODES.PLANNING_FAILED, 'the least feasible')
    *_, offered = re.findall(r'\[([^]]+)\] s', refused.message)
    request.segment_durations = [float(d) for d in offered.split(',')]
    assert all(b >= a for a, b in zip(asked, request.segment_durations))
    response = ask(request)
    assert response.error_code == CODES.SUCCESS, response.message
    np.testing.assert_allclose(
        np.diff(response.via_times), request.segment_durations, atol=ROUNDING)


@pytest.mark.parametrize(('fields', 'text'), [
    ({'points': ()}, '0 via points given, at least 2 needed'),
    ({'points': TABLE_6_1[:1]}, '1 via point given, at least 2 needed'),
    ({'points': (), 'start': START}, '0 via points given, at least 1 needed'),
    ({'segment_durations': [1.0]}, '1 segment_durations given for 2 segments'),
    ({'segment_durations': [3.0, 3.0], 'start': START},
     '2 segment_durations given for 3 segments'),
    ({'segment_durations': [-1.0, 3.0]},
     'segment_durations[0] is -1.0 s, must be finite and at least 1e-09 s'),
    ({'segment_durations': [3.0, 0.0]},
     'segment_durations[1] is 0.0 s, must be finite and at least 1e-09 s'),
    ({'segment_durations': [nan, 3.0]},
     'segment_durations[0] is nan: planner cycloid takes every duration or none'),
    ({'segment_durations': [3.0, inf]},
     'segment_durations[1] is inf s, must be finite and at least 1e-09 s'),
    *(({f'max_{kind}_scaling_factor': value},
       f'max_{kind}_scaling_factor is {value}, must be in (0, 1]')
      for kind in ('velocity', 'acceleration') for value in (1.5, -1.0, nan, inf)),
    ({'sample_period': -0.01}, 'sample_period is -0.01 s, must be 0 or in [0.0001, 10] s'),
    ({'sample_period': 1e-5}, 'sample_period is 1e-05 s, must be 0 or in [0.0001, 10] s'),
    ({'sample_period': nan}, 'sample_period is nan s'),
    ({'sample_period': inf}, 'sample_period is inf s, must be 0 or in [0.0001, 10] s'),
    ({'sample_period': 1e3}, 'sample_period is 1000 s, must be 0 or in [0.0001, 10] s'),
    ({'max_deviation': -0.1}, 'max_deviation is -0.1 m, must be 0 or in [1e-06, 100] m'),
    ({'max_deviation': 5e-324}, 'max_deviation is 4.94066e-324 m, must be 0 or in'),
    ({'max_deviation': nan}, 'max_deviation is nan m'),
    ({'max_deviation': inf}, 'max_deviation is inf m'),
    ({'elbow': 'left'}, "elbow is 'left', must be 'up', 'down' or empty"),
    ({'planner_id': 'magic'}, "planner_id 'magic' is unknown, known are "),
    ({'planner_id': 'magic'}, 'cycloid, cycloid_approach_a')])
def test_malformed_request_is_refused(ask, fields, text):
    assert_refused(ask, plan_request(**fields), INVALID, text)


@pytest.mark.parametrize('value', [nan, inf, -inf])
def test_point_that_is_not_finite_is_blamed(ask, value):
    request = plan_request()
    request.via_points.poses[1].position.y = value
    assert_refused(ask, request, INVALID, f'via point 1: position is (0.46, {value}, 1.44) m, '
                   'must be finite', 1)


def test_orientation_that_is_not_finite_is_blamed(ask):
    request = plan_request()
    request.via_points.poses[2].orientation.x = nan
    assert_refused(ask, request, INVALID, 'via point 2: orientation is (nan, 0.0, 0.0, 1.0), '
                   'must be finite', 2)


def test_another_frame_is_refused(ask):
    assert_refused(ask, plan_request(frame='world'), CODES.FRAME_TRANSFORM_FAILURE,
                   "via_points are in frame 'world', must be in 'base_link'")


@pytest.mark.parametrize(('start', 'text'), [
    ({'name': NAMES[:2], 'position': START[:2]},
     'start state names joint_3 0 times, must name each of joint_1, joint_2, joint_3 once'),
    ({'name': [*NAMES, 'joint_2'], 'position': [*START, 1.0]},
     'start state names joint_2 2 times'),
    ({'name': [], 'position': START}, 'start state names joint_1 0 times'),
    ({'position': []}, 'start state has 3 names, 0 positions and 0 velocities'),
    ({'position': START[:2]}, 'start state has 3 names, 2 positions and 0 velocities'),
    ({'position': START, 'velocity': [0.0]},
     'start state has 3 names, 3 positions and 1 velocity'),
    ({'position': [0.5, nan, 0.2]}, 'start state: joint_2 is at nan rad, must be finite'),
    ({'position': [0.5, 0.9, inf]}, 'start state: joint_3 is at inf rad, must be finite'),
    ({'position': [-0.1, 0.9, 0.2]},
     'start state: joint_1 is at -0.1 rad, limits 0 to 1.5708 rad'),
    # stretched out: 9.81 (16 * 0.5 + 12 (0.9 + 0.5))
    ({'position': [0.5, 0.0, pi / 2]},
     'start state: joint_2 needs 243.3 N m to hold, limit 200 N m'),
    ({'position': START, 'velocity': [0.0, 0.0, -0.5]},
     'start state: joint_3 moves at -0.5 rad/s, must be at rest'),
    ({'position': START, 'velocity': [0.0, nan, 0.0]}, 'start state: joint_2 moves at nan')])
def test_wrong_start_state_is_refused(ask, start, text):
    assert_refused(ask, plan_request(start=start), BAD_START, text)


# Answers


def assert_sampled(response, period):
    """Assert that points come every period and at every via time, none too near to another."""
    t, via = stamps(response.trajectory), np.round(np.multiply(response.via_times, SECOND))
    step = round(period * SECOND)
    assert t[0] == 0
    assert (np.diff(t) > 0).all()
    assert set(via) <= set(t)
    assert t[-1] == via[-1]
    fixed = np.union1d((0, t[-1]), via)
    for due in range(step, t[-1], step):
        assert due in t or np.abs(fixed - due).min() < 0.1 * step + 1
    for before, after in zip(t, t[1:]):
        assert after - before >= 0.1 * step - 1 or {before, after} <= set(fixed)
        assert after - before <= 1.1 * step + 1


def assert_good(response, points=TABLE_6_1, start=None, period=0.01, elbow='up',
                scale=(1.0, 1.0)):
    """Assert that an answer keeps the contract: form, times, via points, limits, figures."""
    assert (response.error_code, response.message) == (CODES.SUCCESS, '')
    assert response.failed_via_point == -1
    assert response.planning_time > 0.0
    trajectory = response.trajectory
    assert (trajectory.header.stamp.sec, trajectory.header.stamp.nanosec) == (0, 0)
    assert trajectory.header.frame_id == 'base_link'
    assert trajectory.joint_names == NAMES
    for point in trajectory.points:
        assert (len(point.positions), len(point.velocities), len(point.accelerations),
                len(point.effort)) == (3, 3, 3, 0)
    assert_sampled(response, period)
    check_trajectory(incoming_trajectory(trajectory), NAMES, now=0)

    motion = points_of(trajectory)
    for end in (0, -1):
        assert motion.velocities[end].tolist() == motion.accelerations[end].tolist() == [0.0] * 3
    if start is not None:
        assert motion.positions[0].tolist() == list(start)
    at_via = np.searchsorted(stamps(trajectory), np.round(np.multiply(response.via_times, SECOND)))
    tip = forward_kinematics(RobotModel(), motion.positions[at_via])
    np.testing.assert_allclose(tip, points, atol=ROUNDING)
    bent = motion.positions[at_via[0], 2]
    assert (bent <= pi / 2) == (elbow == 'up')  # at pi / 2 the arm is stretched

    limits = JointLimits().scaled(*scale)
    _, qd, qdd = spline_through(motion).within(np.linspace(0.0, 1.0, 17))
    for peak, seen, limit in zip(
            (response.peak_velocity, response.peak_acceleration),
            (np.abs(qd).max(axis=(0, 1)), np.abs(qdd).max(axis=(0, 1))),
            (limits.max_velocity, limits.max_acceleration)):
        assert (np.array(peak) <= limit * (1.0 + 1e-6)).all()
        assert (seen <= limit * (1.0 + 1e-3)).all()
        np.testing.assert_allclose(peak, seen, rtol=0.02, atol=1e-3)
    assert (np.array(response.peak_jerk) <= limits.max_jerk * (1.0 + 1e-6)).all()
    assert (np.array(response.peak_effort) <= limits.max_effort * (1.0 + 1e-6)).all()


def test_table_6_1_takes_the_known_time(ask):
    response = ask(plan_request())
    assert_good(response)
    assert response.via_times[0] == 0.0
    assert response.via_times[-1] == pytest.approx(2.850, abs=1e-3)  # the reference solution's


@pytest.mark.parametrize(('fields', 'period'), [
    ({'sample_period': 0.003}, 0.003), ({'sample_period': 0.1}, 0.1),
    ({'planner_id': 'cycloid_approach_a'}, 0.01), ({'frame': 'base_link'}, 0.01),
    ({'segment_durations': [2.5, 2.0], 'sample_period': 0.02}, 0.02)])
def test_answer_is_what_a_controller_accepts(ask, fields, period):
    assert_good(ask(plan_request(**fields)), period=period)


def test_same_request_has_the_same_answer_bit_for_bit(ask):
    first, second = ask(plan_request()), ask(plan_request())
    assert first.trajectory == second.trajectory
    assert first.via_times == second.via_times


@pytest.mark.parametrize('durations', [(2.5, 2.0), (3.0, 7.0)])
def test_prescribed_durations_are_kept(ask, durations):
    response = ask(plan_request(segment_durations=list(durations)))
    assert_good(response)
    np.testing.assert_allclose(np.diff(response.via_times), durations, atol=ROUNDING)


@pytest.mark.parametrize('elbow', ['up', 'down'])
def test_elbow_is_as_requested(ask, elbow):
    points = forward_kinematics(RobotModel(), np.array([(0.6, 0.9, 1.9), (0.7, 1.0, 2.0)]))
    assert_good(ask(plan_request(points, elbow=elbow)), points, elbow=elbow)


def test_start_state_s_names_come_in_any_order(ask):
    q, order = START + (0.1, -0.05, 0.1), [2, 0, 1]
    request = plan_request(start={'name': ['gripper', *(NAMES[i] for i in order)],
                                  'position': [7.0, *q[order]], 'velocity': [0.0] * 4})
    response = ask(request)
    assert_good(response, start=q)
    assert response.via_times[0] > 0.0


def test_one_via_point_will_do_with_a_start_state(ask):
    response = ask(plan_request(TABLE_6_1[1:2], start=START))
    assert_good(response, TABLE_6_1[1:2], START)
    assert len(response.via_times) == 1


def test_start_at_the_only_via_point_is_rest(ask):
    response = ask(plan_request(TABLE_6_1[:1], start=START))
    assert response.error_code == CODES.SUCCESS, response.message
    assert list(response.via_times) == [0.0]
    motion = points_of(response.trajectory)
    assert np.ptp(motion.positions, axis=0).tolist() == [0.0] * 3
    assert not motion.velocities.any()
    check_trajectory(incoming_trajectory(response.trajectory), NAMES, now=0)


def test_noise_of_encoders_is_rest(ask):
    assert_good(ask(plan_request(start={'position': START, 'velocity': [1e-3, -1e-3, 0.0]})),
                start=START)


def test_repeated_via_point_is_passed_once(ask):
    a, b, c = TABLE_6_1
    response = ask(plan_request((a, a, b, b, c)))
    assert_good(response, (a, a, b, b, c))
    once = ask(plan_request())
    assert list(response.via_times) == [once.via_times[i] for i in (0, 0, 1, 1, 2)]
    assert response.trajectory == once.trajectory


def test_repeated_via_point_rests_as_long_as_prescribed(ask):
    a, b, _ = TABLE_6_1
    response = ask(plan_request((a, b, b), segment_durations=[3.0, 1.5]))
    assert_good(response, (a, b, b))
    np.testing.assert_allclose(response.via_times, (0.0, 3.0, 4.5), atol=ROUNDING)


def test_acceleration_scaled_to_a_quarter_doubles_the_time(ask):
    full, slow = (ask(plan_request(max_acceleration_scaling_factor=f)) for f in (1.0, 0.25))
    assert_good(slow, scale=(1.0, 0.25))
    assert slow.via_times[-1] / full.via_times[-1] == pytest.approx(2.0, rel=1e-3)


def test_velocity_scaled_down_is_kept(ask):
    slow = ask(plan_request(max_velocity_scaling_factor=0.1))
    assert_good(slow, scale=(0.1, 1.0))
    assert max(slow.peak_velocity) == pytest.approx(0.1, rel=1e-3)


def test_scaling_factor_zero_is_one(ask):
    zero, one = (ask(plan_request(max_velocity_scaling_factor=f,
                                  max_acceleration_scaling_factor=f)) for f in (0.0, 1.0))
    assert zero.trajectory == one.trajectory


# The process


def test_bug_in_a_planner_is_reported_and_survived(module_ros):
    with Script(python(BUGS), '--ros-args', '-r', '__ns:=/bugs') as planner:
        def ask(request):
            return module_ros.call(PlanTrajectory, 'bugs/plan_trajectory', request)

        assert_refused(ask, plan_request(planner_id='broken'), CODES.FAILURE,
                       'internal error, RuntimeError: no idea')
        planner.process.send_signal(signal.SIGINT)
        code, _, errors = planner.ended()
    assert code == 0
    assert 'in broken\n' in errors  # the trace
    assert 'RuntimeError: no idea' in errors


def test_signal_ends_a_node_that_plans(module_ros):
    with Script(python(BUGS), '--ros-args', '-r', '__ns:=/endless',
                '--log-level', 'warn') as planner:
        client = module_ros.node.create_client(PlanTrajectory, 'endless/plan_trajectory')
        assert client.wait_for_service(20.0)
        client.call_async(plan_request(planner_id='endless'))
        planner.read_until('begun')
        planner.process.send_signal(signal.SIGTERM)
        assert planner.ended() == (0, '', '')


def test_client_that_leaves_does_no_harm(module_ros, ask):
    client = module_ros.node.create_client(PlanTrajectory, 'plan_trajectory')
    assert client.wait_for_service(20.0)
    client.call_async(plan_request())
    module_ros.node.destroy_client(client)
    assert_good(ask(plan_request()))


@pytest.mark.parametrize(('yaml', 'texts'), [
    ('default_planner_id: magic',
     ('default_planner_id', "'magic'", 'cycloid, cycloid_approach_a')),
    ('max_deviation: 1', ('parameter max_deviation is 1, must be in [1e-06, 100] m (written',))])
def test_wrong_file_stops_the_planner_with_one_line(tmp_path, yaml, texts):
    file = tmp_path / 'arm.yaml'
    file.write_text(f'/**:\n  ros__parameters: {{{yaml}}}\n')
    with Script(script('planner'), '--ros-args', '--params-file', file) as planner:
        code, _, errors = planner.ended()
    assert code == 1
    assert errors.startswith('planner: ')
    assert errors.count('\n') == 1
    for text in texts:
        assert text in errors


def test_stronger_arm_s_file_lets_table_6_3_be_planned(module_ros):
    file = CONFIG / 'thesis_arm_joint_2_250.yaml'
    with Script(script('planner'), '--ros-args', '-r', '__ns:=/strong', '--params-file', file):
        response = module_ros.call(
            PlanTrajectory, 'strong/plan_trajectory', plan_request(TABLE_6_3))
        values = module_ros.call(
            GetParameters, 'strong/trajectory_planner/get_parameters',
            GetParameters.Request(names=['joint_limits.joint_2.max_effort'])).values
    assert response.error_code == CODES.SUCCESS, response.message
    assert response.via_times[-1] == pytest.approx(3.490, abs=5e-3)  # the reference solution's
    assert 218.9 < response.peak_effort[1] <= 250.0
    assert values[0].double_value == 250.0


def test_help_needs_no_ros():
    with Script(script('planner'), '--help') as planner:
        code, output, errors = planner.ended()
    assert (code, errors) == (0, '')
    for text in ('plan_trajectory', 'planned_path', '--ros-args'):
        assert text in output
