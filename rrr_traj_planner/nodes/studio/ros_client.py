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

"""The studio's node: asks the planner, sends goals to the motion server, follows the arm."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import isfinite
from typing import Any

from control_msgs.action import FollowJointTrajectory
from control_msgs.msg import JointTrajectoryControllerState
import numpy as np
from rcl_interfaces.srv import SetParametersAtomically
from rclpy.action import ActionClient
from rclpy.client import Client as ServiceClient
from rclpy.parameter import Parameter
from rrr_traj_planner.core.arm.payload import Payload
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.nodes.motion.options import ACTION, controller_of, Options
from rrr_traj_planner.nodes.parameters.configuration import PlannerConfig
from rrr_traj_planner.nodes.runs.planner_config import PLANNER_NODE, planner_values, values_of
from rrr_traj_planner.nodes.runs.spun_node import SpunNode
from rrr_traj_planner.nodes.studio.requests import request_of
from rrr_traj_planner.nodes.studio.sent_goal import SentGoal
from rrr_traj_planner.nodes.studio.wanted import Wanted
from rrr_traj_planner_interfaces.action import MoveThrough
from rrr_traj_planner_interfaces.srv import PlanTrajectory
from sensor_msgs.msg import JointState
from std_srvs.srv import Trigger

ARM_NODE = 'simulated_arm'
MASS, KNOWN = 'payload.mass', 'payload.known_to_controller'


class StudioClient(SpunNode):
    """
    A client of planner, arm and motion server.

    Parameters
    ----------
    controller : str
        Name of a real arm's controller, or its action's; empty: the simulated arm.
    **kwargs
        For `Node`.

    Attributes
    ----------
    controller : str
        The controller's name, of a real arm, which cannot be exchanged for another one; empty: the
        simulated arm.
    moved : callable
        Called at every new state of the arm.
    parameters : dict
        The planner's, by name, as they were when it was connected to.
    payload : Payload
        What the arm carried then.
    replanning_lead : float
        The motion server's [s].

    """

    def __init__(self, controller: str = '', **kwargs: Any) -> None:
        self.controller = controller_of(controller, '--controller') if controller else ''
        super().__init__('studio', **kwargs)
        self._states: dict[str, tuple[float, float]] = {}  # by joint: position, velocity
        self._measured: set[str] = set()  # joints that `joint_states` has
        self.moved: Callable[[], None] = lambda: None
        self.parameters: dict[str, Any] = {}
        self.payload = Payload()
        self.replanning_lead = Options(self.controller).lead
        self.create_subscription(JointState, 'joint_states', self._take_state, 10)
        self._plan = self.create_client(PlanTrajectory, 'plan_trajectory')
        self._triggers: dict[str, ServiceClient] = {
            name: self.create_client(Trigger, f'{ARM_NODE}/{name}')
            for name in (() if self.controller else ('hold', 'reset'))}
        self._controllers: dict[str, ActionClient] = {}  # one at most
        if self.controller:
            action = f'{self.controller}{ACTION}'
            self._controllers[f'the controller (action {action})'] = ActionClient(
                self, FollowJointTrajectory, action)
            self.create_subscription(
                JointTrajectoryControllerState, f'{self.controller}/controller_state',
                self._take_controller_state, 10)
        self._settings = {
            name: self.create_client(SetParametersAtomically, f'{name}/set_parameters_atomically')
            for name in (PLANNER_NODE, *([] if self.controller else [ARM_NODE]))}
        self._action = ActionClient(self, MoveThrough, 'move_through')

    def destroy_node(self) -> None:
        """Release the actions' clients too."""
        for client in (self._action, *self._controllers.values()):
            client.destroy()
        super().destroy_node()

    def connect(self, ended: Callable[[], tuple[str, int] | None]) -> PlannerConfig:
        """
        Wait for all nodes; called from the main thread.

        For a real arm it is waited without end, with a line that says what is missing.

        Parameters
        ----------
        ended : callable
            Returns name and exit code of a node's process that has ended, else None.

        Returns
        -------
        PlannerConfig
            The planner's.

        Raises
        ------
        StartError
            If a node does not appear, or ends.
        KeyboardInterrupt
            After SIGINT or SIGTERM.

        """
        self.ended = ended
        self.wait(self._plan.service_is_ready, 'the planner')
        self.parameters = planner_values(self)
        config = PlannerConfig.from_values(self.parameters)
        names = config.model.joint_names
        if self.controller:
            self.wait_for_all(lambda: self._missing(names))
        else:
            self.wait(lambda: not self._missing(names), 'the arm')
        self.wait(self._action.server_is_ready, 'the motion server')
        self.replanning_lead, = values_of(self, 'motion_server', ['replanning_lead']).values()
        known = bool(self._triggers) and values_of(self, ARM_NODE, [KNOWN])[KNOWN]
        self.payload = Payload(self.parameters[MASS], known)
        return config

    def _missing(self, joint_names: tuple[str, ...]) -> list[str]:
        """Return what is not there of the arm."""
        found = [f'the service {client.srv_name}' for client in self._triggers.values()
                 if not client.service_is_ready()] + _not_ready(self._controllers)
        unknown = [name for name in joint_names if name not in self._states]
        topic = self.resolve_topic_name('joint_states')
        return found + [f'the position of {", ".join(unknown)} (topic {topic})'] * bool(unknown)

    @property
    def gone(self) -> str:
        """Return what is not there of all that moves the arm; empty: nothing."""
        return ' and '.join(_not_ready({'the motion server': self._action, **self._controllers}))

    def joints(self, joint_names: tuple[str, ...], field: str = 'position') -> Array:
        """
        Return the arm's newest state.

        Parameters
        ----------
        joint_names : tuple of str
            The arm's joints.
        field : str
            'position' [rad] or 'velocity' [rad/s]; velocities that nobody measures are 0.

        Returns
        -------
        ndarray, shape (3,)
            In the order of the joints.

        """
        column = ('position', 'velocity').index(field)
        return np.array([self._states[name][column] for name in joint_names])

    def plan(self, wanted: Wanted, answered: Callable[[PlanTrajectory.Response], None]) -> None:
        """
        Have a motion planned; called, as all that follows, in the executor's thread.

        Parameters
        ----------
        wanted : Wanted
            The motion, from its first via point.
        answered : callable
            Gets the planner's answer.

        """
        self._call(self._plan, request_of(wanted), answered)

    def tell_planner(self, payload: Payload, answered: Callable[[str], None]) -> None:
        """
        Have the planner plan with another payload.

        Parameters
        ----------
        payload : Payload
            The payload.
        answered : callable
            Gets why it is refused; empty: it is not.

        """
        self._set(PLANNER_NODE, {MASS: payload.mass}, answered)

    def load_arm(self, payload: Payload, answered: Callable[[str], None]) -> None:
        """
        Have the simulated arm carry another payload; a real one carries what it carries.

        Parameters
        ----------
        payload : Payload
            The payload.
        answered : callable
            Gets why it is refused; empty: it is not.

        """
        values = {MASS: payload.mass, KNOWN: payload.known_to_controller}
        answered('') if self.controller else self._set(ARM_NODE, values, answered)

    def _set(self, node: str, values: dict[str, Any], answered: Callable[[str], None]) -> None:
        self._call(self._settings[node], SetParametersAtomically.Request(parameters=[
            Parameter(name, value=value).to_parameter_msg() for name, value in values.items()
        ]), lambda response: answered(
            '' if response.result.successful else response.result.reason or 'refused'))

    def trigger(self, name: str, answered: Callable[[Trigger.Response], None]) -> None:
        """
        Call a service of the arm.

        Parameters
        ----------
        name : str
            'hold' or 'reset'.
        answered : callable
            Gets its answer.

        """
        self._call(self._triggers[name], Trigger.Request(), answered)

    def move(self, goal: MoveThrough.Goal, progress: Callable[[MoveThrough.Feedback], None],
             ended: Callable[[MoveThrough.Result], None]) -> SentGoal:
        """
        Have the arm moved.

        Parameters
        ----------
        goal : MoveThrough.Goal
            The motion.
        progress : callable
            Gets the feedback.
        ended : callable
            Gets the result.

        Returns
        -------
        SentGoal
            To end it before its time.

        """
        sent = SentGoal()

        def accepted(future: Any) -> None:
            handle = future.result()
            sent.accepted(handle)
            handle.get_result_async().add_done_callback(
                lambda result: ended(result.result().result))

        self._action.send_goal_async(
            goal, lambda message: progress(message.feedback)).add_done_callback(accepted)
        return sent

    def _take_state(self, message: JointState) -> None:
        self._measured.update(message.name)
        self._take(message.name, message.position, message.velocity)

    def _take_controller_state(self, message: JointTrajectoryControllerState) -> None:
        """Take what the controller measures, of joints that nobody else publishes."""
        if self._measured.issuperset(message.joint_names):
            return
        measured = message.feedback if message.feedback.positions else message.reference
        self._take(message.joint_names, measured.positions, measured.velocities)

    def _take(self, names: Sequence[str], q: Sequence[float], qd: Sequence[float]) -> None:
        """Take states of some joints; a velocity that is not known is 0."""
        qd = qd if len(qd) == len(names) else [0.0] * len(names)
        self._states.update({name: (at, speed if isfinite(speed) else 0.0)
                             for name, at, speed in zip(names, q, qd) if isfinite(at)})
        self.moved()

    @staticmethod
    def _call(client: ServiceClient, request: Any, answered: Callable[[Any], None]) -> None:
        client.call_async(request).add_done_callback(lambda future: answered(future.result()))


def _not_ready(clients: dict[str, ActionClient]) -> list[str]:
    return [name for name, client in clients.items() if not client.server_is_ready()]
