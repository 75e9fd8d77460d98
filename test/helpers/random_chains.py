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

"""Random chains of three revolute joints, of every kind, and the same ones in Pinocchio."""

from __future__ import annotations

import numpy as np
import pinocchio
from rrr_traj_planner.core.arm.chain import Chain
from rrr_traj_planner.core.arm.model import RobotModel


def random_inertia(rng, mass):
    """Return the inertia tensor of three pairs of point masses, as any body may have."""
    points = rng.uniform(-0.2, 0.2, (3, 3))
    return mass / 3.0 * sum(p @ p * np.eye(3) - np.outer(p, p) for p in points)


def random_chain(rng):
    """Return a chain with skew axes, offsets up to a link's length, centres of mass anywhere."""
    axis = rng.normal(size=(3, 3))
    point = np.cumsum(rng.uniform(-0.6, 0.6, (3, 3)), axis=0)
    mass = rng.uniform(0.5, 20.0, 3)
    return Chain(axis, point, point[2] + rng.uniform(-0.6, 0.6, 3), mass,
                 point + rng.uniform(-0.3, 0.3, (3, 3)),
                 np.array([random_inertia(rng, m) for m in mass]))


def random_arm(seed):
    """Return a random chain under gravity of any direction, with rotor inertia."""
    rng = np.random.default_rng(seed)
    return RobotModel(random_chain(rng), rng.uniform(-10.0, 10.0, 3), rng.uniform(0.0, 0.5, 3))


def with_axes(arm, distance=None, parallel=False):
    """Return an arm's like, joint axes 1 and 2 at a distance [m], or 2 and 3 parallel."""
    chain, axis, tip = arm.chain, arm.chain.axis.copy(), arm.chain.tip
    if parallel:
        axis[2] = axis[1]
    n = np.cross(axis[0], axis[1])
    n /= np.linalg.norm(n)
    away = 0.0 if distance is None else (chain.point[1] - chain.point[0]) @ n - distance
    point = chain.point - np.outer((0.0, 1.0, 1.0), away * n)
    return RobotModel(Chain(axis, point, tip - away * n, chain.mass, chain.centre, chain.inertia),
                      arm.gravity, arm.rotor_inertia)


class PinocchioChain:
    """A chain as a Pinocchio model; joint frames have the base frame's axes at zero."""

    def __init__(self, arm, payload=0.0):
        """Place joints at their points and bodies where they are, a payload [kg] at the tip."""
        chain, model, joint, at = arm.chain, pinocchio.Model(), 0, np.zeros(3)
        model.gravity.linear = arm.gravity
        for i in range(3):
            joint = model.addJoint(joint, pinocchio.JointModelRevoluteUnaligned(chain.axis[i]),
                                   pinocchio.SE3(np.eye(3), chain.point[i] - at), f'joint_{i + 1}')
            at = chain.point[i]
            model.appendBodyToJoint(joint, pinocchio.Inertia(
                chain.mass[i], chain.centre[i] - at, chain.inertia[i]), pinocchio.SE3.Identity())
        self.tip = model.addFrame(pinocchio.Frame(
            'tip', joint, pinocchio.SE3(np.eye(3), chain.tip - at), pinocchio.FrameType.OP_FRAME))
        model.appendBodyToJoint(joint, pinocchio.Inertia(
            payload, chain.tip - at, np.zeros((3, 3))), pinocchio.SE3.Identity())
        model.armature = arm.rotor_inertia
        self.model, self.data = model, model.createData()

    def inverse_dynamics(self, q, qd, qdd):
        """Return joint torques by the recursive Newton-Euler algorithm."""
        return pinocchio.rnea(self.model, self.data, q, qd, qdd).copy()

    def forward_dynamics(self, q, qd, tau):
        """Return accelerations by the articulated body algorithm."""
        return pinocchio.aba(self.model, self.data, q, qd, tau).copy()

    def inertia_matrix(self, q):
        """Return the joint-space inertia by the composite rigid body algorithm."""
        upper = np.triu(pinocchio.crba(self.model, self.data, q))
        return upper + np.triu(upper, 1).T

    def tip_motion(self, q, qd):
        """Return the tip's position, its Jacobian and the Jacobian's time derivative."""
        pinocchio.computeJointJacobiansTimeVariation(self.model, self.data, q, qd)
        pinocchio.updateFramePlacements(self.model, self.data)
        frame = (self.model, self.data, self.tip, pinocchio.LOCAL_WORLD_ALIGNED)
        return (self.data.oMf[self.tip].translation.copy(),
                pinocchio.getFrameJacobian(*frame)[:3].copy(),
                pinocchio.getFrameJacobianTimeVariation(*frame)[:3].copy())
