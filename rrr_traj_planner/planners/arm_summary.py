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

from collections.abc import Callable, Iterator
from math import degrees

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arm.urdf_arm import UrdfArm
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.dynamics.rigid_body import gravity_torque
from rrr_traj_planner.core.errors import format_distinct
from rrr_traj_planner.core.kinematics.branch_factors import has_named_postures
from rrr_traj_planner.core.kinematics.common_normal import common_normal
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.planners.effort_limits import check_friction
from rrr_traj_planner.planners.range_extremes import finite_ranges, largest

# Of offsets over the arm's size, of angles [rad], and of torques over that of the arm's weight at
# its size: what counts as zero, as descriptions from CAD are rounded to 1e-4 at worst.
ROUNDING = 1e-4
SMALL = 1e-3     # part of the arm's size up to which a distance of the tip is told as zero
POSES = 2000     # from which extremes over the ranges are sought
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
    check_friction(model, limits)
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
        unchecked = '' if model.has_inertia else 'torque is not checked, and '
        yield f'  {unchecked}the arm cannot be simulated: {model.singular_inertia_reason}'


def _first_axes(model: RobotModel) -> str:
    g = common_normal(model)
    angle = degrees(np.arctan2(g.s, abs(g.c)))
    right = abs(g.c) <= ROUNDING
    at = 'at right angles' if right else f'at {angle:.4g} deg'
    if abs(g.a) <= ROUNDING * g.size:
        return f'joint axes 1 and 2 meet {at}'
    return f'shoulder offset {abs(g.a):.4g} m (common normal of joint axes 1 and 2), axes {at}'


def _last_axes(model: RobotModel) -> str:
    z2, z3 = model.chain.axis[1:]
    g = common_normal(model)
    sine, cosine = float(np.linalg.norm(np.cross(z2, z3))), float(abs(z2 @ z3))
    if sine > ROUNDING:
        if cosine <= ROUNDING:
            return 'joint axes 2 and 3 are at right angles'
        return f'joint axes 2 and 3 are at {degrees(np.arctan2(sine, cosine)):.4g} deg'
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


def _random_poses(limits: JointLimits) -> Array:
    return np.random.default_rng(SEED).uniform(*finite_ranges(limits), (POSES, 3))


def _reach(model: RobotModel, limits: JointLimits) -> Iterator[str]:
    """Yield distances of the tip, which do not depend on joint 1."""
    g = common_normal(model)
    foot, axis = np.array(g.c1) + g.a * np.array(g.n), model.chain.axis[0]

    def from_foot(q: Array) -> Array:
        """Return squares, which are smooth where the tip is at the foot or on the axis."""
        return np.asarray(((_tip(model, q) - foot) ** 2).sum(axis=1))

    def from_axis(q: Array) -> Array:
        return np.asarray((np.cross(_tip(model, q) - np.array(g.c1), axis) ** 2).sum(axis=1))

    for name, square in (('the shoulder, on joint axis 2', from_foot),
                         ('joint axis 1', from_axis)):
        least, most = _extremes(square, limits)
        yield (f'  the tip is {_length(np.sqrt(least), g.size)} to '
               f'{_length(np.sqrt(most), g.size)} m from {name}')


def _tip(model: RobotModel, q: Array) -> Array:
    """Return the tip's position with joint 1 at zero."""
    return forward_kinematics(model, q * (0.0, 1.0, 1.0))


def _extremes(square: Callable[[Array], Array], limits: JointLimits) -> tuple[float, float]:
    """Return the least and the largest value over the ranges, not negative."""
    poses = _random_poses(limits)
    return (max(-largest(lambda q: -square(q), limits, poses), 0.0),
            largest(square, limits, poses))


def _length(x: float, size: float) -> str:
    """Return a length [m] as text, to a thousandth of the arm's size or a little finer."""
    decimals = int(np.ceil(-np.log10(SMALL * size)))
    return np.format_float_positional(round(x, decimals), trim='-') if x >= SMALL * size else '0'


def _holding(model: RobotModel, limits: JointLimits) -> Iterator[str]:
    """Yield the largest torques of gravity over the ranges, if there are any."""
    chain, most = model.chain, limits.max_effort
    weight = float(chain.mass.sum() * np.linalg.norm(model.gravity))
    if not weight:
        return
    poses = _random_poses(limits)
    yield 'torque to hold the arm, over the ranges'

    def magnitude(joint: int) -> Callable[[Array], Array]:
        return lambda q: np.abs(gravity_torque(model, q)[:, joint])

    torque = [largest(magnitude(joint), limits, poses) for joint in range(3)]
    for name, needed, limit in zip(model.joint_names, torque, most):
        needed = needed if needed > ROUNDING * weight * chain.size else 0.0
        texts = format_distinct(needed, *[limit] * bool(np.isfinite(limit)), digits=4)
        yield f'  {name}: up to {" of ".join(texts)} N m'
    if (torque > most).any():
        beyond = 100.0 * float((np.abs(gravity_torque(model, poses)) > most).any(axis=1).mean())
        share = f'about {beyond:.0f} %' if beyond >= 1.0 else 'less than 1 %'
        yield f'  {share} of the poses cannot be held'
