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
`time_optimal` from motion to positions at the ends of joints' ranges, or just inside of them.

Times are compared with those of Ruckig 0.19.4. It knows no ranges, but its motions stay within
them.
"""

from helpers.planning_cases import ARM, FREE
import numpy as np
import pytest
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.request import PlanningRequest

INSIDE = (0.0, 1e-6, 1e-4, 1e-3, 1e-2)  # rad
RISES = 1.03  # factor on times, for jerk rises and falls continuously
END = FREE.max_position[0]
# start, velocity, acceleration; goal; the joint that is at an end of its range; Ruckig's time [s],
# however far inside the goal is
GOALS = [
    ([[1.45385, 3.08665, -1.68148], [-0.07365, 0.3298, 0.99994], [-0.55143, -0.99713, 0.00012]],
     [END, 3.14159, -1.70772], 0, 2.6214),
    ([[0.1782, 2.28451, -0.71988], [-0.59621, -0.47343, 0.91154], [0.99982, -0.23558, 0.90568]],
     [0.0, 2.21598, -0.86764], 0, 2.8596),
    ([[1.54028, 2.26674, -2.44854], [0.23898, -0.66057, 0.56964], [-0.99933, 0.26886, 0.65146]],
     [END, 1.93585, -2.43386], 0, 1.7151),
    ([[0.84993, 2.82847, 1.28088], [-0.48212, 0.70217, -0.99999], [0.05044, -0.56557, 0.0]],
     [0.7031, FREE.max_position[1], 1.12857], 1, 2.3652)]
# likewise, with a via point and a goal; Ruckig's times to the via point, at rest, and from there
VIAS = [
    ([[1.50462, 0.07532, -0.31152], [0.24138, -0.0865, 0.18764], [-0.6425, 0.99407, 0.99849]],
     [[END, 0.00261, -0.14273], [END, 0.0, -0.0373]], 0, 0.733 + 0.757),
    ([[0.08152, 0.30289, -0.66017], [0.06565, 0.28093, -0.09889], [0.3399, 0.99899, -0.43815]],
     [[0.0, 0.0, -0.66699], [0.19538, 0.0, -0.65318]], 1, 1.808 + 0.99),
    ([[1.30137, 0.64049, -0.94353], [0.1293, -0.26979, 0.99976], [-0.77028, 0.52935, 0.0]],
     [[END, 0.7351, -0.72998], [END, 0.80446, -0.47672]], 0, 2.264 + 1.111),
    ([[0.9372, 0.25807, -2.96608], [-0.00059, 0.00098, -0.0144], [0.02153, -0.03576, 0.53342]],
     [[0.72286, 0.0, -2.97972], [0.83956, 0.0, -3.05456]], 1, 1.118 + 0.791)]


def durations(state, points, joint):
    """Return durations [s] where the first point is as far INSIDE the joint's range."""
    middle = 0.5 * (FREE.min_position[joint] + FREE.max_position[joint])
    for distance in INSIDE:
        moved = np.array(points)
        moved[0, joint] += np.copysign(distance, middle - moved[0, joint])
        start, velocity, acceleration = state
        yield plan(ARM, FREE, PlanningRequest(
            planner_id='time_optimal', joint_via_points=moved, start=start,
            start_velocity=velocity, start_acceleration=acceleration)).trajectory.duration


@pytest.mark.parametrize('state, goal, joint, ruckig', GOALS)
def test_goals_there_are_reached_in_the_least_time(state, goal, joint, ruckig):
    assert max(durations(state, [goal], joint)) <= RISES * ruckig


@pytest.mark.parametrize('state, points, joint, ruckig', VIAS)
def test_passing_a_via_point_there_takes_no_longer_than_a_stop_at_it(
        state, points, joint, ruckig):
    assert max(durations(state, points, joint)) <= RISES * ruckig
