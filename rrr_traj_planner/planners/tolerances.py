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

"""
Tolerances and margins that several planners share, without unit.

Chosen; what exceeds a limit by LIMIT_ROUNDING or TORQUE_TOLERANCE passes the final check, 1e-6.
"""

LIMIT_ROUNDING = 1e-7      # part of a limit up to which exceeding it is rounding
TORQUE_TOLERANCE = 5e-7    # part by which a motion may be faster than its torques allow
DURATION_TOLERANCE = 1e-7  # part by which a motion may last longer than prescribed
DURATION_MARGIN = 1e-6     # part added to least durations, so that these can be prescribed again
HOLDING_MARGIN = 1e-6      # part of the effort limits that gravity must leave along a path
START_SCALING = 1.02       # durations of a start / least ones: it is strictly within its limits
