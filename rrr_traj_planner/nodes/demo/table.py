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

"""The demo's figures (errors and peaks), their bounds, and the table that shows them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.errors import format_distinct
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.path.deviation import distance_from_polyline
from rrr_traj_planner.core.simulation.saturation_and_contact import SATURATED
from rrr_traj_planner.core.trajectory.limit_check import TOLERANCE
from rrr_traj_planner.core.trajectory.quintic_spline import spline_through
from rrr_traj_planner.core.trajectory.sampling import NANOSECOND
from rrr_traj_planner.nodes.demo.client import Run
from rrr_traj_planner.nodes.demo.via_errors import executed_errors, final_error, planned_errors
from rrr_traj_planner.planners.registration import Registered
from rrr_traj_planner.planners.registry import planner
from rrr_traj_planner.report.excitation import vibration_text

PLANNED_BOUND = 1e-9   # rad, error of the plan at via points: rounding
EXECUTED_BOUND = 2e-3  # m, error of the arm's tip at via points: tracking
FINAL_BOUND = 1e-3     # m, error of the arm's tip at rest


class CheckedValue(NamedTuple):
    """A value and its upper bound."""

    name: str
    value: float
    bound: float
    unit: str

    @property
    def within_bound(self) -> bool:
        """Return whether the value is at most the bound."""
        return bool(self.value <= self.bound)

    @property
    def text(self) -> str:
        """Return name, value, bound and unit in a line."""
        value, bound = format_distinct(self.value, self.bound)
        return f'{self.name} is {value} {self.unit}, bound {bound} {self.unit}'


def checked_values(run: Run) -> list[CheckedValue]:
    """
    Return all values of a run that have a bound.

    Parameters
    ----------
    run : Run
        The run.

    Returns
    -------
    list of CheckedValue
        Values with their bounds.

    """
    found = []
    missed = _planner(run).misses_via_points
    for i, (planned, executed) in enumerate(zip(planned_errors(run), executed_errors(run))):
        if missed and not run.rests.at[i]:  # by construction
            continue
        found += [CheckedValue(f'via point {i}: planned error', planned, PLANNED_BOUND, 'rad'),
                  CheckedValue(f'via point {i}: tip error', executed, EXECUTED_BOUND, 'm')]
    found.append(CheckedValue('final error', final_error(run), FINAL_BOUND, 'm'))
    if _follows_path(run):
        bound = run.config.max_deviation
        planned, executed = _deviations(run)
        found += [CheckedValue('planned distance from the polyline', planned, bound, 'm'),
                  CheckedValue('distance from the polyline', executed, bound + EXECUTED_BOUND,
                               'm')]
    for name, peak, limit, unit in _peaks(run):
        for joint, p, m in zip(run.config.model.joint_names, peak, limit):
            found.append(
                CheckedValue(f'{joint}: planned {name}', p, m * (1.0 + TOLERANCE), unit))
    for joint, p, m in zip(run.config.model.joint_names, _executed_torque(run),
                           _torque_bounds(run)):
        found.append(CheckedValue(f'{joint}: executed torque', p, m, 'N m'))
    return found


def table(run: Run, found: list[CheckedValue]) -> str:
    """
    Return the run's errors, peaks and limits as a table.

    Parameters
    ----------
    run : Run
        The run.
    found : list of CheckedValue
        From `checked_values`.

    Returns
    -------
    str
        Several lines.

    """
    joints, (at, dwell) = run.joint_via_points, run.rests
    given, digits, unit = (run.tips, 6, 'm') if joints is None else (joints, 4, 'rad')
    lines = ['', f'{run.task.name}: {run.response.via_times[-1]:.3f} s', '',
             f'{"via point":<31}{"at [s]":>8}{"rests [s]":>11}{"planned error [rad]":>21}'
             f'{"tip error [mm]":>16}']
    for i, (point, t, planned, executed) in enumerate(zip(
            given, run.response.via_times, planned_errors(run), executed_errors(run))):
        where = '(' + ', '.join(f'{x:.{digits}g}' for x in point) + f') {unit}'
        rest = f'{dwell[i]:g}' if at[i] else ''
        lines.append(f'{i:<3}{where:<28}{t:>8.3f}{rest:>11}{planned:>21.1e}'
                     f'{1e3 * executed:>16.4f}')
    lines += [f'{"at rest":<71}{1e3 * final_error(run):>16.4f}']
    if _follows_path(run):
        planned, executed = _deviations(run)
        lines.append(f'distance from the polyline: planned {1e3 * planned:.2f} mm, executed '
                     f'{1e3 * executed:.2f} mm, allowed {1e3 * run.config.max_deviation:g} mm')
    lines += [run.response.message, ''] if run.response.message else ['']
    lines.append(f'{"peaks: planned / limit":<24}' + ''.join(
        f'{joint:>24}' for joint in run.config.model.joint_names))
    rows = [*_peaks(run), ('executed torque', _executed_torque(run),
                           run.config.limits.max_effort, 'N m')]
    for name, peak, limit, unit in rows:
        label = f'{name} [{unit}]'
        lines.append(f'{label:<24}' + ''.join(
            f'{f"{p:.4g} / {_limit(m)}":>24}' for p, m in zip(peak, limit)))
    spline = spline_through(run.planned)
    moving = spline.knots <= run.response.via_times[-1] + NANOSECOND
    lines += ['', vibration_text(spline.at, spline.knots[moving])]
    within = sum(f.within_bound for f in found)
    lines += ['', f'{within} of {len(found)} figures are inside their bounds']
    return '\n'.join(lines)


def _follows_path(run: Run) -> bool:
    """
    Return whether the planner is Cartesian: whether it plans the tip's path.

    Parameters
    ----------
    run : Run
        The run.

    Returns
    -------
    bool
        False for planners in joint space.

    """
    return _planner(run).plan_path is not None


def _planner(run: Run) -> Registered:
    return planner(run.task.planner_id or run.config.default_planner_id)


def _deviations(run: Run) -> tuple[float, float]:
    """
    Return the tip's largest distances from the polyline through the via points.

    Parameters
    ----------
    run : Run
        The run.

    Returns
    -------
    tuple of float
        Of the planned and of the executed motion [m].

    """
    moving = run.recorded.times >= 0.0
    tips = (forward_kinematics(run.config.model, q) for q in (
        run.planned.positions, run.recorded.positions[moving]))
    planned, executed = (float(distance_from_polyline(
        run.tips, tip).max()) for tip in tips)
    return planned, executed


def _executed_torque(run: Run) -> Array:
    """
    Return the largest recorded torque of each motor [N m].

    Parameters
    ----------
    run : Run
        The run.

    Returns
    -------
    ndarray, shape (3,)
        Magnitudes.

    """
    return np.asarray(np.abs(run.torque).max(axis=0))


def _torque_bounds(run: Run) -> Array:
    """
    Return the bounds of the motors' executed torques [N m].

    A torque at the limit means that the motor is saturated and may not follow. A motor whose plan
    leaves what the controller needs to follow it, 1 - 1 / `SATURATED` of the limit, must not be:
    its bound is the next number below the limit. Of a plan that takes more, up to the whole limit
    (and the 1e-6 of it by which plans may exceed limits), the controller's correction saturates
    the motor: torques are constant over a physics step, and the motion between two points is
    interpolated. Whether the arm follows all the same, the tip's errors say.

    Parameters
    ----------
    run : Run
        The run.

    Returns
    -------
    ndarray, shape (3,)
        Bounds.

    """
    limit = run.config.limits.max_effort
    takes_all = np.array(run.response.peak_effort) * SATURATED >= limit
    return np.where(takes_all, limit * (1.0 + TOLERANCE), np.nextafter(limit, 0.0))


def _peaks(run: Run) -> list[tuple[str, Array, Array, str]]:
    limits, r = run.config.limits, run.response
    return [('velocity', np.array(r.peak_velocity), limits.max_velocity, 'rad/s'),
            ('acceleration', np.array(r.peak_acceleration), limits.max_acceleration, 'rad/s^2'),
            ('jerk', np.array(r.peak_jerk), limits.max_jerk, 'rad/s^3'),
            ('torque', np.array(r.peak_effort), limits.max_effort, 'N m')]


def _limit(value: float) -> str:
    return 'none' if np.isinf(value) else f'{value:g}'
