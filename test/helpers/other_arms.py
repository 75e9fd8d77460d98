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

"""Arms unlike the thesis's: an industrial arm with a radial offset, a leg, a finger."""

import numpy as np
from rrr_traj_planner.core.arm.chain import Chain
from rrr_traj_planner.core.arm.friction import Friction
from rrr_traj_planner.core.arm.model import RobotModel


def kr16():
    """Return the first three joints of an arm with a KUKA KR 16's lengths: 260 mm off axis 1."""
    point = np.array([(0.0, 0.0, 0.0), (0.26, 0.0, 0.675), (0.94, 0.0, 0.675)])
    return RobotModel(
        Chain([(0.0, 0.0, -1.0), (0.0, 1.0, 0.0), (0.0, 1.0, 0.0)], point, (1.61, 0.0, 0.64),
              [80.0, 40.0, 30.0], point + np.array([(0.1, 0.0, 0.3), (0.3, 0.05, 0.0),
                                                    (0.2, -0.02, 0.05)]),
              [np.diag((3.0, 3.0, 2.0)), np.diag((0.4, 2.0, 2.0)), np.diag((0.3, 1.0, 1.0))]),
        rotor_inertia=[20.0, 20.0, 10.0], friction=Friction([9.0, 8.0, 7.0], [3.0, 2.0, 1.0]))


def leg():
    """Return a quadruped's leg: the hip's axis points forward, beside the body's origin."""
    point = np.array([(0.18, 0.05, 0.0), (0.18, 0.13, 0.0), (0.18, 0.13, -0.21)])
    return RobotModel(
        Chain([(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 1.0, 0.0)], point, (0.18, 0.13, -0.42),
              [0.7, 1.0, 0.2], point + np.array([(0.0, 0.02, 0.0), (0.0, 0.0, -0.05),
                                                 (0.0, 0.0, -0.1)]),
              [1e-3 * np.eye(3), np.diag((6e-3, 6e-3, 1e-3)), np.diag((3e-3, 3e-3, 1e-4))]),
        joint_names=('hip', 'thigh', 'calf'))


def finger():
    """Return a finger whose first two axes meet; it points along x from the base's origin."""
    point = np.array([(0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.05, 0.0, 0.0)])
    return RobotModel(
        Chain([(0.0, 0.0, 1.0), (0.0, 1.0, 0.0), (0.0, 1.0, 0.0)], point, (0.09, 0.0, 0.0),
              [0.01, 0.03, 0.02], point + (0.02, 0.0, 0.0), np.tile(1e-5 * np.eye(3), (3, 1, 1))),
        gravity=(0.0, 9.81, 0.0))


OTHER_ARMS = {'kr16': kr16(), 'leg': leg(), 'finger': finger()}
