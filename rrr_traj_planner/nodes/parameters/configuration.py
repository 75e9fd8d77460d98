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

"""Configurations of planner and arm: frozen, built from parameters, checked as a whole."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import inf
from typing import Any

import numpy as np
from rrr_traj_planner.core.arm.degrees import explained_by_degrees, HINT
from rrr_traj_planner.core.arm.lengths import ArmLengths
from rrr_traj_planner.core.arm.limits import JointLimits, NO_RANGE
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arm.payload import with_payload
from rrr_traj_planner.core.arm.urdf import FrameNames, urdf
from rrr_traj_planner.core.arrays import Array, finite_array
from rrr_traj_planner.core.control.computed_torque import ControllerGains
from rrr_traj_planner.core.control.trajectory_validation import Rules
from rrr_traj_planner.core.errors import format_distinct, InvalidInputError, LimitViolationError
from rrr_traj_planner.core.simulation.arm_settings import ArmSettings
from rrr_traj_planner.nodes.parameters.arm_options import (
    encoder,
    frame_names,
    friction,
    physical_options,
    trajectory_rules,
)
from rrr_traj_planner.nodes.parameters.arm_source import read
from rrr_traj_planner.nodes.parameters.error_names import from_group, named
from rrr_traj_planner.planners.effort_limits import check_friction
from rrr_traj_planner.planners.registry import planner

Values = Mapping[str, Any]

# Bound on damping * physics_step. The torque is constant over a step, which multiplies a velocity
# error by 1 - damping * step: the error's sign alternates if the product is above 1, and the error
# grows if it is above 2.
MAX_DAMPING_PER_STEP = 1.0


@dataclass(frozen=True, eq=False)
class PlannerConfig:
    """The planner node's configuration; times in [s], lengths in [m]."""

    model: RobotModel  # with its payload
    limits: JointLimits
    base_frame: str
    tip_frame: str
    default_max_acceleration: float  # infinite for the thesis's kind of arm
    default_planner_id: str
    sample_period: float
    max_deviation: float
    start_state_tolerance: float
    max_tip_speed: float  # 0: none
    steady_zones: bool
    half_transition: float
    least_jerk_rise: float
    planning_time_limit: float
    transform_timeout: float
    max_points: int
    max_via_points: int
    urdf: str  # empty: the thesis's kind of arm

    @classmethod
    def from_values(cls, values: Values) -> PlannerConfig:
        """
        Return the configuration that parameters describe.

        Parameters
        ----------
        values : mapping
            Each parameter's value by name.

        Returns
        -------
        PlannerConfig
            Checked as a whole.

        Raises
        ------
        InvalidInputError
            If the values contradict each other, friction leaves a motor no torque for motion, or
            the default planner is unknown.

        """
        try:
            planner(values['default_planner_id'])
        except InvalidInputError as error:
            raise InvalidInputError(f'default_planner_id: {error}') from None
        with named({'mass': 'payload.mass'}):
            model = with_payload(robot_model(values), values['payload.mass'])
        limits = joint_limits(values)
        try:
            check_friction(model, limits)
        except LimitViolationError as error:
            raise InvalidInputError(str(error)) from None
        return cls(
            model, limits,
            default_max_acceleration=(
                values['default_max_acceleration'] if values['robot_description'] else inf),
            half_transition=values['poly_414.t_acc'], urdf=values['robot_description'],
            **{name: values[name] for name in (
                'base_frame', 'tip_frame', 'default_planner_id', 'sample_period',
                'max_deviation', 'least_jerk_rise', 'start_state_tolerance', 'max_tip_speed',
                'steady_zones', 'planning_time_limit', 'transform_timeout', 'max_points',
                'max_via_points')})

    def limits_for(self, *planner_ids: str) -> JointLimits:
        """
        Return the limits for planners, with `default_max_acceleration` where one needs it.

        Parameters
        ----------
        *planner_ids : str
            Their ids; empty: the default one.

        Returns
        -------
        JointLimits
            The same object where no acceleration limit is missing, or none is needed.

        """
        missing = np.isinf(self.limits.max_acceleration)
        if not missing.any() or np.isinf(self.default_max_acceleration):
            return self.limits
        methods = [planner(planner_id or self.default_planner_id) for planner_id in planner_ids]
        if not any(method.needs_acceleration_limit for method in methods):
            missing &= np.isinf(self.limits.max_effort) | bool(self.model.singular_inertia_reason)
        return replace(self.limits, max_acceleration=np.where(
            missing, self.default_max_acceleration, self.limits.max_acceleration))


