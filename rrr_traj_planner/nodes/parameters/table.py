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
The table of all parameters of the nodes, and the check of values against it.

This module does not need ROS; `declared` declares the parameters on a node.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import inf, isfinite, pi
from typing import Any, NamedTuple

from rrr_traj_planner.core.arm.limits import NO_EFFORT, NO_RANGE, NO_VELOCITY
from rrr_traj_planner.core.arm.model import JOINT_NAMES
from rrr_traj_planner.core.arm.urdf_tree import BASE, TIP
from rrr_traj_planner.core.errors import counted, format_distinct, InvalidInputError, shown
from rrr_traj_planner.core.trajectory.sampling import MOST_POINTS

PLANNER, ARM, MOTION = 'planner', 'arm', 'motion'

# [rad], at the first via point of the thesis's table 6.1, (1.02, 0.59, 0.97) m, elbow up.
START = (0.5244092235441183, 0.9438995534205477, 0.2480927534820987)

NOTATION_HINT = {
    bool: '', str: '', int: ' (a whole number)', float: ' (written with a point, as 5.0)'}


class Row(NamedTuple):
    """A parameter; with {joint} in its name, one parameter for each joint."""

    name: str
    default: Any  # its type is the parameter's; a tuple of three where the name has {joint}
    meaning: str
    unit: str = ''
    low: float = -inf
    high: float = inf
    read_only: bool = False
    nodes: tuple[str, ...] = (PLANNER, ARM)

    @property
    def range_text(self) -> str:
        """Return the constraint on the value, for messages."""
        if not isinstance(self.default, list):
            return self.item_text
        if isinstance(self.default[0], str):
            return f'{len(self.default)} distinct texts'
        return f'{len(self.default)} numbers {self.item_text}'

    @property
    def item_text(self) -> str:
        """Return the constraint on the value or, for lists, on each item."""
        item = self.default[0] if isinstance(self.default, list) else self.default
        if isinstance(item, bool):
            return 'true or false'
        if isinstance(item, str):
            return 'a text'
        return f'in [{self.low:g}, {self.high:g}]' + (f' {self.unit}' if self.unit else '')


MAX_SEED = 2 ** 31 - 1  # of the noise: the largest signed number of 32 bits


def _joint_limit(name: str, kind: str, values: tuple[Any, ...], unit: str, low: float,
                 high: float) -> tuple[Row, Row]:
    return (Row(f'joint_limits.{{joint}}.has_{name}_limits', (True, True, True),
                f'whether {kind} is limited'),
            Row(f'joint_limits.{{joint}}.max_{name}', values, f'largest {kind}', unit, low, high))


