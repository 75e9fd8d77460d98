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

"""The node `simulated_arm`: topics and services of the simulated arm and its controller."""

from __future__ import annotations

from collections.abc import Sequence
import sys
from time import monotonic_ns
from typing import Any

from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rrr_traj_planner.core.errors import RrrPlannerError
from rrr_traj_planner.core.nanoseconds import SECOND
from rrr_traj_planner.core.simulation.controlled_arm import ControlledArm
from rrr_traj_planner.nodes.arm_node.arm_action import ArmAction
from rrr_traj_planner.nodes.arm_node.arm_diagnostics import ArmDiagnostics
from rrr_traj_planner.nodes.arm_node.arm_frames import ArmFrames
from rrr_traj_planner.nodes.arm_node.arm_log import ArmLog
from rrr_traj_planner.nodes.arm_node.arm_messages import disturbance_torque
from rrr_traj_planner.nodes.arm_node.arm_states import ArmStates
from rrr_traj_planner.nodes.arm_node.arm_time import FollowedClock, OwnClock, QUEUE_DEPTH
from rrr_traj_planner.nodes.arm_node.arm_view import ArmView
from rrr_traj_planner.nodes.arm_node.controller_messages import ControllerMessages
from rrr_traj_planner.nodes.arm_node.trajectory_input import TrajectoryInput
from rrr_traj_planner.nodes.parameters.configuration import ArmConfig
from rrr_traj_planner.nodes.parameters.declared import DeclaredParameters
from rrr_traj_planner.nodes.parameters.parameter_files import files_given
from rrr_traj_planner.nodes.parameters.table import ARM
from rrr_traj_planner.nodes.process.node_construction import destroyed_on_error
from rrr_traj_planner.nodes.process.node_start import NodeStart
from rrr_traj_planner.nodes.process.service_node import ServiceNode
from sensor_msgs.msg import JointState
from std_srvs.srv import SetBool, Trigger
from trajectory_msgs.msg import JointTrajectory

WARNING_PERIOD = 1.0  # s between warnings of stops

NOT_THE_CLOCK = 'simulated time can be paused only with publish_clock: true'


