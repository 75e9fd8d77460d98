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

"""Randomly corrupted requests, and checks that every answer to them must pass."""

from __future__ import annotations

from itertools import count
from math import inf, nan, pi

from geometry_msgs.msg import Pose
from helpers.plan_requests import NAMES, plan_request, points_of, stamps
from hypothesis import strategies as st
import numpy as np
from rrr_traj_planner.core.arm.model import JOINT_NAMES, RobotModel
from rrr_traj_planner.core.dynamics.rigid_body import inverse_dynamics
from rrr_traj_planner.core.errors import ConvergenceError, RrrPlannerError
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.trajectory.quintic_spline import spline_through
from rrr_traj_planner.nodes.parameters.configuration import PlannerConfig
from rrr_traj_planner.nodes.parameters.table import PLANNER, rows_of
from rrr_traj_planner.nodes.planner_node.planning_answer import refusal, success
from rrr_traj_planner.nodes.planner_node.planning_request import planning_request
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.registry import planner_ids
from rrr_traj_planner_interfaces.srv import PlanTrajectory
from trajectory_msgs.msg import JointTrajectoryPoint

CODES = PlanTrajectory.Response
REFUSALS = {CODES.PLANNING_FAILED, CODES.GOAL_CONSTRAINTS_VIOLATED,
            CODES.INVALID_GOAL_CONSTRAINTS, CODES.FRAME_TRANSFORM_FAILURE,
            CODES.START_STATE_INVALID, CODES.NO_IK_SOLUTION}

# The node's defaults, except for a bound on answers that keeps the tests fast.
MAX_POINTS = 2000
CONFIG = PlannerConfig.from_values({
    **{name: row.default for name, row in rows_of(PLANNER, JOINT_NAMES).items()},
    'max_points': MAX_POINTS})

# Number of calls of `should_stop` after which it returns True: reproducible, unlike a clock.
PATIENCE = 4

# Relative tolerance of the limits for the quintics through the points (docs/nodes.md).
INTERPOLATED = 1e-3

ODD = (nan, inf, -inf, 0.0, -0.0, 5e-324, -5e-324, 1e-310, 1e-300, 1e-30, 1e-9, -1.0, 1e9, 1e30,
       1e300, -1e300, 1.7976931348623157e308)
odd_numbers = st.one_of(st.sampled_from(ODD), st.floats())
odd_texts = st.one_of(
    st.sampled_from(('', 'magic', 'CYCLOID', ' cycloid', 'line\nbreak', 'x' * 10_000)),
    st.text(st.characters(exclude_characters='\0', exclude_categories=('Cs',)), max_size=20))

POSITIONS = st.tuples(  # the arm can hold most of these
    st.floats(0.0, pi / 2), st.floats(0.6, 2.4), st.floats(-pi / 2, pi / 2))


@st.composite
def hostile_requests(draw):
    """Return a request with up to three of its parts replaced by unusual values."""
    q = draw(st.lists(POSITIONS, min_size=2, max_size=5))
    request = plan_request(forward_kinematics(RobotModel(), np.array(q)))
    request.planner_id = draw(st.sampled_from(planner_ids()))
    if draw(st.booleans()):
        request.start_state.name = NAMES
        request.start_state.position = list(draw(POSITIONS))
    for change in draw(st.lists(st.sampled_from(CHANGES), max_size=3)):
        change(draw, request)
    return request


def _drawn_pose(draw, request):
    return draw(st.sampled_from(request.via_points.poses or [Pose()]))


def _odd_coordinate(draw, request):
    setattr(_drawn_pose(draw, request).position, draw(st.sampled_from('xyz')), draw(odd_numbers))


def _odd_orientation(draw, request):
    setattr(_drawn_pose(draw, request).orientation, draw(st.sampled_from('xyzw')),
            draw(odd_numbers))


def _special_place(draw, request):
    """Move a via point to or near joint axis 1, out of reach, or next to the limit of reach."""
    radius, height = draw(st.sampled_from((
        (0.0, 1.5), (0.0, 0.5), (1e-12, 1.5), (5e-324, 1.2), (1e-3, 1.3), (0.1, 0.5), (0.2, 0.5),
        (0.2 + 1e-12, 0.5), (0.2 - 1e-12, 0.5), (1.6, 0.5), (1.6 - 1e-12, 0.5),
        (1.6 + 1e-12, 0.5), (2.0, 0.5))))
    position = _drawn_pose(draw, request).position
    position.x = position.y = radius / 2.0 ** 0.5
    position.z = height


