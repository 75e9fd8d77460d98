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

"""The arm as a Pinocchio model, built from table 5.1: a reference for kinematics and dynamics."""

from __future__ import annotations

import numpy as np
import pinocchio

# Rx(90 deg), from the Denavit-Hartenberg angles alpha of joints 1 and 3.
RX_90 = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
AXES_KEPT = np.eye(3)


class PinocchioArm:
    """A `ThesisArm` converted to a Pinocchio model."""

    def __init__(self, arm, payload=0.0):
        """
        Place joints, frames and centres of mass as A_i = Rz(theta) Tz(d) Tx(a) Rx(alpha).

        A payload is a body of its own: a point mass [kg] at the last frame's origin, the tip.
        """
        model = pinocchio.Model()
        model.gravity.linear = arm.gravity
        # Placements of frame i, and of the centre of mass of link i, relative to joint i: both in
        # the axes of frame i.
        frames = [_placement(RX_90, (0.0, 0.0, arm.d1)), _placement(AXES_KEPT, (arm.a2, 0.0, 0.0)),
                  _placement(RX_90, RX_90 @ (0.0, 0.0, arm.d4))]
        centres = [frames[0], _placement(AXES_KEPT, (arm.l2, 0.0, 0.0)),
                   _placement(RX_90, RX_90 @ (0.0, 0.0, arm.l3))]
        joint_placements = [pinocchio.SE3.Identity(), frames[0], frames[1]]
        joint = 0
        self.frame_ids, self.centre_ids = [], []
        for i in range(3):
            joint = model.addJoint(joint, pinocchio.JointModelRZ(), joint_placements[i], f'j{i}')
            inertia = pinocchio.Inertia(arm.mass[i], np.zeros(3), np.diag(arm.inertia[i]))
            model.appendBodyToJoint(joint, centres[i].act(inertia), pinocchio.SE3.Identity())
            for ids, placement, name in ((self.frame_ids, frames[i], 'frame'),
                                         (self.centre_ids, centres[i], 'centre')):
                ids.append(model.addFrame(pinocchio.Frame(
                    f'{name}{i}', joint, placement, pinocchio.FrameType.OP_FRAME)))
        model.appendBodyToJoint(
            joint, pinocchio.Inertia(payload, np.zeros(3), np.zeros((3, 3))), frames[2])
        self.model, self.data = model, model.createData()

    def inverse_dynamics(self, q, qd, qdd):
        """Return joint torques by the recursive Newton-Euler algorithm."""
        return pinocchio.rnea(self.model, self.data, q, qd, qdd).copy()

    def inertia_matrix(self, q):
        """Return the joint-space inertia by the composite rigid body algorithm."""
        upper = np.triu(pinocchio.crba(self.model, self.data, q))
        return upper + np.triu(upper, 1).T

    def coriolis_torque(self, q, qd):
        """Return the velocity-dependent torques."""
        return pinocchio.computeCoriolisMatrix(self.model, self.data, q, qd) @ qd

    def gravity_torque(self, q):
        """Return the torques that hold the arm still."""
        return pinocchio.computeGeneralizedGravity(self.model, self.data, q).copy()

    def forward_dynamics(self, q, qd, tau):
        """Return accelerations by the articulated body algorithm."""
        return pinocchio.aba(self.model, self.data, q, qd, tau).copy()

    def kinetic_energy(self, q, qd):
        """Return the kinetic energy."""
        return pinocchio.computeKineticEnergy(self.model, self.data, q, qd)

    def potential_energy(self, q):
        """Return the potential energy, zero at the base's height."""
        return pinocchio.computePotentialEnergy(self.model, self.data, q)

    def move(self, q, qd, qdd):
        """Set the arm's state for the functions below."""
        pinocchio.computeJointJacobiansTimeVariation(self.model, self.data, q, qd)
        pinocchio.forwardKinematics(self.model, self.data, q, qd, qdd)
        pinocchio.updateFramePlacements(self.model, self.data)

    def rotation(self, frame_id):
        """Return a frame's rotation in the base frame."""
        return self.data.oMf[frame_id].rotation.copy()

    def point_motion(self, frame_id):
        """Return a frame origin's position, velocity and acceleration in the base frame."""
        frame = (self.model, self.data, frame_id, pinocchio.LOCAL_WORLD_ALIGNED)
        return (self.data.oMf[frame_id].translation.copy(),
                pinocchio.getFrameVelocity(*frame).linear.copy(),
                pinocchio.getFrameClassicalAcceleration(*frame).linear.copy())

    def angular_motion(self, frame_id):
        """Return angular velocity and acceleration in the frame's own axes."""
        frame = (self.model, self.data, frame_id, pinocchio.LOCAL)
        return (pinocchio.getFrameVelocity(*frame).angular.copy(),
                pinocchio.getFrameAcceleration(*frame).angular.copy())

    def tip_jacobian(self):
        """Return d(tip) / d(q) in the base frame."""
        return pinocchio.getFrameJacobian(
            self.model, self.data, self.frame_ids[2], pinocchio.LOCAL_WORLD_ALIGNED)[:3].copy()

    def tip_jacobian_rate(self):
        """Return the time derivative of the tip's Jacobian."""
        return pinocchio.getFrameJacobianTimeVariation(
            self.model, self.data, self.frame_ids[2], pinocchio.LOCAL_WORLD_ALIGNED)[:3].copy()


def _placement(rotation, translation):
    return pinocchio.SE3(rotation, np.array(translation, dtype=float))