TABLE: tuple[Row, ...] = (
    Row('joint_names', list(JOINT_NAMES), "the joints' names, from the base", read_only=True),
    Row('base_frame', BASE, 'frame of positions', read_only=True),
    Row('tip_frame', TIP, "frame at the arm's tip", read_only=True),
    Row('link_names', ['link_1', 'link_2', 'link_3'], "the links' frames, in robot_description",
        read_only=True, nodes=(ARM,)),
    Row('robot_description', '', 'the arm as a URDF: its text, or the path of its file; empty: '
        'the arm of arm.*', read_only=True),
    Row('joint_limits_file', '', 'path of a MoveIt joint_limits.yaml, for limits that '
        'joint_limits does not give; empty: none', read_only=True),
    Row('arm.d1', 0.5, 'height of joint axis 2 above the base', 'm', -100.0, 100.0, True),
    Row('arm.a2', 0.9, 'length of the upper arm', 'm', 1e-3, 100.0, True),
    Row('arm.d4', 0.7, 'length of the forearm', 'm', 1e-3, 100.0, True),
    Row('arm.l2', 0.5, 'joint axis 2 to centre of mass of link 2', 'm', -100.0, 100.0, True),
    Row('arm.l3', 0.5, 'joint axis 3 to centre of mass of link 3', 'm', -100.0, 100.0, True),
    Row('arm.mass', [40.0, 16.0, 12.0], 'masses of the links', 'kg', 0.0, 1e5, True),
    Row('arm.inertia_1', [1.5, 0.1, 1.5], 'Ix, Iy, Iz of link 1 about its centre of mass, '
        'in the axes of frame 1', 'kg m^2', 0.0, 1e6, True),
    Row('arm.inertia_2', [0.12, 0.12, 0.01], 'the same of link 2', 'kg m^2', 0.0, 1e6, True),
    Row('arm.inertia_3', [0.12, 0.12, 0.01], 'the same of link 3', 'kg m^2', 0.0, 1e6, True),
    Row('arm.gravity', 9.81, 'acceleration of gravity, downwards', 'm/s^2', -100.0, 100.0, True),
    Row('gravity', [0.0, 0.0, -9.81], 'acceleration of gravity in base_frame, in place of '
        'arm.gravity', 'm/s^2', -100.0, 100.0, True),
    Row('rotor_inertia', [0.0, 0.0, 0.0], 'inertia of the motors, reflected to the joints',
        'kg m^2', 0.0, 1e6, True),
    Row('joint_limits.{joint}.min_position', (0.0, 0.0, -pi), 'lower end of the range; '
        f'{-NO_RANGE:g}: none', 'rad', -NO_RANGE, NO_RANGE),
    Row('joint_limits.{joint}.max_position', (pi / 2.0, pi, 2.0 * pi), 'upper end of the range; '
        f'{NO_RANGE:g}: none', 'rad', -NO_RANGE, NO_RANGE),
    *_joint_limit('velocity', 'velocity', (1.0, 1.0, 1.0), 'rad/s', 1e-6,
                  NO_VELOCITY),
    *_joint_limit('acceleration', 'acceleration', (1.0, 1.0, 1.0), 'rad/s^2', 1e-6, 1e4),
    *_joint_limit('jerk', 'jerk', (10.0, 10.0, 10.0), 'rad/s^3', 1e-6, 1e6),
    *_joint_limit('effort', "torque of the joint's motor", (150.0, 200.0, 200.0), 'N m', 1e-6,
                  NO_EFFORT),
    Row('default_max_acceleration', 1.0, 'acceleration limit of joints of a URDF that have none, '
        'for planners that need one', 'rad/s^2', 1e-6, 1e4, nodes=(PLANNER,)),
    Row('default_planner_id', 'cycloid', 'planner of requests without a planner_id',
        nodes=(PLANNER,)),
    Row('sample_period', 0.01, 'time between trajectory points if the request gives none', 's',
        1e-4, 10.0, nodes=(PLANNER,)),
    Row('max_deviation', 0.05, 'largest distance of a Cartesian path from the straight lines '
        'between via points, if the request gives none', 'm', 1e-6, 100.0, nodes=(PLANNER,)),
    Row('start_state_tolerance', 0.01, 'start positions that are less outside a range count as '
        'its end, smaller start velocities as zero', 'rad, rad/s', 0.0, 1.0, nodes=(PLANNER,)),
    Row('max_tip_speed', 0.0, 'bound on the speed of the tip along a Cartesian path; 0: none',
        'm/s', 0.0, 100.0, nodes=(PLANNER,)),
    Row('steady_zones', False, 'whether the speed of the tip is constant on the curved zones of a '
        'Cartesian path', nodes=(PLANNER,)),
    Row('least_jerk_rise', 0.02, 'shortest time in which jerk goes from zero to its limit, in '
        'motions of planner time_optimal; without a jerk limit at most sample_period', 's', 0.001,
        10.0, nodes=(PLANNER,)),
    Row('poly_414.t_acc', 0.5, 'half the duration of a transition of planner poly_414', 's', 0.001,
        100.0, nodes=(PLANNER,)),
    Row('planning_time_limit', 1.0, 'time after which planning stops with the best motion so far, '
        'or with an error that names the step in progress', 's', 1e-3, 3600.0, nodes=(PLANNER,)),
    Row('transform_timeout', 2.0, 'time to wait for the transform of via points in another frame '
        'than base_frame', 's', 0.0, 60.0, nodes=(PLANNER,)),
    Row('max_points', MOST_POINTS, 'largest number of points of an answer; a request for more is '
        'refused before they are computed', 'points', 2, 10_000_000, nodes=(PLANNER,)),
    Row('max_via_points', 1000, 'largest number of via points of a request', 'points', 2, 100_000,
        nodes=(PLANNER,)),
    Row('controller_name', 'simulated_arm', 'the controller that runs motions, by its action '
        'CONTROLLER_NAME/follow_joint_trajectory', read_only=True, nodes=(MOTION,)),
    Row('replanning_lead', 0.25, 'how far ahead of the arm a motion in progress is gone on from; '
        'planning and two messages must take less', 's', 0.02, 10.0, nodes=(MOTION,)),
    Row('planning_timeout', 30.0, 'time after which a planner that does not answer counts as gone',
        's', 0.1, 3600.0, nodes=(MOTION,)),
    Row('discovery_timeout', 10.0, 'time to wait for planner, controller and the state of the arm',
        's', 0.0, 3600.0, nodes=(MOTION,)),
    Row('start_tolerance', 0.01, 'how far a joint may be from the start of a plan when that is '
        'sent', 'rad', 0.0, 1.0, nodes=(MOTION,)),
    Row('publish_rate', 200.0, 'rate of joint_states and desired_joint_states', 'Hz', 1.0, 1000.0,
        nodes=(ARM,)),
    Row('marker_rate', 10.0, 'rate of markers, in wall time; 0: none', 'Hz', 0.0, 100.0,
        nodes=(ARM,)),
    Row('publish_tf', False, 'whether the arm publishes the frames of robot_description, on /tf '
        'and /tf_static', read_only=True, nodes=(ARM,)),
    Row('physics_step', 0.001, 'time step of physics and control', 's', 1e-5, 0.01, True, (ARM,)),
    Row('initial_positions', list(START),
        'joint positions at the start and after ~/reset', 'rad', -NO_RANGE, NO_RANGE,
        nodes=(ARM,)),
    Row('controller.natural_frequency', 30.0, 'natural frequency of the tracking error', 'rad/s',
        0.1, 1000.0, nodes=(ARM,)),
    Row('controller.damping_ratio', 1.0, 'damping ratio of the tracking error; 1 is critical', '',
        0.01, 10.0, nodes=(ARM,)),
    Row('payload.mass', 0.0, 'point mass at the tip', 'kg', 0.0, 1e4),
    Row('payload.known_to_controller', False, "whether the controller's model has the payload",
        nodes=(ARM,)),
    Row('friction.viscous', [0.0, 0.0, 0.0], 'viscous friction of each joint',
        'N m s/rad', 0.0, 1e5),
    Row('friction.coulomb', [0.0, 0.0, 0.0], 'Coulomb friction of each joint',
        'N m', 0.0, 1e5),
    Row('friction.known_to_controller', False, 'whether the controller adds the friction of the '
        'motion that it follows', nodes=(ARM,)),
    Row('soft_stops.width', 0.0, 'width of the bumpers between the ends of the ranges and the '
        'hard stops; 0: no bumpers', 'rad', 0.0, 1.0, nodes=(ARM,)),
    Row('soft_stops.stiffness', 1e4, 'stiffness of a bumper', 'N m/rad', 0.0, 1e6, nodes=(ARM,)),
    Row('soft_stops.damping', 0.2, 'damping of a bumper, per stiffness', 's/rad', 0.0, 100.0,
        nodes=(ARM,)),
    Row('encoder.resolution', 0.0, 'measured positions are multiples of it; 0: exact', 'rad', 0.0,
        0.1, nodes=(ARM,)),
    Row('encoder.noise', 0.0, 'standard deviation of the noise of measured positions', 'rad', 0.0,
        0.1, nodes=(ARM,)),
    Row('encoder.seed', 0, 'seed of the noise', '', 0, MAX_SEED, nodes=(ARM,)),
    Row('encoder.bandwidth', 250.0, 'bandwidth of the velocity estimate, used if there is '
        'resolution or noise', 'rad/s', 1.0, 1e4, nodes=(ARM,)),
    Row('allow_partial_joints_goal', False, 'whether a trajectory may leave joints out; they '
        'hold their position', nodes=(ARM,)),
    Row('allow_nonzero_velocity_at_trajectory_end', False, 'whether the last point of a '
        'trajectory may have a velocity', nodes=(ARM,)),
    Row('constraints.stopped_velocity_tolerance', 0.01, 'largest velocity error at the goal; 0: '
        'not checked', 'rad/s', 0.0, 1e3, nodes=(ARM,)),
    Row('constraints.goal_time', 0.0, "time after a trajectory's end in which the goal tolerances "
        'must be met; 0: not checked', 's', 0.0, 1e6, nodes=(ARM,)),
    Row('constraints.{joint}.trajectory', (0.0, 0.0, 0.0), 'largest position error during a '
        'trajectory, beyond which it is aborted; 0: not checked', 'rad', 0.0, 1e3, nodes=(ARM,)),
    Row('constraints.{joint}.goal', (0.0, 0.0, 0.0), 'largest position error at the goal, after '
        'constraints.goal_time; 0: not checked', 'rad', 0.0, 1e3, nodes=(ARM,)),
    Row('cmd_timeout', 0.0, "time after a trajectory's end after which the arm holds its measured "
        'position; ignored unless above constraints.goal_time; 0: never', 's', 0.0, 1e6,
        nodes=(ARM,)),
    Row('publish_clock', False, 'whether the arm publishes its simulated time on /clock',
        read_only=True, nodes=(ARM,)),
    Row('real_time_factor', 1.0, 'simulated time per wall time if the arm publishes /clock; 0: as '
        'fast as possible', '', 0.0, 1000.0, nodes=(ARM,)),
)


