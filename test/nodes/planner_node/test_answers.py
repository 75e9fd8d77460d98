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

"""Answers of the script `planner`: what a controller accepts, as requested."""

from __future__ import annotations

from helpers.plan_answers import assert_good, ROUNDING
from helpers.plan_requests import NAMES, plan_request, points_of, START, TABLE_6_1
import numpy as np
import pytest
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.control.trajectory_validation import check_trajectory
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.nodes.arm_node.arm_messages import incoming_trajectory
from rrr_traj_planner_interfaces.srv import PlanTrajectory

CODES = PlanTrajectory.Response


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


def test_one_via_point_is_enough_with_a_start_state(ask):
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


def test_scaled_velocity_limit_holds(ask):
    slow = ask(plan_request(max_velocity_scaling_factor=0.1))
    assert_good(slow, scale=(0.1, 1.0))
    assert max(slow.peak_velocity) == pytest.approx(0.1, rel=1e-3)


def test_scaling_factor_zero_is_one(ask):
    zero, one = (ask(plan_request(max_velocity_scaling_factor=f,
                                  max_acceleration_scaling_factor=f)) for f in (0.0, 1.0))
    assert zero.trajectory == one.trajectory
