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

"""A run's table: errors at the via points, peaks and limits, residual vibration."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.trajectory.quintic_spline import spline_through
from rrr_traj_planner.core.trajectory.sampling import NANOSECOND
from rrr_traj_planner.nodes.runs.figures import deviations, executed_torque, Peaks, peaks
from rrr_traj_planner.nodes.runs.run import Run
from rrr_traj_planner.nodes.runs.via_errors import executed_errors, final_error, planned_errors
from rrr_traj_planner.report.excitation import vibration_text
from rrr_traj_planner_interfaces.srv import PlanTrajectory


def table(run: Run) -> str:
    """
    Return the run's errors, peaks and limits as a table.

    Parameters
    ----------
    run : Run
        The run.

    Returns
    -------
    str
        Several lines.

    """
    torque = Peaks('executed torque', executed_torque(run), run.config.limits.max_effort, 'N m')
    spline = spline_through(run.planned)
    moving = spline.knots <= run.response.via_times[-1] + NANOSECOND
    note = [run.response.message, ''] if run.response.message else ['']
    rows = peak_lines(run.response, run.config.limits, run.config.model.joint_names, [torque])
    return '\n'.join(['', f'{run.task.name}: {run.response.via_times[-1]:.3f} s', '',
                      *_via_lines(run), *note, *rows, '',
                      vibration_text(spline.at, spline.knots[moving])])


def peak_lines(response: PlanTrajectory.Response, limits: JointLimits,
               joint_names: Sequence[str], more: Sequence[Peaks] = ()) -> list[str]:
    """
    Return the lines of a table of a plan's peaks and their limits.

    Parameters
    ----------
    response : PlanTrajectory.Response
        The plan.
    limits : JointLimits
        Those in force.
    joint_names : sequence of str
        The arm's joints.
    more : sequence of Peaks
        Other rows; those without values are left out.

    Returns
    -------
    list of str
        A header, and a line for each quantity.

    """
    lines = [f'{"peaks: planned / limit":<24}' + ''.join(f'{name:>24}' for name in joint_names)]
    for row in (*peaks(response, limits), *more):
        if len(row.peak):
            lines.append(f'{f"{row.name} [{row.unit}]":<24}' + ''.join(
                f'{f"{p:.4g} / {_limit(m)}":>24}' for p, m in zip(row.peak, row.limit)))
    return lines


def _via_lines(run: Run) -> list[str]:
    """Return a line for each via point with its errors, and lines about end and path."""
    joints, (at, dwell) = run.joint_via_points, run.rests
    given, digits, unit = (run.tips, 6, 'm') if joints is None else (joints, 4, 'rad')
    lines = [f'{"via point":<31}{"at [s]":>8}{"rests [s]":>11}{"planned error [rad]":>21}'
             f'{"tip error [mm]":>16}']
    for i, (point, t, planned, executed) in enumerate(zip(
            given, run.response.via_times, planned_errors(run), executed_errors(run))):
        where = '(' + ', '.join(f'{x:.{digits}g}' for x in point) + f') {unit}'
        rest = f'{dwell[i]:g}' if at[i] else ''
        lines.append(f'{i:<3}{where:<28}{t:>8.3f}{rest:>11}{planned:>21.1e}'
                     f'{1e3 * executed:>16.4f}')
    lines.append(f'{"at rest":<71}{1e3 * final_error(run):>16.4f}')
    if run.follows_path:
        planned, executed = deviations(run)
        lines.append(f'distance from the polyline: planned {1e3 * planned:.2f} mm, executed '
                     f'{1e3 * executed:.2f} mm, allowed {1e3 * run.config.max_deviation:g} mm')
    return lines


def _limit(value: float) -> str:
    return 'none' if np.isinf(value) else f'{value:g}'
