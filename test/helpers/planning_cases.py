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

"""The thesis's arm, limits, and requests for its tables or through given joint positions."""

from dataclasses import replace

from helpers.thesis_arm import ThesisArm
from helpers.thesis_cases import POINTS
import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.kinematics.postures import posture_of
from rrr_traj_planner.planners.request import PlanningRequest

NONE = np.full(3, np.inf)  # no limits
ARM, LIMITS = ThesisArm(), JointLimits()
STRONG = replace(LIMITS, max_effort=[150.0, 250.0, 200.0])  # joint 2 as table 6.3 needs it
FREE = replace(LIMITS, max_effort=NONE)


def table(name, **request):
    """Return a request for the points of a table of the thesis."""
    return PlanningRequest([POINTS[f'{name} point {k}'][0] for k in (1, 2, 3)], **request)


def through(q, **request):
    """Return a request for the tip positions at joint positions, in the posture of the first."""
    q = np.asarray(q, dtype=float)
    elbow, shoulder = posture_of(ARM, q[0])
    return PlanningRequest(
        forward_kinematics(ARM, q), **{'elbow': elbow, 'shoulder': shoulder, **request})
