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

"""The report of a task: vibration, profiles, torque, path, animation, peaks; several planners."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from rrr_traj_planner.core.errors import counted
from rrr_traj_planner.report.animation import Animation
from rrr_traj_planner.report.attempts import Attempt, Planned, planned
from rrr_traj_planner.report.page import Content, Section, write_page
from rrr_traj_planner.report.path_figures import path_in_space, paths_in_space
from rrr_traj_planner.report.profile_figures import compared, profiles, torque_use
from rrr_traj_planner.report.tables import (
    methods_table,
    peaks_table,
    refusals_table,
    via_points_table,
)
from rrr_traj_planner.report.vibration import TEXT, vibration_figure, vibration_table

FEW = 6  # largest number of via points that the introduction lists; else only first and last


def write_plan_report(folder: Path, found: Sequence[Attempt]) -> Path:
    """
    Write the page, its figures and its tables.

    Parameters
    ----------
    folder : Path
        Folder of the page and its files.
    found : sequence of Attempt
        Results of one or more planners for one task.

    Returns
    -------
    Path
        The page; it shows refusals with their reasons.

    """
    task = found[0].task
    joints = task.request.joint_via_points
    given, unit = (task.via_points, 'm') if joints is None else (joints, 'rad')
    points = ['(' + ', '.join(f'{x:g}' for x in p) + ')' for p in given]
    text = '; '.join(points) if len(points) <= FEW else f'from {points[0]} to {points[-1]}'
    return write_page(folder, f'Plan of {task.name}',
                      f'{counted(len(points), "via point")} [{unit}]: {text}.', sections(found))


def sections(found: Sequence[Attempt]) -> list[Section]:
    """
    Return the sections of the page.

    Parameters
    ----------
    found : sequence of Attempt
        Results of one or more planners for one task.

    Returns
    -------
    list of Section
        If all planners refuse, only the tables of refusals and of via points.

    """
    plans, task = planned(found), found[0].task
    notes = '\n\n'.join(f'{p.planner_id}: {p.plan.note}' for p in plans if p.plan.note)
    tables: list[Content] = []
    if plans:
        tables.append(methods_table(
            found, 'planners', 'Plans', "Peaks are the largest of the three joints'."))
    if len(plans) < len(found):
        tables.append(refusals_table(found, 'refusals'))
    parts = [Section('Planners', notes, tables)]
    points = Section('Via points', '', [via_points_table(task, plans, 'via_points')])
    if not plans:
        return [*parts, points]
    parts.append(Section('Residual vibration', TEXT, [
        vibration_table(plans, 'vibrations'), vibration_figure(plans, 'vibration')]))
    parts.append(Section('Motion', '', [Animation(
        'animation', 'The arm along the path',
        'Drag a picture to turn the view. The path ahead of the tip is grey. Below each picture: '
        'the limit (of velocity, acceleration, jerk or torque of a joint) that is used most then.',
        plans)]))
    if len(plans) > 1:
        parts.append(Section('Side by side', '', _comparison(plans)))
    names = unique_names([p.planner_id for p in plans])
    kinds = [(title, text, [draw(p, name) for p, name in zip(plans, names)])
             for title, text, draw in _KINDS]
    if len(plans) == 1:  # all figures in one section
        kinds = [('Figures', ' '.join(text for _, text, _ in kinds if text),
                  [content for _, _, contents in kinds for content in contents])]
    return [*parts, *(Section(*kind) for kind in kinds), points]


def unique_names(planner_ids: Sequence[str]) -> list[str]:
    """
    Return distinct file names for planners.

    Parameters
    ----------
    planner_ids : sequence of str
        The planners, possibly repeated.

    Returns
    -------
    list of str
        The ids; repeated ones with a number appended.

    """
    return [i if i not in planner_ids[:k] else f'{i}_{planner_ids[:k].count(i) + 1}'
            for k, i in enumerate(planner_ids)]


def _comparison(plans: Sequence[Planned]) -> list[Content]:
    names = plans[0].task.model.joint_names
    return [paths_in_space(plans, 'paths', 'Paths of the tip', 'Via points are numbered.'),
            *(compared(plans, joint, f'compared_{joint + 1}', f'{names[joint]} by every planner',
                       '') for joint in range(3))]


def _profiles(of: Planned, name: str) -> Content:
    return profiles(of, f'profiles_{name}', f'{of.planner_id}: profiles against limits', '')


def _torque(of: Planned, name: str) -> Content:
    return torque_use(of, f'torque_{name}', f'{of.planner_id}: torque use', '')


def _path(of: Planned, name: str) -> Content:
    return path_in_space(of, f'path_{name}', f'{of.planner_id}: path of the tip',
                         'With the arm at equal steps of time.')


def _peaks(of: Planned, name: str) -> Content:
    return peaks_table(of, f'peaks_{name}')


_KINDS: tuple[tuple[str, str, Callable[[Planned, str], Content]], ...] = (
    ('Profiles', 'Shaded: within the limits.', _profiles),
    ('Torque', 'Over the length of the path for Cartesian planners, else over time.', _torque),
    ('Path', '', _path), ('Peaks', '', _peaks))
