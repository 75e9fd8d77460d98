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

"""What a URDF was understood to say of an arm, as lines of text for a person to check."""

from __future__ import annotations

from collections.abc import Iterator
from math import degrees

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arm.urdf_arm import UrdfArm
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.dynamics.rigid_body import gravity_torque
from rrr_traj_planner.core.kinematics.branch_factors import has_named_postures
from rrr_traj_planner.core.kinematics.common_normal import common_normal
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.planners.effort_limits import check_friction, checked_limits

# Lengths over the arm's size, and angles [rad], up to which they count as zero: descriptions from
# CAD are rounded to 1e-4 at worst.
ROUNDING = 1e-4

STEPS = 60       # of each joint's range, for the reach
POSES = 2000     # for the torque of gravity
SEED = 1


def summary(arm: UrdfArm, model: RobotModel, limits: JointLimits) -> list[str]:
    """
    Return what is planned with, for an arm of a URDF.

    Parameters
    ----------
    arm : UrdfArm
        What the URDF says.
    model : RobotModel
        The arm that is planned for.
    limits : JointLimits
        Its limits.

    Returns
    -------
    list of str
        Joints, links, geometry, reach and the torque that holds the arm.

    Raises
    ------
    LimitViolationError
        If a joint's motor cannot overcome its friction.

    """
    check_friction(model, checked_limits(model, limits))
    return [f'three joints from link {arm.base} to link {arm.tip}', 'joints',
            *_joints(model, limits), 'links, with what is fixed to them', *_links(arm, model),
            'geometry', *(f'  {line}' for line in (
                _first_axes(model), _last_axes(model), _tilt(model), _postures(model))),
            'reach, over the ranges', *_reach(model, limits), *_holding(model, limits)]


def _joints(model: RobotModel, limits: JointLimits) -> Iterator[str]:
    kinds = (('max_velocity', 'velocity', 'rad/s'), ('max_acceleration', 'acceleration',
             'rad/s^2'), ('max_jerk', 'jerk', 'rad/s^3'), ('max_effort', 'effort', 'N m'))
    for i, name in enumerate(model.joint_names):
        low, high = limits.min_position[i], limits.max_position[i]
        parts = [f'{low:.4g} to {high:.4g} rad' if np.isfinite((low, high)).any() else 'no range']
        found = [(kind, getattr(limits, field)[i], unit) for field, kind, unit in kinds]
        parts += [f'{value:.4g} {unit}' for _, value, unit in found if np.isfinite(value)]
        missing = [kind for kind, value, _ in found if np.isinf(value)]
        parts += [f'no limit on {_listed(missing)}'] if missing else []
        friction = (f'friction {model.friction.viscous[i]:.4g} N m s/rad and '
                    f'{model.friction.coulomb[i]:.4g} N m')
        yield f'  {name}: {", ".join(parts)}; {friction}'


def _listed(names: list[str]) -> str:
    return ' and '.join(filter(None, (', '.join(names[:-1]), names[-1])))


def _links(arm: UrdfArm, model: RobotModel) -> Iterator[str]:
    for name, mass, centre in zip(arm.link_names, model.chain.mass, model.chain.centre):
        where = ', '.join(f'{x:.4g}' for x in centre + 0.0)
        yield f'  {name}: {mass:.4g} kg' + (
            f', centre of mass with joints at zero ({where}) m' if mass > 0.0 else '')
    if model.singular_inertia_reason:
        yield '  torque is not checked, and the arm cannot be simulated: ' + (
            'no link has a mass' if not arm.has_masses else model.singular_inertia_reason)


def _first_axes(model: RobotModel) -> str:
    g = common_normal(model)
    angle = degrees(np.arctan2(g.s, abs(g.c)))
    right = abs(g.c) <= ROUNDING
    at = 'at right angles' if right else f'at {angle:.4g} deg'
    if abs(g.a) <= ROUNDING * g.size:
        return f'joint axes 1 and 2 meet {at}'
    return f'radial offset: joint axis 2 passes joint axis 1 at {abs(g.a):.4g} m, {at}'


