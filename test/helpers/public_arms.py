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

"""Public descriptions of arms and random chains: random requests, and Pinocchio's verdict."""

from __future__ import annotations

from dataclasses import replace

from helpers.places import ROOT
from helpers.random_chains import PinocchioChain, random_arm
import numpy as np
from rrr_traj_planner.core.arm.friction import Friction
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arm.urdf_arm import read_urdf
from rrr_traj_planner.core.dynamics.rigid_body import gravity_torque, inertia_matrix
from rrr_traj_planner.core.kinematics.forward import jacobian
from rrr_traj_planner.planners.registry import planner
from rrr_traj_planner.planners.request import PlanningRequest

DESCRIPTIONS = ROOT / 'test' / 'data' / 'arms'
RANDOM_CHAINS = 8
RANGE = 2.5              # rad to either side, where a joint has no range
SINGULAR = 0.03          # of the arm's size: least singular value at via points
HELD = 0.7               # of an effort limit, that gravity may take at via points
PER_PERIOD = 20          # checked states between two points of the answer
LIMIT_TOLERANCE = 1e-6   # relative
ANGLE_TOLERANCE = 1e-9   # rad
PLACE_TOLERANCE = 1e-8   # of the arm's size
PATHS = ('line_arc', 'line_polynomial')


class Arm:
    """An arm with limits for all that is missing, and what Pinocchio makes of it."""

    def __init__(self, name, model, limits):
        self.name, self.model, self.limits = name, model, limits
        self.pinocchio = PinocchioChain(model)

    def torque(self, q, qd, qdd):
        """Return the motors' torque by Newton-Euler, with friction."""
        friction = self.model.friction
        rigid = np.array([self.pinocchio.inverse_dynamics(*state) for state in zip(q, qd, qdd)])
        return rigid + friction.viscous * qd + friction.coulomb * np.sign(qd)

    def tip(self, q):
        """Return the tip's position [m]."""
        return self.pinocchio.tip_motion(q, np.zeros(3))[0]


def described(path):
    """Return the arm of a URDF, with accelerations and jerks of our own."""
    found = read_urdf(path, 'base', 'tip')
    model = RobotModel(found.chain, friction=found.friction, joint_names=found.joint_names)
    low = np.where(np.isfinite(found.min_position), found.min_position, -RANGE)
    high = np.where(np.isfinite(found.max_position), found.max_position, RANGE)
    velocity = np.where(np.isfinite(found.max_velocity), found.max_velocity, 3.0)
    return Arm(path.stem, model, JointLimits(
        low, high, velocity, 5.0 * velocity, 100.0 * velocity, found.max_effort))


def random_chain(seed):
    """Return a random chain under tilted gravity, with friction and limits that hold it."""
    rng = np.random.default_rng(seed)
    friction = Friction(rng.uniform(0.0, 3.0, 3), rng.uniform(0.0, 5.0, 3))
    model = replace(random_arm(seed), friction=friction)
    q = rng.uniform(-np.pi, np.pi, (500, 3))
    effort = 1.6 * (np.abs(gravity_torque(model, q)).max(axis=0) + friction.coulomb) + 2.0 * (
        np.abs(inertia_matrix(model, q)).sum(axis=2).max(axis=0))
    middle, half = rng.uniform(-1.0, 1.0, 3), rng.uniform(1.0, 3.5, 3)
    return Arm(f'chain {seed}', model, JointLimits(
        middle - half, middle + half, rng.uniform(0.5, 3.0, 3), rng.uniform(1.0, 10.0, 3),
        rng.uniform(20.0, 300.0, 3), effort))


def task(arm, planner_id, rng):
    """Return a random request: of poses that the arm can hold, away from singular ones."""
    while True:
        q = [_pose(arm, rng)]
        for _ in range(int(rng.integers(1, 6))):
            q.append(_pose(arm, rng, q[-1] if planner_id in PATHS else None))
        tips = np.array([arm.tip(x) for x in q])
        if np.linalg.norm(np.diff(tips, axis=0), axis=1).min() > 1e-3 * arm.model.chain.size:
            break
    start = q[0] if rng.random() < 0.3 else None
    return PlanningRequest(tips if start is None else tips[1:], start=start,
                           planner_id=planner_id, max_deviation=0.02 * arm.model.chain.size)


def _pose(arm, rng, near=None):
    """Return a random pose, not far from another one if that is given."""
    limits, size = arm.limits, arm.model.chain.size
    reach = 0.4  # rad
    for attempt in range(20_000):
        if near is None:
            q = rng.uniform(limits.min_position, limits.max_position)
        else:
            q = np.clip(near + rng.uniform(-reach, reach, 3), limits.min_position,
                        limits.max_position)
        held = (
            np.abs(gravity_torque(arm.model, q)) + arm.model.friction.coulomb
            <= HELD * limits.max_effort).all()
        least = np.linalg.svd(jacobian(arm.model, q), compute_uv=False)[2]
        if held and least > SINGULAR * size * (0.5 if attempt > 2000 else 1.0):
            return q
    raise LookupError(f'{arm.name}: no pose')


def violations(arm, request, found):
    """Return what a plan breaks, on a dense grid, by Pinocchio."""
    motion, limits = found.trajectory, arm.limits
    steps = np.arange(PER_PERIOD) / PER_PERIOD
    stamps = found.points.times
    t = (stamps[:-1, np.newaxis] + np.diff(stamps)[:, np.newaxis] * steps).ravel()
    q, qd, qdd, jerk = motion(np.append(t, motion.duration))
    broken = [f'{name} {(np.abs(x) / bound).max():.9f} of its limit' for name, x, bound in (
        ('velocity', qd, limits.max_velocity), ('acceleration', qdd, limits.max_acceleration),
        ('jerk', jerk, limits.max_jerk))
        if not (np.abs(x) <= bound * (1.0 + LIMIT_TOLERANCE)).all()]
    if arm.model.has_inertia:
        share = np.abs(arm.torque(q, qd, qdd)) / limits.max_effort
        if share.max() > 1.0 + LIMIT_TOLERANCE:
            broken.append(f'torque {share.max():.9f} of its limit')
    outside = np.maximum(limits.min_position - q, q - limits.max_position).max()
    if outside > ANGLE_TOLERANCE:
        broken.append(f'{outside:.3g} rad outside a range')
    exact = slice(None) if not planner(request.planner_id).misses_via_points else [0, -1]
    if request.start is None or exact == slice(None):
        passed = np.array([arm.tip(x) for x in motion(found.via_times[exact])[0]])
        missed = np.abs(passed - request.via_points[exact]).max()
        if missed > PLACE_TOLERANCE * arm.model.chain.size:
            broken.append(f'via point missed by {missed:.3g} m')
    if request.start is not None and (found.points.positions[0] != request.start).any():
        broken.append('does not begin at the start')
    return broken


def arms(pattern=''):
    """Return the public descriptions but the planar one, and random chains, by part of a name."""
    found = [described(p) for p in sorted(DESCRIPTIONS.glob('*.urdf')) if p.stem != 'planar_arm']
    found += [random_chain(seed) for seed in range(RANDOM_CHAINS)]
    return [arm for arm in found if pattern in arm.name]