@dataclass(frozen=True, eq=False)
class ArmConfig:
    """The arm node's configuration; rates in [Hz], positions in [rad]."""

    settings: ArmSettings
    publish_rate: float
    initial_positions: Array
    rules: Rules
    publish_clock: bool
    real_time_factor: float
    frames: FrameNames
    marker_rate: float  # 0: none
    urdf: str
    publish_tf: bool

    @classmethod
    def from_values(cls, values: Values) -> ArmConfig:
        """
        Return the configuration that parameters describe.

        Parameters
        ----------
        values : mapping
            Each parameter's value by name.

        Returns
        -------
        ArmConfig
            Checked as a whole.

        Raises
        ------
        InvalidInputError
            If the values contradict each other.

        """
        limits = joint_limits(values)
        gains = from_group(ControllerGains, 'controller', values)
        step = values['physics_step']
        if gains.damping * step > MAX_DAMPING_PER_STEP:
            frequency, most = format_distinct(gains.natural_frequency, MAX_DAMPING_PER_STEP / (
                2.0 * gains.damping_ratio * step))
            raise InvalidInputError(
                f'controller.natural_frequency is {frequency} rad/s, must be at most {most} rad/s '
                f'with controller.damping_ratio {gains.damping_ratio:g} and physics_step '
                f'{step:g} s')
        with named({'step': 'physics_step'}):
            settings = ArmSettings(robot_model(values), limits, gains, step,
                                   encoder=encoder(values, gains), **physical_options(values))
        frames = frame_names(values)
        return cls(settings, values['publish_rate'], _initial_positions(values, limits),
                   trajectory_rules(values), values['publish_clock'], values['real_time_factor'],
                   frames, values['marker_rate'],
                   values['robot_description'] or urdf(settings.model, limits, frames),
                   values['publish_tf'])


def robot_model(values: Values) -> RobotModel:
    """
    Return the arm's model.

    Parameters
    ----------
    values : mapping
        Each parameter's value by name.

    Returns
    -------
    RobotModel
        Without payload.

    Raises
    ------
    InvalidInputError
        If the inertia matrix of an arm without a URDF is singular in some pose, or names repeat.

    """
    others = {'gravity': np.array(values['gravity']),
              'rotor_inertia': np.array(values['rotor_inertia']), 'friction': friction(values),
              'joint_names': values['joint_names']}
    if values['robot_description']:
        arm = read(values['robot_description'], values['base_frame'], values['tip_frame'])
        return RobotModel(arm.chain, **others)
    model = RobotModel(_lengths(values).chain(), **others)
    if model.singular_inertia_reason:
        raise InvalidInputError(model.singular_inertia_reason)
    return model


def _lengths(values: Values) -> ArmLengths:
    inertia = np.array([list(values[f'arm.inertia_{i}']) for i in (1, 2, 3)])
    parameters = {name: f'arm.{name}' for name in ('d1', 'a2', 'd4', 'l2', 'l3', 'mass')}
    with named(parameters):
        return ArmLengths(
            **{name: values[parameter] for name, parameter in parameters.items()},
            inertia=inertia)


def joint_limits(values: Values) -> JointLimits:
    """
    Return the joints' limits, infinite where `has_..._limits` is false or a range has no end.

    Parameters
    ----------
    values : mapping
        Each parameter's value by name.

    Returns
    -------
    JointLimits
        The limits.

    Raises
    ------
    InvalidInputError
        If a range of positions is empty.

    """
    joints = [f'joint_limits.{joint}' for joint in values['joint_names']]
    for joint in joints:
        low, high = values[f'{joint}.min_position'], values[f'{joint}.max_position']
        if low >= high:
            least, most = format_distinct(low, high)
            raise InvalidInputError(f'{joint}.min_position is {least} rad, must be below '
                                    f'{joint}.max_position, {most} rad')
    largest = {
        f'max_{name}': np.array([
            values[f'{joint}.max_{name}'] if values[f'{joint}.has_{name}_limits'] else inf
            for joint in joints])
        for name in ('velocity', 'acceleration', 'jerk', 'effort')}
    low, high = (np.array([values[f'{joint}.{end}_position'] for joint in joints])
                 for end in ('min', 'max'))
    return JointLimits(np.where(low <= -NO_RANGE, -inf, low),
                       np.where(high >= NO_RANGE, inf, high), **largest)


def _initial_positions(values: Values, limits: JointLimits) -> Array:
    """Return the initial joint positions; refuse positions outside their ranges."""
    q = finite_array('initial_positions', values['initial_positions'], (3,))
    for i, (x, low, high) in enumerate(zip(q, limits.min_position, limits.max_position)):
        if not low <= x <= high:
            at, least, most = format_distinct(x, low, high)
            hint = HINT if explained_by_degrees(x, low, high) else ''
            raise InvalidInputError(
                f'initial_positions[{i}] is {at} rad, must be in [{least}, {most}] rad, the '
                f"limits of {values['joint_names'][i]}{hint}")
    return q
