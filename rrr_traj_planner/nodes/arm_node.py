"""The node `simulated_arm`: the arm and its controller against the clock, on ROS topics."""

from __future__ import annotations

from typing import Any

from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.node import Node
from rrr_traj_planner.core.controlled_arm import ControlledArm
from rrr_traj_planner.core.errors import RrrPlannerError
from rrr_traj_planner.core.incoming_trajectory import check_trajectory, motion_points, NANOSECOND
from rrr_traj_planner.nodes.arm_messages import incoming_trajectory, JointStateMessage, SECOND
from rrr_traj_planner.nodes.configuration import ArmConfig
from rrr_traj_planner.nodes.declared_parameters import DeclaredParameters
from rrr_traj_planner.nodes.parameters import ARM
from sensor_msgs.msg import JointState
from std_srvs.srv import Trigger
from trajectory_msgs.msg import JointTrajectory

QUEUE_DEPTH = 10

# A tick simulates at most this much time, so that services are answered while the arm catches
# up with the clock [ns].
MOST_AT_ONCE = SECOND // 10

# Further behind than this the node says so [ns], and so often [s].
LATE, WARNING_PERIOD = SECOND // 10, 2.0

# The clock itself has jumped when it is so far behind or ahead of the arm [ns].
JUMP_BACK, JUMP_AHEAD = SECOND // 10, 10 * SECOND


class SimulatedArm(Node):
    """
    An arm that follows trajectories as joint_trajectory_controller would have it.

    Simulated time is the node's clock: at every tick physics and control run up to now, in whole
    steps, and what is published carries the time of the last one.

    Parameters
    ----------
    **kwargs
        For `rclpy.node.Node`, such as context and parameter_overrides.

    Notes
    -----
    Subscribes `joint_trajectory`; publishes `joint_states` (position, velocity, the motors'
    torque) and `desired_joint_states` (what the controller follows); serves `~/reset` and
    `~/hold`. Parameters: see `parameters.py`.

    """

    def __init__(self, **kwargs: Any) -> None:
        super().__init__('simulated_arm', **kwargs)
        self._parameters_declared = DeclaredParameters(
            self, ARM, ArmConfig.from_values, self._configure)
        config = self._parameters_declared.config
        self._joint_names = config.settings.model.joint_names
        self._arm = ControlledArm(config.settings, config.initial_positions)
        self._step = round(config.settings.step * SECOND)  # ns
        self._actual = JointStateMessage(self._joint_names)
        self._desired = JointStateMessage(self._joint_names)
        self._publish_actual = self.create_publisher(
            JointState, 'joint_states', QUEUE_DEPTH).publish
        self._publish_desired = self.create_publisher(
            JointState, 'desired_joint_states', QUEUE_DEPTH).publish
        self.create_subscription(
            JointTrajectory, 'joint_trajectory', self._follow, QUEUE_DEPTH)
        self.create_service(Trigger, '~/reset', self._reset)
        self.create_service(Trigger, '~/hold', self._hold)
        self._epoch = self._now()  # when the arm's own time began, on the node's clock [ns]
        # The timer runs on steady time, whatever the clock does.
        self._timer = self.create_timer(
            1.0 / config.publish_rate, self._tick, clock=Clock(clock_type=ClockType.STEADY_TIME))

    def _now(self) -> int:
        """Return the node's clock [ns]."""
        return int(self.get_clock().now().nanoseconds)

    def _tick(self) -> None:
        """Bring the arm up to now, and publish how it is."""
        self._catch_up()
        stamp = self._epoch + self._arm.steps * self._step
        state, desired = self._arm.state, self._arm.desired
        self._publish_actual(self._actual.filled(
            stamp, state[:3], state[3:], self._arm.torque))
        self._publish_desired(self._desired.filled(stamp, desired[:3], desired[3:6]))

    def _catch_up(self) -> None:
        """Simulate up to now in whole steps, but no more than a tick's worth at once."""
        behind = self._now() - self._epoch - self._arm.steps * self._step  # ns
        if not -JUMP_BACK <= behind <= JUMP_AHEAD:
            self.get_logger().warning(
                f'the clock jumped by {behind * NANOSECOND:+.3f} s; the arm and what it follows '
                'go on from there')
            self._epoch += behind
            return
        self._arm.advance(max(min(behind, MOST_AT_ONCE) // self._step, 0))
        if behind > MOST_AT_ONCE + LATE:
            self.get_logger().warning(
                f'simulated time is {(behind - MOST_AT_ONCE) * NANOSECOND:.3f} s behind the '
                'clock: this machine is busy or too slow', throttle_duration_sec=WARNING_PERIOD)

    def _follow(self, message: JointTrajectory) -> None:
        """Take over a trajectory, or say why not and go on as before."""
        self._catch_up()
        trajectory = incoming_trajectory(message)
        try:
            check_trajectory(trajectory, self._joint_names, self._now())
            points = motion_points(trajectory, self._joint_names)
        except RrrPlannerError as error:
            self.get_logger().error(str(error))
            return
        started = trajectory.stamp != 0
        origin = (trajectory.stamp - self._epoch) * NANOSECOND if started else self._arm.time
        self._arm.follow(points, origin)
        self.get_logger().info(
            f'following {len(trajectory.points)} points, until '
            f'{self._arm.motion.end - self._arm.time:.3f} s from now')

    def _reset(self, _: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        """Put the arm back to its initial positions, at rest."""
        self._catch_up()
        q = self._parameters_declared.config.initial_positions
        self._arm.reset(q)
        response.success = True
        response.message = f'at rest at {_positions(q)} rad'
        return response

    def _hold(self, _: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        """Stop the arm as fast as its limits allow."""
        self._catch_up()
        self._arm.hold()
        motion = self._arm.motion
        response.success = True
        response.message = (f'at rest in {motion.end - self._arm.time:.3f} s at '
                            f'{_positions(motion.final)} rad')
        return response

    def _configure(self, config: ArmConfig) -> None:
        """Put changed parameters in force."""
        self._arm.configure(config.settings)
        self._timer.timer_period_ns = round(SECOND / config.publish_rate)


def _positions(q: Any) -> str:
    return '(' + ', '.join(f'{x:.4f}' for x in q) + ')'
