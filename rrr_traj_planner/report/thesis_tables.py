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

"""The thesis's tables of data (6.1 to 6.3, B.1 to B.3), from the package's own values."""

from __future__ import annotations

import numpy as np
from rrr_traj_planner.core.arm.lengths import ArmLengths
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.planners.tasks import T_ACC
from rrr_traj_planner.report.tables import Table
from rrr_traj_planner.report.thesis_tasks import table_6_1, table_6_3


def data_tables() -> list[Table]:
    """Return tables 6.1 to 6.3 and B.1 to B.3."""
    return [_points('table_6_1', 'Table 6.1: the values of the via points',
                    'The motion starts and ends at rest.', table_6_1().via_points),
            _table_6_2(),
            _points('table_6_3', 'Table 6.3: the values of the visiting points', '',
                    table_6_3().via_points),
            *_appendix_b()]


def _points(name: str, title: str, caption: str, points: Array) -> Table:
    return Table(name, title, caption, ('point #', 'Px [m]', 'Py [m]', 'Pz [m]'),
                 [[str(i + 1), *(f'{x:g}' for x in p)] for i, p in enumerate(points)])


def _table_6_2() -> Table:
    limits = table_6_1().limits
    row = [f'{x:g}' for x in (T_ACC, limits.max_velocity[0], limits.max_acceleration[0])]
    return Table('table_6_2', 'Table 6.2: practical values for t_acc, ω_max and α_max',
                 'For every joint.', ('t_acc [s]', 'ω_max [rad/s]', 'α_max [rad/s²]'),
                 [row])


def _appendix_b() -> list[Table]:
    task = table_6_1()
    arm, limits = ArmLengths(), task.limits
    lengths = [['1', '-', '-', f'{arm.d1:g}'], ['2', f'{arm.l2:g}', f'{arm.a2:g}', '-'],
               ['3', f'{arm.l3:g}', '-', f'{arm.d4:g}']]
    masses = [[str(i + 1), f'{m:g}', *(f'{x:g}' for x in inertia)]
              for i, (m, inertia) in enumerate(zip(arm.mass, arm.inertia))]
    ranges = [[str(i + 1), f'{low:g} … {high:g}', f'±{v:g}', f'±{a:g}', f'±{tau:g}']
              for i, (low, high, v, a, tau) in enumerate(zip(
                  np.degrees(limits.min_position), np.degrees(limits.max_position),
                  limits.max_velocity, limits.max_acceleration, limits.max_effort))]
    return [
        Table('table_b_1', 'Table B.1: lengths characteristics of the simulated robot',
              'Link 3: d is the length of the forearm along z3, d4 in the equations.',
              ('link', 'l [m]', 'a [m]', 'd [m]'), lengths),
        Table('table_b_2', 'Table B.2: masses and inertia of the simulated robot',
              "About the centre of mass, in the axes of the link's frame.",
              ('link', 'm [kg]', 'Ix [kg m²]', 'Iy [kg m²]', 'Iz [kg m²]'), masses),
        Table('table_b_3', 'Table B.3: joint limits of the simulated robot',
              "Joint 2's range is the printed one, 180° to 360°, mirrored.",
              ('joint', 'position [deg]', 'velocity [rad/s]', 'acceleration [rad/s²]',
               'torque [N m]'), ranges)]