def rows_of(node: str, joint_names: Sequence[str]) -> dict[str, Row]:
    """
    Return the parameters of a node by their names.

    Parameters
    ----------
    node : str
        `PLANNER`, `ARM` or `MOTION`.
    joint_names : sequence of str
        The three joints.

    Returns
    -------
    dict
        A row with a plain name and default for each.

    """
    rows: dict[str, Row] = {}
    for row in TABLE:
        if node not in row.nodes:
            continue
        if '{joint}' not in row.name:
            rows[row.name] = row
            continue
        for joint, default in zip(joint_names, row.default):
            name = row.name.format(joint=joint)
            rows[name] = row._replace(name=name, default=default)
    return rows


def check_value(row: Row, value: Any) -> None:
    """
    Refuse a value of the wrong type or outside its range.

    Parameters
    ----------
    row : Row
        The parameter.
    value : object
        Its value; lists may come as any sequence.

    Raises
    ------
    InvalidInputError
        Names parameter, value and range.

    """
    is_list = isinstance(row.default, list)
    expected = type(row.default[0] if is_list else row.default)
    sequence = hasattr(value, '__len__') and not isinstance(value, (str, bytes))
    items = list(value) if sequence else [value]
    if sequence != is_list or any(type(x) is not expected for x in items):
        raise InvalidInputError(
            f'{row.name} is {_shown(value)}, must be {row.range_text}{NOTATION_HINT[expected]}')
    if is_list and len(items) != len(row.default):
        raise InvalidInputError(
            f'{row.name} has {counted(len(items), "value")}, {_shown(value)}, must be '
            f'{row.range_text}')
    for i, x in enumerate(items):
        if expected in (int, float) and not (isfinite(x) and row.low <= x <= row.high):
            index = f'[{i}]' if is_list else ''
            unit = f' {row.unit}' if row.unit else ''
            raise InvalidInputError(
                f'{row.name}{index} is {format_distinct(x, row.low, row.high)[0]}{unit}, must be '
                f'{row.item_text}')


def _shown(value: Any) -> str:
    is_sequence = hasattr(value, '__len__') and not isinstance(value, (str, bytes))
    return shown(list(value) if is_sequence else value)