def _last_axes(model: RobotModel) -> str:
    z2, z3 = model.chain.axis[1:]
    g = common_normal(model)
    sine, cosine = float(np.linalg.norm(np.cross(z2, z3))), float(abs(z2 @ z3))
    if sine > ROUNDING:
        if cosine <= ROUNDING:
            return 'joint axes 2 and 3 are perpendicular'
        return f'joint axes 2 and 3 are skew, at {degrees(np.arctan2(sine, cosine)):.4g} deg'
    if abs(g.k[0]) <= ROUNDING * g.size:
        return 'joint axes 2 and 3 are parallel, without lateral offset'
    return (f'joint axes 2 and 3 are parallel, with a lateral offset of the tip by '
            f'{abs(g.k[0]):.4g} m along them')


def _tilt(model: RobotModel) -> str:
    size = float(np.linalg.norm(model.gravity))
    if size == 0.0:
        return 'there is no gravity'
    axis, down = model.chain.axis[0], model.gravity / size
    upright = float(abs(axis @ down))
    across = float(np.linalg.norm(np.cross(axis, down)))
    if across <= ROUNDING:
        return 'joint axis 1 is vertical'
    if upright <= ROUNDING:
        return 'joint axis 1 is horizontal'
    return f'joint axis 1 is tilted by {degrees(np.arctan2(across, upright)):.4g} deg'


def _postures(model: RobotModel) -> str:
    if has_named_postures(model):
        return 'postures have names: elbow up or down, shoulder front or back'
    return 'postures have no names: requests may not ask for one'


def _ranges(limits: JointLimits) -> tuple[Array, Array]:
    """Return the ranges, a revolution where there is none."""
    low, high = limits.min_position, limits.max_position
    low = np.where(np.isfinite(low), low, np.where(np.isfinite(high), high - 2.0 * np.pi, -np.pi))
    return low, np.where(np.isfinite(high), high, low + 2.0 * np.pi)


def _reach(model: RobotModel, limits: JointLimits) -> Iterator[str]:
    """Yield distances of the tip, which do not depend on joint 1."""
    low, high = _ranges(limits)
    q2, q3 = (x.ravel() for x in np.meshgrid(
        *(np.linspace(low[j], high[j], STEPS + 1) for j in (1, 2))))
    tip = forward_kinematics(model, np.column_stack((np.zeros_like(q2), q2, q3)))
    g = common_normal(model)
    foot, axis = np.array(g.c1) + g.a * np.array(g.n), model.chain.axis[0]
    radial = np.linalg.norm(np.cross(tip - np.array(g.c1), axis), axis=1)
    for name, distance in (('the shoulder, on joint axis 2', np.linalg.norm(tip - foot, axis=1)),
                           ('joint axis 1', radial)):
        yield f'  the tip is {distance.min():.4g} to {distance.max():.4g} m from {name}'


def _holding(model: RobotModel, limits: JointLimits) -> Iterator[str]:
    """Yield the largest torques of gravity over the ranges, if there are any."""
    if not model.chain.mass.any():
        return
    low, high = _ranges(limits)
    q = np.random.default_rng(SEED).uniform(low, high, (POSES, 3))
    torque = np.abs(gravity_torque(model, q))
    most = limits.max_effort
    yield 'torque to hold the arm, over the ranges'
    for i, name in enumerate(model.joint_names):
        limit = f' of {most[i]:.4g}' if np.isfinite(most[i]) else ''
        yield f'  {name}: up to {torque[:, i].max():.4g}{limit} N m'
    beyond = float((torque > most).any(axis=1).mean())
    if beyond > 0.0:
        yield f'  some {max(100.0 * beyond, 0.1):.2g} % of the poses cannot be held'
