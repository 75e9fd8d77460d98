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
"""Paths of the tip as an arm follows them in a named posture."""

from __future__ import annotations

from rrr_traj_planner.core.kinematics.inverse import inverse_kinematics
from rrr_traj_planner.core.path.workspace_check import check_workspace


def arm_path_in(model, limits, path, elbow='up', shoulder='front', start=None):
    """Return a path as an arm follows it, checked against workspace and ranges."""
    first = inverse_kinematics(model, path.points[0], elbow, start, shoulder)
    return check_workspace(model, limits, path, first, start)