class SimulatedArm(ServiceNode):
    """
    An arm that follows trajectories by the rules of joint_trajectory_controller.

    Simulated time is the node's clock, or with `publish_clock` the arm's own (`arm_time.py`).
    Physics and control advance in whole steps; published states have the time of the last step.

    Parameters
    ----------
    **kwargs
        Arguments of `rclpy.node.Node`, such as context and parameter_overrides.

    Notes
    -----
    Subscribes to `joint_trajectory` and `disturbance` (names and efforts, applied until the next
    message). Serves the action `~/follow_joint_trajectory` (`arm_action.py`). Publishes
    `joint_states` (measured position and velocity, motor torque), `desired_joint_states` (the
    controller's reference), `~/tracking_error` (reference minus measurement) and
    `~/controller_state` (all of these), with the same stamp; `diagnostics` once a second;
    `robot_description` and `markers` (the arm and its tip's past path), transient local; with
    `publish_tf`, `/tf` and `/tf_static` (`arm_frames.py`). Serves `~/reset`, `~/hold`, `~/pause`
    and `~/step`. Parameters: see `parameters.table`.

    """

    def __init__(self, **kwargs: Any) -> None:
        super().__init__('simulated_arm', **kwargs)
        with destroyed_on_error(self):
            self._set_up(kwargs.get('cli_args'))

    def _set_up(self, arguments: Sequence[str] | None) -> None:
        self._parameters_declared = DeclaredParameters(
            self, ARM, ArmConfig.from_values, self._configure,
            files_given([*sys.argv, *(arguments or ())]))
        config = self._parameters_declared.config
        self._joint_names = config.settings.model.joint_names
        self._arm = ControlledArm(config.settings, config.initial_positions)
        self._log = ArmLog(self, self._joint_names)
        self._view = ArmView(self, config, self._arm.measured)
        messages = ControllerMessages(self._arm)
        self._states = ArmStates(self, self._arm, messages)
        self.create_subscription(JointState, 'disturbance', self._disturb, QUEUE_DEPTH)
        for name, type_, answer in (('reset', Trigger, self._reset), ('hold', Trigger, self._hold),
                                    ('step', Trigger, self._single_step),
                                    ('pause', SetBool, self._pause)):
            self.create_service(type_, f'~/{name}', answer)
        self._time = OwnClock(
            self, self._arm, self._publish, config.real_time_factor
        ) if config.publish_clock else FollowedClock(self, self._arm, self._publish)
        self._frames = ArmFrames(
            self, config.urdf, self._joint_names, self._time.now()) if config.publish_tf else None
        trajectories = TrajectoryInput(
            self._arm, self._time, self._parameters_declared, self._log)
        self.create_subscription(
            JointTrajectory, 'joint_trajectory', trajectories.take, QUEUE_DEPTH)
        self._action = ArmAction(
            self, self._arm, self._time, trajectories, messages, self._log)
        self._diagnostics = ArmDiagnostics(self, self._arm, self._time)
        # The timer uses steady time: it also runs while simulated time is paused.
        self._timer = self.create_timer(
            self._period(config), self._tick, clock=Clock(clock_type=ClockType.STEADY_TIME))
        self._start = NodeStart(
            self, self._parameters_declared, config.settings.limits,
            f'follows {self.resolve_topic_name("joint_trajectory")} and goals of '
            f'{self.resolve_service_name("~/follow_joint_trajectory")}', arguments)

    def _tick(self) -> None:
        """Simulate up to the present, and log warnings."""
        self._time.tick()
        self._view.moved(self._arm.measured[:3])
        condition = self._arm.monitor.read_and_clear()
        self._diagnostics.update(condition)
        self._log.strained(condition, self._arm.settings.limits)
        if self._arm.violation:
            self._log.given_up(self._arm.violation)
            self._arm.violation = ()
        self._action.update()
        if self._arm.stop_warnings:
            self.get_logger().warning(
                '; '.join(self._arm.stop_warnings), throttle_duration_sec=WARNING_PERIOD)
            self._arm.stop_warnings = ()

    def _publish(self) -> None:
        """Publish the arm's states."""
        self._view.moved(self._arm.measured[:3])
        self._states.publish(self._time.reached())
        if self._frames is not None:
            self._frames.publish(self._time.reached(), self._arm.measured[:3])

    def _disturb(self, message: JointState) -> None:
        """Apply disturbance torques, or log why they are refused."""
        self._time.advance_to_now()
        try:
            self._arm.disturbance = disturbance_torque(message, self._joint_names)
        except RrrPlannerError as error:
            self._log.refused(str(error))

    def _reset(self, _: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        """Set the arm to its initial positions, at rest."""
        self._time.advance_to_now()
        q = self._parameters_declared.config.initial_positions
        self._arm.reset(q)
        self._action.update()
        self._view.restart()
        response.success = True
        response.message = f'at rest at {_positions(q)} rad'
        return response

    def _hold(self, _: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        """Stop the arm inside its ranges, as fast as its limits allow."""
        self._time.advance_to_now()
        self._arm.hold()
        self._action.update()
        motion = self._arm.motion
        response.success = True
        response.message = (f'at rest in {motion.end - self._arm.time:.3f} s at '
                            f'{_positions(motion.final)} rad')
        return response

    def _pause(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        """Pause or resume simulated time."""
        clock = self._time.simulated_clock
        if clock is None:
            response.success, response.message = False, NOT_THE_CLOCK
            return response
        clock.restart(monotonic_ns(), self._time.now(), paused=request.data)
        response.success = True
        response.message = (f'time {"paused" if request.data else "resumed"} at '
                            f'{self._time.now() / SECOND:.3f} s')
        return response

    def _single_step(self, _: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        """Simulate one step while time is paused."""
        if isinstance(self._time, OwnClock) and self._time.simulated_clock.paused:
            self._time.single_step()
            response.success = True
            response.message = f'stepped to {self._time.now() / SECOND:.3f} s'
        else:
            response.success = False
            response.message = (NOT_THE_CLOCK if self._time.simulated_clock is None
                                else 'time is not paused; call ~/pause first')
        return response

    def _configure(self, config: ArmConfig) -> None:
        """Apply changed parameters."""
        self._arm.configure(config.settings)
        self._view.configure(config)
        self._timer.timer_period_ns = round(SECOND * self._period(config))

    def _period(self, config: ArmConfig) -> float:
        """Set the rates, and return the wall time between ticks [s]."""
        step, rate = config.settings.step, config.publish_rate
        if rate * step > 1.0 + 1e-9:
            self.get_logger().warning(
                f'publish_rate is {rate:g} Hz, but the arm has a new state every physics_step, '
                f'{step:g} s: states are published at {1.0 / step:g} Hz')
        return self._time.period(rate, config.real_time_factor)

    def finish(self) -> bool:
        """
        Abort a goal, since the process ends.

        Returns
        -------
        bool
            Whether there is none, and the client of the last one has its result.

        """
        return self._action.finish()

    def destroy_node(self) -> None:
        """Abort a goal, and release the claim on the node's name."""
        self._action.close()
        self._start.end()
        super().destroy_node()


def _positions(q: Any) -> str:
    return '(' + ', '.join(f'{x:.4f}' for x in q) + ')'