def _repeated_points(draw, request):
    """Repeat a via point, exactly or nearly."""
    poses = request.via_points.poses
    if poses:
        k, shift = draw(st.integers(0, len(poses) - 1)), draw(st.sampled_from(
            (0.0, 5e-324, 1e-15, 1e-10, 1e-9, 2e-9, 1e-7, 1e-4)))
        copy = Pose(position=type(poses[k].position)(
            x=poses[k].position.x + shift, y=poses[k].position.y, z=poses[k].position.z))
        request.via_points.poses = [*poses[:k + 1], *[copy] * draw(st.integers(1, 3)),
                                    *poses[k + 1:]]


def _fewer_points(draw, request):
    request.via_points.poses = request.via_points.poses[:draw(st.integers(0, 1))]


def _odd_durations(draw, request):
    size = draw(st.sampled_from((0, 1, len(request.via_points.poses),
                                 max(len(request.via_points.poses) - 1, 0))))
    usual = st.floats(0.1, 20.0)
    request.segment_durations = draw(st.lists(
        st.one_of(usual, usual, odd_numbers), min_size=size, max_size=size))


def _odd_start(draw, request):
    start = request.start_state
    start.name = draw(st.sampled_from((NAMES, NAMES[::-1], NAMES[:2], [], ['a', 'b', 'c'],
                                       [*NAMES, NAMES[0]], [''] * 3)))
    usual = st.one_of(st.floats(-pi, pi), odd_numbers)
    start.position = draw(st.lists(usual, max_size=4))
    start.velocity = draw(st.one_of(st.just([]), st.lists(usual, max_size=4)))


def _odd_number(field, usual):
    def change(draw, request):
        setattr(request, field, draw(st.one_of(usual, odd_numbers)))
    return change


def _odd_text(draw, request):
    setattr(request, draw(st.sampled_from(('planner_id', 'elbow'))), draw(odd_texts))


def _odd_frame(draw, request):
    request.via_points.header.frame_id = draw(odd_texts)


def _joint_points(draw, request):
    """Give joint positions in place of the tip's, odd ones or with odd fields too."""
    points = [JointTrajectoryPoint(positions=draw(POSITIONS)) for _ in request.via_points.poses]
    if draw(st.booleans()) and points:
        point = draw(st.sampled_from(points))
        usual = st.one_of(st.floats(-pi, pi), odd_numbers)
        setattr(point, draw(st.sampled_from(('positions', 'positions', 'velocities', 'effort'))),
                draw(st.lists(usual, min_size=2, max_size=4)))
    request.joint_via_points = points
    if draw(st.integers(0, 5)):
        request.via_points.poses = []


def number_of(request):
    """Return the number of via points of a request."""
    return len(request.via_points.poses) + len(request.joint_via_points)


def _stops(draw, request):
    number = number_of(request)
    flags = draw(st.lists(st.booleans(), min_size=max(number - 1, 0), max_size=number))
    request.stop_at = [*flags, True][:number + draw(st.integers(-1, 1))]


def _dwells(draw, request):
    """Dwell where the arm stops, or anywhere, or for odd times."""
    usual = st.sampled_from((0.0, 0.0, 1e-6, 1e-3, 0.01, 0.5, 3.0))
    number = number_of(request)
    at = list(request.stop_at) if len(request.stop_at) == number else [True] * number
    request.dwell = [draw(usual if rests else st.just(0.0)) for rests in at]
    if draw(st.booleans()):
        request.dwell = draw(st.lists(st.one_of(usual, odd_numbers), min_size=number,
                                      max_size=number))


CHANGES = (
    _odd_coordinate, _odd_orientation, _special_place, _repeated_points, _fewer_points,
    _odd_durations, _odd_start, _odd_text, _odd_frame, _joint_points, _stops, _dwells, _dwells,
    _odd_number('max_velocity_scaling_factor', st.floats(1e-4, 1.0)),
    _odd_number('max_acceleration_scaling_factor', st.floats(1e-4, 1.0)),
    _odd_number('sample_period', st.floats(1e-4, 10.0)),
    _odd_number('max_deviation', st.floats(1e-6, 1.0)))


