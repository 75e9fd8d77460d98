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

"""The thesis's tables and figures, drawn with this package's planners and functions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from rrr_traj_planner.core.rounding import JOINT_ROUNDING
from rrr_traj_planner.planners.registry import planner_ids
from rrr_traj_planner.report.approach_figures import figure_4_3, figure_4_4
from rrr_traj_planner.report.attempts import Attempt, attempts, Planned, planned
from rrr_traj_planner.report.claim_figures import claims_table, spectra, vibrations
from rrr_traj_planner.report.function_figures import (
    figure_3_1,
    figure_3_2,
    figure_3_3,
    figure_4_1,
    figure_4_5,
)
from rrr_traj_planner.report.measures import measures
from rrr_traj_planner.report.page import Content, Section, write_page
from rrr_traj_planner.report.path_figures import magnified_zone, path_in_space
from rrr_traj_planner.report.picture import Picture
from rrr_traj_planner.report.profile_figures import one_joint, positions, torque_use
from rrr_traj_planner.report.tables import methods_table
from rrr_traj_planner.report.theme import LIGHT, SERIES
from rrr_traj_planner.report.thesis_tables import data_tables
from rrr_traj_planner.report.thesis_tasks import table_6_1, table_6_3, table_6_3_as_printed

TITLE = 'The thesis, redrawn'
TEXT = """\
Tables and figures of S. Amara, A Method for Generating a Controllable and Quasi Time Optimal Robot
Trajectory, drawn from this package's own planners and functions with the thesis's data. Figures
have the thesis's numbers. Where printed equations are wrong, the corrected ones are used.

Position, velocity and acceleration limits are those of tables 6.2 and B.3 (joint 2's range
mirrored, as no elbow branch fits the printed one); jerk, which the thesis does not limit, is
limited to 10 rad/s³."""

CLAIMS = """\
Less excitation: true for a transition of the same duration, not for whole motions with shorter
transitions. Near time optimality: not true for approach (a); the least times are those of any
motion through the points under the same limits."""

REPEATS = 2  # times that a task is planned: the shorter one counts, as the first loads modules
POLYNOMIAL, THESIS = 'poly_414', 'cycloid_approach_a'


@dataclass(frozen=True, eq=False)
class ThesisPlans:
    """
    Results of the planners for the thesis's tasks.

    Parameters
    ----------
    table_6_1, table_6_3 : sequence of Attempt
        Results of every planner.
    as_printed : sequence of Attempt
        Result of `line_arc` for table 6.3 with the thesis's own torque limits.

    """

    table_6_1: Sequence[Attempt]
    table_6_3: Sequence[Attempt]
    as_printed: Sequence[Attempt]

    def on_table_6_1(self, planner_id: str) -> Planned:
        """
        Return a planner's plan for table 6.1.

        Parameters
        ----------
        planner_id : str
            The planner.

        Returns
        -------
        Planned
            Its plan.

        """
        return next(p for p in planned(self.table_6_1) if p.planner_id == planner_id)

    def on_table_6_3(self, planner_id: str) -> Planned:
        """
        Return a planner's plan for table 6.3.

        Parameters
        ----------
        planner_id : str
            The planner.

        Returns
        -------
        Planned
            Its plan.

        """
        return next(p for p in planned(self.table_6_3) if p.planner_id == planner_id)


def thesis_plans() -> ThesisPlans:
    """Plan the thesis's tasks by every registered planner."""
    ids = planner_ids()
    return ThesisPlans(
        attempts(table_6_1(), ids, REPEATS), attempts(table_6_3(), ids, REPEATS),
        attempts(table_6_3_as_printed(), ['line_arc']))


def write_thesis_report(folder: Path) -> Path:
    """
    Write the page, its figures and its tables.

    Parameters
    ----------
    folder : Path
        Folder of the page and its files.

    Returns
    -------
    Path
        The page.

    """
    folder.mkdir(parents=True, exist_ok=True)  # where that fails, before all the work
    plans = thesis_plans()
    return write_page(folder, TITLE, TEXT, sections(plans))


def sections(plans: ThesisPlans) -> list[Section]:
    """
    Return the sections of the page.

    Parameters
    ----------
    plans : ThesisPlans
        The plans.

    Returns
    -------
    list of Section
        A comparison of the methods, then the thesis's figures in their order.

    """
    return [
        Section('Methods compared', _refused(plans), _comparison(plans)),
        Section('Chapter 3: functions', '', [figure_3_1(), figure_3_2(), figure_3_3()]),
        Section('Chapter 4: joint interpolated motion', '', [
            figure_4_1(), figure_4_3(plans.on_table_6_1(THESIS)),
            figure_4_4(plans.on_table_6_1('cycloid_approach_b')), figure_4_5()]),
        Section('Section 6.3: polynomial 4-1-4', '', _joint_figures(
            plans.on_table_6_1(POLYNOMIAL), 2, 'by means of polynomial function',
            'with t_acc = 0.5 s', 'The via point is missed; jerk steps where a quartic begins '
            'or ends.')),
        Section('Section 6.3: imposed acceleration profile', '', _joint_figures(
            plans.on_table_6_1(THESIS), 6, 'by means of imposed acceleration profile',
            'by approach (a)', 'Through the via point; jerk is continuous, and zero where a '
            'transition begins or ends.')),
        Section('Section 6.4: path in Cartesian space', '', _path_figures(plans)),
        Section('Claims of section 6.5', CLAIMS, [
            claims_table(_on_both_tables(plans)), spectra(), vibrations()]),
        Section("The thesis's data", '', data_tables())]


