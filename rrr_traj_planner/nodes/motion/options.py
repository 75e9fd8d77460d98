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

"""How motions are run."""

from __future__ import annotations

from typing import NamedTuple

from rclpy.exceptions import InvalidTopicNameException
from rclpy.validate_topic_name import validate_topic_name
from rrr_traj_planner.core.errors import InvalidInputError, quoted

ACTION = '/follow_joint_trajectory'


class Options(NamedTuple):
    """
    How motions are run.

    Attributes
    ----------
    controller : str
        Name of the controller, which serves `CONTROLLER/follow_joint_trajectory`.
    lead : float
        How far ahead of the arm a motion in progress is gone on from [s].
    planning_timeout : float
        How long the planner may take to answer [s].
    discovery_timeout : float
        How long planner, controller and the arm's state are waited for [s].
    start_tolerance : float
        How far each joint may be from the start of a plan when it is sent [rad].

    """

    controller: str = 'simulated_arm'
    lead: float = 0.25
    planning_timeout: float = 30.0
    discovery_timeout: float = 10.0
    start_tolerance: float = 0.01


def controller_of(name: str, what: str) -> str:
    """
    Return a controller's name.

    Parameters
    ----------
    name : str
        The controller's, or its action's.
    what : str
        What messages call it.

    Returns
    -------
    str
        Without the action's name.

    Raises
    ------
    InvalidInputError
        If it is not a name in ROS.

    """
    controller = name.removesuffix(ACTION).rstrip('/')
    try:
        validate_topic_name(controller + ACTION)
    except InvalidTopicNameException:
        controller = ''
    if not controller:
        raise InvalidInputError(
            f'{what} is {quoted(name)}, must be a name such as arm_controller or /arm_controller')
    return controller