def answered(request, config=CONFIG, patience=PATIENCE):
    """Return the node's answer; raise unexpected exceptions."""
    calls = count()
    try:
        return success(plan(config.model, config.limits, planning_request(
            request, config, lambda: next(calls) >= patience)), config)
    except ConvergenceError:
        raise
    except RrrPlannerError as error:
        return refusal(error)


def assert_sound(request, response, config=CONFIG):
    """Assert that an answer is a refusal with a reason, or a trajectory within its limits."""
    if response.error_code != CODES.SUCCESS:
        assert response.error_code in REFUSALS
        assert response.message.isprintable() and len(response.message) < 5000
        assert -1 <= response.failed_via_point < max(number_of(request), 1)
        assert not response.trajectory.points and not response.trajectory.joint_names
        return
    assert is_well_formed(request)
    times, motion = stamps(response.trajectory), points_of(response.trajectory)
    assert 2 <= len(times) <= config.max_points
    assert times[0] == 0 and (np.diff(times) > 0).all()
    assert len(response.via_times) == number_of(request)
    assert_rests(request, response, times, motion)
    assert all(np.isfinite(v).all() for v in (
        motion.positions, motion.velocities, motion.accelerations))
    limits = config.limits.scaled(request.max_velocity_scaling_factor or 1.0,
                                  request.max_acceleration_scaling_factor or 1.0)
    q, qd, qdd = spline_through(motion).within(np.linspace(0.0, 1.0, 17))
    assert (np.abs(qd) <= limits.max_velocity * (1.0 + INTERPOLATED)).all()
    assert (np.abs(qdd) <= limits.max_acceleration * (1.0 + INTERPOLATED)).all()
    torque = np.abs(inverse_dynamics(config.model, q, qd, qdd))
    assert (torque <= limits.max_effort * (1.0 + INTERPOLATED)).all()
    assert (torque <= np.array(response.peak_effort) * (1.0 + INTERPOLATED) + 1e-9).all()
    assert (np.array(response.peak_effort) <= limits.max_effort * (1.0 + 1e-6)).all()


def assert_rests(request, response, times, motion):
    """Assert that the arm rests where and for as long as it is asked to."""
    via = np.round(np.multiply(response.via_times, 1e9)).astype(int)
    for k, stops in enumerate(request.stop_at):
        dwell = round(1e9 * request.dwell[k]) if request.dwell else 0
        rests = (times >= via[k] - 1) & (times <= via[k] + dwell + 1)
        assert rests.any()
        if stops:
            assert np.abs(motion.velocities[rests]).max() < 1e-6
            assert np.ptp(motion.positions[rests], axis=0).max() < 1e-9
    if request.dwell:
        assert times[-1] - via[-1] >= round(1e9 * request.dwell[-1]) - 1


def is_well_formed(request):
    """Return whether all values of a request are within the documented bounds."""
    tips = [(p.position.x, p.position.y, p.position.z, p.orientation.x, p.orientation.y,
             p.orientation.z, p.orientation.w) for p in request.via_points.poses]
    frame = request.via_points.header.frame_id if tips else ''
    joints = [p.positions for p in request.joint_via_points]
    return (np.isfinite(tips).all() and np.isfinite(joints).all()
            and not (tips and joints) and not any(
                p.velocities or p.effort for p in request.joint_via_points)
            and len(request.stop_at) in (0, number_of(request))
            and len(request.dwell) in (0, number_of(request))
            and all(0.0 <= d < inf for d in request.dwell)
            and frame in ('', 'base_link')
            and request.elbow in ('', 'up', 'down')
            and request.planner_id in ('', *planner_ids())
            and all(0.0 <= factor <= 1.0 for factor in (
                request.max_velocity_scaling_factor, request.max_acceleration_scaling_factor))
            and all(not d < 1e-9 and d != inf for d in request.segment_durations)
            and (request.sample_period == 0.0 or 1e-4 <= request.sample_period <= 10.0)
            and (request.max_deviation == 0.0 or 1e-6 <= request.max_deviation <= 100.0))