def _on_both_tables(plans: ThesisPlans) -> list[tuple[Planned, Planned]]:
    others = {p.planner_id: p for p in planned(plans.table_6_3)}
    return [(p, others[p.planner_id]) for p in planned(plans.table_6_1)
            if p.planner_id in others]


def _refused(plans: ThesisPlans) -> str:
    return ("Each method plans both of the thesis's tasks. Peaks are the largest of the three "
            "joints'. Coefficients are counted as in section 6.5: of the whole motion, and of one "
            'transition. Table 6.3 is planned with 250 N m for joint 2: with the 200 N m of table '
            f'B.3 it is refused: {plans.as_printed[0].refusal}.')


def _comparison(plans: ThesisPlans) -> list[Content]:
    return [
        methods_table(plans.table_6_1, 'methods_table_6_1', 'Methods on table 6.1',
                      'Jerk is shown where pieces of a motion meet; for line_arc and '
                      'line_polynomial, of the progress along the path.'),
        methods_table(plans.table_6_3, 'methods_table_6_3', 'Methods on table 6.3',
                      'With 250 N m for joint 2.'),
        _total_times(plans.table_6_1, 'times_table_6_1', 'Total time on table 6.1'),
        _total_times(plans.table_6_3, 'times_table_6_3', 'Total time on table 6.3')]


def _total_times(found: Sequence[Attempt], name: str, title: str) -> Picture:
    """
    Return the figure of the methods' total times.

    Parameters
    ----------
    found : sequence of Attempt
        Their results for one task.
    name, title : str
        See `Picture`.

    Returns
    -------
    Picture
        Bars, the fastest on top.

    """
    plans = sorted(planned(found), key=lambda p: -p.plan.trajectory.duration)
    times = np.array([p.plan.trajectory.duration for p in plans])
    missing = np.array([measures(p).via_error > JOINT_ROUNDING for p in plans])

    def draw(figure: Any) -> None:
        axes = figure.subplots()
        bars = axes.barh([p.planner_id for p in plans], times, color=SERIES[0], height=0.65)
        for bar, misses in zip(bars, missing):
            if misses:
                bar.set(color=LIGHT['limit'])
        axes.bar_label(bars, [f'{t:.3f} s' for t in times], padding=3)
        axes.set(xlabel='total time [s]', xlim=(0.0, 1.2 * times.max()))
        axes.grid(visible=False, axis='y')

    return Picture(name, title, 'Grey: the via point is missed.', draw,
                   0.9 + 0.25 * len(plans), {'total time [s]': times})


def _joint_figures(of: Planned, first: int, how: str, conditions: str,
                   remark: str) -> list[Content]:
    figures: list[Content] = [positions(
        of, f'figure_6_{first}',
        f'Figure 6.{first}: the positions {how} for joint 1, 2 and 3 {conditions}',
        f'{of.planner_id} on table 6.1, {of.plan.trajectory.duration:.3f} s. {remark}')]
    return figures + [one_joint(
        of, joint, f'figure_6_{first + 1 + joint}',
        f'Figure 6.{first + 1 + joint}: the velocity, acceleration and jerk {how} for joint '
        f'{joint + 1} {conditions}', f'{of.planner_id} on table 6.1.') for joint in range(3)]


def _path_figures(plans: ThesisPlans) -> list[Content]:
    arc, smooth = (plans.on_table_6_3(i) for i in ('line_arc', 'line_polynomial'))
    return [
        path_in_space(arc, 'figure_6_12', 'Figure 6.12: 3-D diagram for the resulting path',
                      'line_arc on table 6.3, with the arm at equal steps of time.'),
        magnified_zone(arc, 0, 'figure_6_13', 'Figure 6.13: magnification of the curvature part',
                       'The arc through the via point.'),
        magnified_zone(smooth, 0, 'figure_6_13_polynomial',
                       'The same with a polynomial curve (3.18)',
                       'line_polynomial: curvature is continuous.'),
        torque_use(arc, 'torque_line_arc', 'Torque use along the path, line and arc',
                   'line_arc on table 6.3.'),
        torque_use(smooth, 'torque_line_polynomial', 'Torque use along the path, polynomial',
                   'line_polynomial on table 6.3.')]
