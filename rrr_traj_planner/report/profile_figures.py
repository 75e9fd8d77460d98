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

"""Figures of a motion over time: profiles with limits, single joints, use of torque limits."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.path.path_trajectory import PathTrajectory
from rrr_traj_planner.report import drawing
from rrr_traj_planner.report.attempts import Planned
from rrr_traj_planner.report.measures import time_at_limit
from rrr_traj_planner.report.motion_samples import (
    limit_use,
    path_lengths,
    sampled,
    Samples,
    tightest,
)
from rrr_traj_planner.report.picture import Picture
from rrr_traj_planner.report.theme import DASHES, JOINTS, LIGHT, SERIES

USED = 0.95  # of a limit, above which it counts as active


def profiles(of: Planned, name: str, title: str, caption: str) -> Picture:
    """
    Return the figure of all joints' position, velocity, acceleration, jerk and torque.

    Parameters
    ----------
    of : Planned
        The motion.
    name, title, caption : str
        See `Picture`.

    Returns
    -------
    Picture
        Five rows, with limits as bands.

    """
    s, limits = sampled(of.task.model, of.plan.trajectory), of.task.limits
    rows = ((drawing.POSITION, s.q, np.full(3, np.inf)),
            (drawing.VELOCITY, s.qd, limits.max_velocity),
            (drawing.ACCELERATION, s.qdd, limits.max_acceleration),
            (drawing.JERK, s.qddd, limits.max_jerk),
            (drawing.TORQUE, s.torque, limits.max_effort))

    def draw(figure: Any) -> None:
        axes = drawing.stacked(figure, [label for label, _, _ in rows])
        for one, (_, values, limit) in zip(axes, rows):
            drawing.limit_band(one, limit)
            drawing.joint_lines(one, s.t, values)
        drawing.range_lines(axes[0], limits.min_position, limits.max_position)
        drawing.via_lines(axes, of.plan.via_times)
        drawing.legend(figure, [*drawing.joint_handles(of.task.model.joint_names),
                                drawing.limit_handle(), drawing.via_handle()])

    return Picture(name, title, caption, draw, drawing.height_of(5), columns(s))


def positions(of: Planned, name: str, title: str, caption: str) -> Picture:
    """
    Return the figure of all joints' positions, with the via points.

    Parameters
    ----------
    of : Planned
        The motion.
    name, title, caption : str
        See `Picture`.

    Returns
    -------
    Picture
        Positions in degrees, as in the thesis.

    """
    s = sampled(of.task.model, of.plan.trajectory)

    def draw(figure: Any) -> None:
        axes = drawing.stacked(figure, ['position [deg]'])
        drawing.joint_lines(axes[0], s.t, np.degrees(s.q))
        drawing.via_lines(axes, of.plan.via_times)
        drawing.legend(figure, [*drawing.joint_handles(of.task.model.joint_names),
                                drawing.via_handle()], 4)

    return Picture(name, title, caption, draw, 3.1, columns(s))


def one_joint(of: Planned, joint: int, name: str, title: str, caption: str) -> Picture:
    """
    Return the figure of one joint's velocity, acceleration and jerk.

    Parameters
    ----------
    of : Planned
        The motion.
    joint : int
        The joint's index.
    name, title, caption : str
        See `Picture`.

    Returns
    -------
    Picture
        Three rows.

    """
    s = sampled(of.task.model, of.plan.trajectory)
    rows = ((drawing.VELOCITY, s.qd), (drawing.ACCELERATION, s.qdd), (drawing.JERK, s.qddd))

    def draw(figure: Any) -> None:
        axes = drawing.stacked(figure, [label for label, _ in rows])
        for one, (_, values) in zip(axes, rows):
            one.plot(s.t, values[:, joint], color=JOINTS[joint])
        drawing.via_lines(axes, of.plan.via_times)
        handle = drawing.joint_handles(of.task.model.joint_names)[joint]
        handle.set_linestyle('-')
        drawing.legend(figure, [handle, drawing.via_handle()])

    return Picture(name, title, caption, draw, drawing.height_of(3), {
        'time [s]': s.t, **{label: values[:, joint] for label, values in rows}})


def torque_use(of: Planned, name: str, title: str, caption: str) -> Picture:
    """
    Return the figure of the use of each torque limit, and of the limit that is used most.

    Parameters
    ----------
    of : Planned
        The motion.
    name, title, caption : str
        See `Picture`; a sentence is added to the caption.

    Returns
    -------
    Picture
        Over the length of the path for Cartesian planners, else over time.

    """
    trajectory = of.plan.trajectory
    s = sampled(of.task.model, trajectory)
    use = limit_use(s, of.task.limits)
    most = tightest(use)
    x, via, label = s.t, of.plan.via_times, drawing.TIME
    if isinstance(trajectory, PathTrajectory):
        x, via = path_lengths(trajectory, s.t), trajectory.arm_path.path.via_s
        label = 'length along the path [m]'
    rows = ['torque / limit [%]', 'tightest limit [%]']

    def draw(figure: Any) -> None:
        axes = drawing.stacked(figure, rows, label)
        for one in axes:
            drawing.limit_band(one, np.full(3, 100.0))
            one.set_ylim(0.0, max(105.0, 102.0 * float(most.max())))
        drawing.joint_lines(axes[0], x, 100.0 * use['torque'])
        axes[1].plot(x, 100.0 * most, color=LIGHT['ink'])
        drawing.via_lines(axes, via)
        drawing.legend(figure, [*drawing.joint_handles(of.task.model.joint_names),
                                drawing.limit_handle(), drawing.via_handle()])

    text = (f'{caption} For {100.0 * time_at_limit(most, s.t, USED):.0f} % of the time at least '
            f'one limit (velocity, acceleration, jerk or torque, of any joint) is used to '
            f'{100.0 * USED:.0f} % or more.').strip()
    data = {label: x, 'time [s]': s.t, **{
        f'{joint} torque / limit': use['torque'][:, i]
        for i, joint in enumerate(of.task.model.joint_names)}, 'tightest limit use': most}
    return Picture(name, title, text, draw, drawing.height_of(2) + 0.3, data)


def compared(plans: Sequence[Planned], joint: int, name: str, title: str,
             caption: str) -> Picture:
    """
    Return the figure of one joint's motion by several planners.

    Parameters
    ----------
    plans : sequence of Planned
        One or more, all for the same arm.
    joint : int
        The joint's index.
    name, title, caption : str
        See `Picture`.

    Returns
    -------
    Picture
        Velocity, acceleration and torque.

    """
    series = [sampled(p.task.model, p.plan.trajectory) for p in plans]
    limits = plans[0].task.limits
    rows = ((drawing.VELOCITY, 'qd', limits.max_velocity),
            (drawing.ACCELERATION, 'qdd', limits.max_acceleration),
            (drawing.TORQUE, 'torque', limits.max_effort))

    def draw(figure: Any) -> None:
        axes = drawing.stacked(figure, [label for label, _, _ in rows])
        lines: list[Any] = []
        for one, (_, quantity, limit) in zip(axes, rows):
            drawing.limit_band(one, np.full(3, limit[joint]))
            lines = [one.plot(s.t, getattr(s, quantity)[:, joint], color=SERIES[i % len(SERIES)],
                              linestyle=DASHES[i % len(DASHES)], label=p.planner_id)[0]
                     for i, (p, s) in enumerate(zip(plans, series))]
        drawing.legend(figure, [*lines, drawing.limit_handle()], 2)

    rows_of_legend = (len(plans) + 2) // 2
    return Picture(name, title, caption, draw, drawing.height_of(3) + 0.17 * rows_of_legend)


def columns(s: Samples) -> dict[str, Array]:
    """
    Return a motion as the columns of a CSV file.

    Parameters
    ----------
    s : Samples
        The motion.

    Returns
    -------
    dict
        Columns by heading.

    """
    found: dict[str, Array] = {'time [s]': s.t}
    for label, values in (('position [rad]', s.q), ('velocity [rad/s]', s.qd),
                          ('acceleration [rad/s^2]', s.qdd), ('jerk [rad/s^3]', s.qddd),
                          ('torque [N m]', s.torque)):
        for joint in range(3):
            found[f'joint {joint + 1} {label}'] = values[:, joint]
    for i, axis in enumerate('xyz'):
        found[f'tip {axis} [m]'] = s.tip[:, i]
    return found
