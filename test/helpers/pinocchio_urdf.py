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

"""A URDF's arm as Pinocchio reads it, all other joints locked."""

from __future__ import annotations

from math import cos, sin

import numpy as np
import pinocchio

GRAVITY = np.array((0.0, 0.0, -9.81))  # in the frame of the root


class PinocchioUrdf:
    """Three joints of a URDF's tree; positions are those in the frame of the base link."""

    def __init__(self, text, names, base, tip, locked=None):
        """Lock what is not among the names, at given positions or at zero."""
        whole, at = pinocchio.buildModelFromXML(text), locked or {}
        others = [i for i, name in enumerate(whole.names) if i and name not in names]
        q = self.configuration(whole, [at.get(name, 0.0) for name in list(whole.names)[1:]])
        self.model = pinocchio.buildReducedModel(whole, others, q)
        self.model.gravity.linear = GRAVITY
        assert list(self.model.names)[1:] == list(names)
        self.data = self.model.createData()
        self.base, self.tip = self.model.getFrameId(base), self.model.getFrameId(tip)
        self.place(np.zeros(3))
        self.from_root = self.data.oMf[self.base].inverse()
        self.gravity = self.from_root.rotation @ GRAVITY  # in the frame of the base

    @staticmethod
    def configuration(model, positions):
        """Return Pinocchio's vector: joints without range have cosine and sine."""
        parts = [(cos(x), sin(x)) if joint.nq == 2 else (x,)
                 for joint, x in zip(list(model.joints)[1:], positions)]
        return np.array([x for part in parts for x in part])

    def place(self, q):
        """Move the arm."""
        pinocchio.framesForwardKinematics(self.model, self.data, self.vector(q))

    def vector(self, q):
        """Return the arm's joint positions as Pinocchio has them."""
        return self.configuration(self.model, q)

    def tip_position(self, q):
        """Return the tip in the frame of the base."""
        self.place(q)
        return self.from_root.act(self.data.oMf[self.tip].translation)

    def inverse_dynamics(self, q, qd, qdd):
        """Return joint torques by the recursive Newton-Euler algorithm."""
        return pinocchio.rnea(self.model, self.data, self.vector(q), qd, qdd).copy()

    def inertia_matrix(self, q):
        """Return the joint-space inertia by the composite rigid body algorithm."""
        upper = np.triu(pinocchio.crba(self.model, self.data, self.vector(q)))
        return upper + np.triu(upper, 1).T
