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

"""Numbers of the thesis, verified, that the code must reproduce."""

# Appendix B, as printed.
MASS = (40.0, 16.0, 12.0)                                                    # kg
INERTIA = ((1.5, 0.1, 1.5), (0.12, 0.12, 0.01), (0.12, 0.12, 0.01))          # kg m^2
D1, A2, D4, L2, L3 = 0.5, 0.9, 0.7, 0.5, 0.5                                 # m

# Tip positions [m] of tables 6.1 and 6.3, joint positions with the elbow up [deg, 4 decimals]
# and the torque with which joint 2 holds the arm there [N m, 1 decimal].
POINTS = {
    '6.1 point 1': ((1.02, 0.59, 0.97), (30.0464, 54.0815, 14.2147), 162.9),
    '6.1 point 2': ((0.46, 0.55, 1.44), (50.0921, 88.8437, 4.4472), 62.5),
    '6.1 point 3': ((0.45, 0.38, 1.45), (40.1792, 96.9387, -2.3015), 36.4),
    '6.3 point 1': ((0.2, 0.8, 0.5), (75.9638, 47.6459, -29.4763), 142.6),
    '6.3 point 2': ((0.5, 1.0, 1.0), (63.4349, 58.4486, 9.1332), 150.9),
    '6.3 point 3': ((0.8, 1.2, 0.6), (56.3099, 26.1272, 38.8280), 218.9),
}
POINT_THAT_CANNOT_BE_HELD = '6.3 point 3'
HOLDING_TORQUE_THERE_ELBOW_DOWN = 224.6  # N m

# Half of the last printed digit, and a little for rounding.
ANGLE_TOLERANCE = 0.51e-4   # deg
TORQUE_TOLERANCE = 0.051    # N m
