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

"""Tables with headings: HTML inside the page, CSV beside it."""

from __future__ import annotations

from collections.abc import Sequence
import csv
from dataclasses import dataclass
from html import escape
from math import isinf
from pathlib import Path

from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.report.attempts import Attempt, Planned, Task
from rrr_traj_planner.report.measures import measures

ROUNDING = 1e-9  # smaller numbers are shown as 0


@dataclass(frozen=True, eq=False)
class Table:
    """
    A table.

    Parameters
    ----------
    name : str
        Name of its file and id in the page.
    title, caption : str
        Title and caption.
    heads : sequence of str
        Headings of the columns.
    rows : sequence of sequence of str
        Cells.
    sentences : bool
        Whether cells are sentences, in which lines may be broken at any space.

    """

    name: str
    title: str
    caption: str
    heads: Sequence[str]
    rows: Sequence[Sequence[str]]
    sentences: bool = False

    @property
    def files(self) -> tuple[str, ...]:
        """Return the names of its files beside the page."""
        return (f'{self.name}.csv',)

    def written(self, folder: Path) -> str:
        """
        Write the table.

        Parameters
        ----------
        folder : Path
            Folder of the CSV file.

        Returns
        -------
        str
            The table as HTML.

        """
        with (folder / f'{self.name}.csv').open('w', newline='', encoding='utf-8') as stream:
            rows = csv.writer(stream)
            rows.writerow(self.heads)
            rows.writerows(self.rows)
        text = escape if self.sentences else _unbroken
        heads = ''.join(f'<th scope="col">{text(h)}</th>' for h in self.heads)
        body = ''.join(
            f'<tr><th scope="row">{text(row[0])}</th>'
            + ''.join(f'<td>{text(cell)}</td>' for cell in row[1:]) + '</tr>\n'
            for row in self.rows)
        kind = ' class="sentences"' if self.sentences else ''
        return ('<div class="scroll" tabindex="0" role="region" '
                f'aria-label="{escape(self.title)}"><table{kind}><thead><tr>{heads}</tr></thead>\n'
                f'<tbody>{body}</tbody></table></div>')


def methods_table(found: Sequence[Attempt], name: str, title: str, caption: str) -> Table:
    """
    Return the table that compares planners.

    Parameters
    ----------
    found : sequence of Attempt
        Their results for one task.
    name, title, caption : str
        See `Table`.

    Returns
    -------
    Table
        A row for each plan; peaks are the largest of the three joints'.

    """
    heads = ('planner', 'total time [s]', 'velocity [rad/s]', 'acceleration [rad/s²]',
             'jerk [rad/s³]', 'torque [N m]', "jerk at transitions' ends [rad/s³]",
             'via point missed by [mm]', 'coefficients', 'in a transition', 'planned in [ms]')
    return Table(name, title, caption, heads, [
        _method(Planned(a.task, a.planner_id, a.plan), a.planning_time)
        for a in found if a.plan is not None])


def refusals_table(found: Sequence[Attempt], name: str) -> Table:
    """
    Return the table of refusals.

    Parameters
    ----------
    found : sequence of Attempt
        Results of planners for one task.
    name : str
        See `Table`.

    Returns
    -------
    Table
        A row for each planner that refused, with the reason.

    """
    return Table(name, 'Refusals', '', ('planner', 'reason'), [
        [a.planner_id, f'refused: {a.refusal}'] for a in found if a.plan is None], sentences=True)


