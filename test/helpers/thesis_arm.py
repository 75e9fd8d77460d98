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

"""An arm of the thesis's kind with its lengths, masses and inertias at hand for its equations."""

from __future__ import annotations

from rrr_traj_planner.core.arm.lengths import ArmLengths
from rrr_traj_planner.core.arm.model import GRAVITY, JOINT_NAMES, RobotModel


class ThesisArm(RobotModel):
    """A `RobotModel` from lengths, which are its attributes too; g: gravity along -z."""

    def __init__(self, lengths=None, g=GRAVITY, joint_names=JOINT_NAMES, **values):
        """Make it from lengths, or from some of them, the thesis's else."""
        if 'chain' in values:  # by `dataclasses.replace`: an arm with fields of its own
            super().__init__(joint_names=joint_names, **values)
            return
        lengths = lengths or ArmLengths(**values)
        model = RobotModel.from_lengths(lengths, g, joint_names)
        super().__init__(model.chain, model.gravity, joint_names=joint_names)
        for name in ('d1', 'a2', 'd4', 'l2', 'l3', 'mass', 'inertia'):
            vars(self)[name] = getattr(lengths, name)
        vars(self)['g'] = g

    @property
    def reach(self):
        """Return the least and the largest distance of the tip from the shoulder [m]."""
        return abs(self.a2 - self.d4), self.a2 + self.d4
