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

"""Goals that have the arm do what is planned, from where it is; what is asked before."""

from __future__ import annotations

from math import nan, pi
from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.errors import counted
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.nodes.studio.planned import Planned
from rrr_traj_planner.nodes.studio.requests import request_of
from rrr_traj_planner.nodes.studio.wanted import Wanted
from rrr_traj_planner.planners.registry import planner
from rrr_traj_planner_interfaces.action import MoveThrough
from trajectory_msgs.msg import JointTrajectoryPoint

AT_START = 0.01       # rad, of a joint from the plan's start, by which the arm is there
AT_VIA_POINT = 1e-6   # m, by which a plan passes through its via points
FIELDS = ('via_points', 'joint_via_points', 'elbow', 'shoulder', 'dwell', 'max_deviation',
          'max_velocity_scaling_factor', 'max_acceleration_scaling_factor')
TURN = 2.0 * pi
MARGIN = 1.5  # for torque


class Question(NamedTuple):
    """
    What the user is asked before a real arm is moved.

    Attributes
    ----------
    text : str
        The question.
    wanted : Wanted
        What it is about.

    """

    text: str
    wanted: Wanted


def goal_of(wanted: Wanted, plan: Planned, model: RobotModel, q: Array, moves: bool
            ) -> MoveThrough.Goal:
    """
    Return the goal for a plan.

    An arm that rests elsewhere than at the first via point stops there, so that the rest is the
    motion that is planned. One that moves is taken over by the planner that can do so.

    Parameters
    ----------
    wanted : Wanted
        What is planned.
    plan : Planned
        Its plan: its postures are gone through.
    model : RobotModel
        The arm.
    q : ndarray, shape (3,)
        Where the arm is [rad].
    moves : bool
        Whether it moves.

    Returns
    -------
    MoveThrough.Goal
        Without the first via point if the arm is there, and is not to stay there for a time.

    """
    goal = rest_goal(wanted, 0)
    goal.planner_id = '' if moves else wanted.task.planner_id
    tips = forward_kinematics(model, plan.via_joints)
    if np.linalg.norm(tips - wanted.points, axis=1).max() <= AT_VIA_POINT:
        goal.joint_via_points = [
            JointTrajectoryPoint(positions=at) for at in plan.via_joints.tolist()]
        goal.via_points.poses = []
        goal.elbow = goal.shoulder = ''
    durations = wanted.task.segment_durations.tolist()
    if durations:
        goal.segment_durations = [_way_there(wanted, plan, q, moves), *durations]
    rests = len(goal.dwell) > 0 and goal.dwell[0] > 0.0  # at the first via point
    if not moves and not rests and np.abs(q - plan.via_joints[0]).max() <= AT_START:
        for name in ('joint_via_points', 'stop_at', 'dwell', 'segment_durations'):
            setattr(goal, name, getattr(goal, name)[1:])
        goal.via_points.poses = goal.via_points.poses[1:]
    return goal


def _way_there(wanted: Wanted, plan: Planned, q: Array, moves: bool) -> float:
    """
    Return a time for the way to the first via point [s].

    NaN, the planner's choice, where the planner lets it be chosen; else that of a cycloid well
    within the limits.
    """
    if moves or planner(wanted.task.planner_id).some_durations:
        return nan
    way = np.abs(plan.via_joints[0] - q)
    velocity, acceleration, jerk = (limits for _, _, limits in plan.peaks[:3])
    times = (2.0 * way / (velocity * wanted.velocity_scaling),
             np.sqrt(TURN * way / (acceleration * wanted.acceleration_scaling)),
             np.cbrt(TURN ** 2 * way / jerk))
    return MARGIN * float(max(time.max() for time in times))


def rest_goal(wanted: Wanted, first: int) -> MoveThrough.Goal:
    """
    Return the goal through the rest of the via points, for an arm that moves.

    Parameters
    ----------
    wanted : Wanted
        What is planned.
    first : int
        Index of the via point to begin with; the arm stops there only if it is to, and at 0.

    Returns
    -------
    MoveThrough.Goal
        Without planner: the motion server knows which one takes over in motion.

    """
    request = request_of(wanted)
    goal = MoveThrough.Goal(**{name: getattr(request, name) for name in FIELDS})
    goal.via_points.poses = goal.via_points.poses[first:]
    goal.joint_via_points = goal.joint_via_points[first:]
    stops = wanted.stops
    stops[0] = True
    goal.stop_at, goal.dwell = stops[first:].tolist(), goal.dwell[first:]
    return goal


def question(controller: str, wanted: Wanted, plan: Planned, goal: MoveThrough.Goal) -> Question:
    """
    Return what to ask before a real arm is moved.

    Parameters
    ----------
    controller : str
        Its controller.
    wanted : Wanted
        What is planned.
    plan : Planned
        Its plan.
    goal : MoveThrough.Goal
        For this plan.

    Returns
    -------
    Question
        Plain text.

    """
    points = counted(len(wanted.points), 'via point')
    if goal.planner_id:
        way = '' if len(goal.stop_at) < len(wanted.points) else (
            ' It is not at via point 0, and goes there first.')
        how = f'by {plan.planner_id} in {plan.duration:.2f} s.{way}'
    else:
        how = 'from the motion in progress, planned anew by time_optimal.'
    return Question(
        f'{controller} moves the arm through {points}, {how} Via points that are dragged while it '
        'moves change its motion.', wanted)