def via_points_table(task: Task, plans: Sequence[Planned], name: str) -> Table:
    """
    Return the table of via points and their times.

    Parameters
    ----------
    task : Task
        The task.
    plans : sequence of Planned
        Its plans.
    name : str
        See `Table`.

    Returns
    -------
    Table
        A row for each via point, numbered from 0; a column of times for each plan.

    """
    columns = [(f'{axis} [m]', [f'{x:.6g}' for x in values])
               for axis, values in zip('xyz', task.via_points.T)]
    request = task.request
    if request.joint_via_points is not None:
        columns += [(f'{joint} [rad]', [f'{x:.6g}' for x in values]) for joint, values in zip(
            task.model.joint_names, request.joint_via_points.T)]
    at, dwell = request.rests
    if request.stop_at is not None or dwell.any():
        columns.append(('rests for [s]', [
            f'{x:.6g}' if rests else '' for rests, x in zip(at, dwell)]))
    columns += [(f'{p.planner_id} [s]', [f'{t:.3f}' for t in p.plan.via_times]) for p in plans]
    heads, cells = zip(*columns)
    caption = 'Positions, and the times at which each planner reaches them.' if plans else ''
    return Table(name, 'Via points', caption, ('#', *heads), [
        [str(i), *row] for i, row in enumerate(zip(*cells))])


def _method(of: Planned, planning_time: float) -> list[str]:
    m = measures(of)
    return [of.planner_id, f'{m.total_time:.3f}', *(
        f'{float(peak.max()):.3f}' for peak in (m.velocity, m.acceleration, m.jerk)),
        f'{float(m.torque.max()):.1f}', shown(float(m.jerk_at_ends.max()), 3),
        shown(1e3 * m.via_distance, 1), str(m.coefficients.total),
        str(m.coefficients.per_transition), f'{1e3 * planning_time:.0f}']


def peaks_table(of: Planned, name: str) -> Table:
    """
    Return the table of each joint's peaks and limits.

    Parameters
    ----------
    of : Planned
        The motion.
    name : str
        See `Table`.

    Returns
    -------
    Table
        Peaks over the continuous motion.

    """
    m, limits, peaks = measures(of), of.task.limits, of.plan.peaks
    rows = [['range of positions [rad]', *(
        f'{low:.3f} … {high:.3f} (allowed {least:.3f} … {most:.3f})' for low, high, least, most
        in zip(peaks.min_position, peaks.max_position, limits.min_position,
               limits.max_position))]]
    rows += [[label, *(_against(p, bound) for p, bound in zip(peak, limit))]
             for label, peak, limit in _limited(m.velocity, m.acceleration, m.jerk, m.torque,
                                                limits)]
    rows.append(["jerk at transitions' ends [rad/s³]", *(shown(j, 3) for j in m.jerk_at_ends)])
    return Table(name, f'Peaks of {of.planner_id}',
                 f'Over the continuous motion of {m.total_time:.3f} s, with the used part of each '
                 f'limit. Via points are met to {m.via_error:.1e} rad, '
                 f'{1e3 * m.via_distance:.2g} mm.',
                 ('peak', *of.task.model.joint_names), rows)


def shown(value: float, digits: int) -> str:
    """
    Return a number as text.

    Parameters
    ----------
    value : float
        The number.
    digits : int
        Number of decimals.

    Returns
    -------
    str
        '0' for magnitudes below `ROUNDING`.

    """
    return '0' if abs(value) < ROUNDING else f'{value:.{digits}f}'


def _unbroken(text: str) -> str:
    """Return a text as HTML, without line breaks before units."""
    return escape(text).replace(' %', '&nbsp;%').replace('N m', 'N&nbsp;m')


def _limited(velocity: Array, acceleration: Array, jerk: Array, torque: Array,
             limits: JointLimits) -> list[tuple[str, Array, Array]]:
    return [('velocity [rad/s]', velocity, limits.max_velocity),
            ('acceleration [rad/s²]', acceleration, limits.max_acceleration),
            ('jerk [rad/s³]', jerk, limits.max_jerk),
            ('torque [N m]', torque, limits.max_effort)]


def _against(peak: float, bound: float) -> str:
    if isinf(bound):
        return f'{peak:.4g} (no limit)'
    return f'{peak:.4g} of {bound:g} ({100.0 * peak / bound:.0f} %)'
