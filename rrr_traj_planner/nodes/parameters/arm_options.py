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

"""Options of the simulated arm from parameters: payload, friction, encoders, tolerances, rules."""

from __future__ import annotations

from collections.abc import Mapping
from math import sqrt
from typing import Any

import numpy as np
from rrr_traj_planner.core.arm.friction import Friction
from rrr_traj_planner.core.arm.payload import Payload
from rrr_traj_planner.core.arm.urdf import check_frames, FrameNames
from rrr_traj_planner.core.control.computed_torque import ControllerGains
from rrr_traj_planner.core.control.tolerances import Tolerances
from rrr_traj_planner.core.control.trajectory_validation import Rules
from rrr_traj_planner.core.errors import format_distinct, InvalidInputError
from rrr_traj_planner.core.simulation.encoder import EncoderSettings
from rrr_traj_planner.core.simulation.soft_stops import SoftStops
from rrr_traj_planner.nodes.parameters.error_names import from_group, named

Values = Mapping[str, Any]

# Least bandwidth of the encoders' velocity estimate, over that at the limit of stability; chosen:
# a gain margin of two, 6 dB.
STABILITY_MARGIN = 2.0


def physical_options(values: Values) -> dict[str, Any]:
    """
    Return payload, soft stops and tolerances.

    Parameters
    ----------
    values : mapping
        Each parameter's value by name.

    Returns
    -------
    dict
        These arguments of `ArmSettings`.

    """
    return {
        'payload': from_group(Payload, 'payload', values),
        'soft_stops': from_group(SoftStops, 'soft_stops', values),
        'tolerances': tolerances(values)}


def friction(values: Values) -> Friction:
    """
    Return the friction of the arm's joints.

    Parameters
    ----------
    values : mapping
        Each parameter's value by name.

    Returns
    -------
    Friction
        The planner has no `friction.known_to_controller`.

    """
    with named({name: f'friction.{name}' for name in ('viscous', 'coulomb')}):
        return Friction(values['friction.viscous'], values['friction.coulomb'],
                        values.get('friction.known_to_controller', False))


def tolerances(values: Values) -> Tolerances:
    """
    Return the tolerances of trajectory following.

    Parameters
    ----------
    values : mapping
        Each parameter's value by name.

    Returns
    -------
    Tolerances
        Arrays in the order of the joints.

    """
    of_joints = [np.array([values[f'constraints.{joint}.{name}']
                           for joint in values['joint_names']]) for name in ('trajectory', 'goal')]
    with named({'trajectory': 'constraints.JOINT.trajectory', 'goal': 'constraints.JOINT.goal',
                'stopped_velocity': 'constraints.stopped_velocity_tolerance',
                'goal_time': 'constraints.goal_time'}):
        return Tolerances(
            *of_joints, np.full(3, values['constraints.stopped_velocity_tolerance']),
            values['constraints.goal_time'], values['cmd_timeout'])


def encoder(values: Values, gains: ControllerGains) -> EncoderSettings:
    """
    Return the encoder settings; check that the controller is stable with them.

    Parameters
    ----------
    values : mapping
        Each parameter's value by name.
    gains : ControllerGains
        Gains of the controller that uses the velocity estimate.

    Returns
    -------
    EncoderSettings
        Common to all joints.

    Raises
    ------
    InvalidInputError
        If the velocity estimate is too slow for the controller.

    """
    settings = from_group(EncoderSettings, 'encoder', values)
    # Routh's criterion for the encoders' tracking loop inside the controller's: stable if
    # bandwidth / natural frequency > (zeta + sqrt(zeta^2 + 4)) / 2.
    zeta = gains.damping_ratio
    least = STABILITY_MARGIN * 0.5 * (zeta + sqrt(zeta * zeta + 4.0)) * gains.natural_frequency
    if not settings.is_ideal and settings.bandwidth < least:
        bandwidth, lowest = format_distinct(settings.bandwidth, least)
        raise InvalidInputError(
            f'encoder.bandwidth is {bandwidth} rad/s, must be at least {lowest} rad/s '
            f'with controller.natural_frequency {gains.natural_frequency:g} rad/s and '
            f'controller.damping_ratio {zeta:g}')
    return settings


def trajectory_rules(values: Values) -> Rules:
    """
    Return the rules by which trajectories are accepted.

    Parameters
    ----------
    values : mapping
        Each parameter's value by name.

    Returns
    -------
    Rules
        Fields are named like joint_trajectory_controller's parameters.

    """
    return Rules(*(values[name] for name in Rules._fields))


def frame_names(values: Values) -> FrameNames:
    """
    Return the names of the arm's frames.

    Parameters
    ----------
    values : mapping
        Each parameter's value by name.

    Returns
    -------
    FrameNames
        Names for base, links and tip.

    Raises
    ------
    InvalidInputError
        If a name is empty or repeats.

    """
    frames = FrameNames(
        values['base_frame'], tuple(values['link_names']), values['tip_frame'])
    check_frames(frames)
    return frames
