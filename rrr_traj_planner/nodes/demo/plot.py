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

"""The demo's plot: every profile with its limits, the tip's path, and the tracking error."""

from __future__ import annotations

from pathlib import Path
from typing import Any
from warnings import catch_warnings, filterwarnings

import matplotlib
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MultipleLocator
import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.dynamics.motor_torque import motor_torque, rest_speed_of
from rrr_traj_planner.core.errors import counted
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.kinematics.link_positions import link_positions
from rrr_traj_planner.core.trajectory.quintic_spline import spline_through
from rrr_traj_planner.nodes.runs.run import Run
from rrr_traj_planner.report.path_figures import away_from_nearest, LABEL_DISTANCE, projection

COLOURS = ('#0072b2', '#d55e00', '#009e73')  # Okabe and Ito's: distinct for colour-blind people
CUT_OFF = 2.0      # multiple of the limit at which a curve is cut off
STEPS = 2000       # times at which curves are drawn
SAME_PLACE = 1e-6  # of the picture's width, below which via points have one common label
STYLE = {
    'font.size': 9, 'axes.grid': True, 'grid.alpha': 0.25, 'grid.linewidth': 0.6,
    'axes.spines.top': False, 'axes.spines.right': False, 'lines.linewidth': 1.4,
    'legend.frameon': False, 'figure.constrained_layout.use': True}
LIMIT = {'color': '0.4', 'linewidth': 0.9, 'linestyle': '--', 'zorder': 1}
EXECUTED = {'color': 'black', 'linewidth': 1.0, 'linestyle': ':'}
VIA = {'color': '0.75', 'linewidth': 0.8, 'zorder': 0}


def draw(run: Run, file: Path) -> None:
    """
    Draw a run of the demo.

    Parameters
    ----------
    run : Run
        The run.
    file : Path
        The picture; its suffix sets the format.

    """
    with matplotlib.rc_context(STYLE), catch_warnings():
        filterwarnings('ignore', 'Glyph')  # a name in a script that the font lacks has boxes
        figure = Figure(figsize=(10.0, 8.0))
        left, right = figure.subfigures(1, 2, width_ratios=(1.25, 1.0))
        profiles = _profiles(left, run)
        grid = right.add_gridspec(2, 1, height_ratios=(2.0, 1.0))
        _space(right.add_subplot(grid[0], projection='3d'), run)
        _tracking(right.add_subplot(grid[1]), run)
        planner = run.task.planner_id or run.config.default_planner_id
        points = counted(len(run.tips), 'via point')
        figure.suptitle(f'{run.task.name}: {points}, planner {planner}, '
                        f'{run.response.via_times[-1]:.3f} s', fontsize=11)
        left.align_ylabels(profiles)
        figure.savefig(file, dpi=150)


def _profiles(figure: Any, run: Run) -> list[Any]:
    """Draw position, velocity, acceleration, jerk and torque over time, one above the other."""
    limits, names = run.config.limits, run.config.model.joint_names
    t = np.linspace(0.0, run.planned.duration, STEPS)
    q, qd, qdd, jerk = spline_through(run.planned).at(t)
    torque = motor_torque(run.config.model, q, qd, qdd, rest_speed_of(qd))
    rows: list[tuple[str, Array, Array | None]] = [
        ('position [rad]', q, None), ('velocity [rad/s]', qd, limits.max_velocity),
        ('acceleration [rad/s²]', qdd, limits.max_acceleration),
        ('jerk [rad/s³]', jerk, limits.max_jerk), ('torque [N m]', torque, limits.max_effort)]
    profiles = list(figure.subplots(len(rows), 1, sharex=True))
    for axes, (label, values, limit) in zip(profiles, rows):
        for joint, colour in enumerate(COLOURS):
            axes.plot(t, values[:, joint], color=colour, label=names[joint])
        if limit is not None:
            _limit_lines(axes, limit)
            _cut_off(axes, values, limit)
        _via_lines(axes, run)
        axes.set_ylabel(label)
    for joint in range(len(COLOURS)):
        profiles[-1].plot(run.recorded.times, run.torque[:, joint], **EXECUTED)
    profiles[0].set_xlim(0.0, run.planned.duration)
    profiles[-1].set_xlabel('time [s]')
    profiles[0].legend(handles=[
        *profiles[0].get_lines()[:len(COLOURS)], Line2D([], [], **LIMIT, label='limit'),
        Line2D([], [], **EXECUTED, label='executed'), Line2D([], [], **VIA, label='via point')],
        ncols=6, loc='lower center', bbox_to_anchor=(0.5, 1.0), fontsize=8, columnspacing=1.0,
        handlelength=1.6)
    return profiles


def _via_lines(axes: Any, run: Run) -> None:
    for via in run.response.via_times:
        axes.axvline(via, **VIA)


def _limit_lines(axes: Any, limit: Array) -> None:
    """Draw finite limits; in the joints' colours if they differ."""
    same = np.ptp(limit[np.isfinite(limit)]) == 0.0 if np.isfinite(limit).any() else True
    for joint, colour in enumerate(COLOURS):
        if np.isfinite(limit[joint]):
            for sign in (-1.0, 1.0):
                axes.axhline(sign * limit[joint], **{**LIMIT, **({} if same else {
                    'color': colour})})


def _cut_off(axes: Any, values: Array, limit: Array) -> None:
    """Cut off peaks far above a limit, such as the jerk where the acceleration steps."""
    most = CUT_OFF * limit.max()
    if np.isfinite(most) and np.abs(values).max() > most:
        axes.set_ylim(-most, most)


def _space(axes: Any, run: Run) -> None:
    """Draw the tip's path, the via points and the arm at each of them."""
    model = run.config.model
    q = spline_through(run.planned).at(np.linspace(0.0, run.planned.duration, STEPS))[0]
    at_via = spline_through(run.planned).at(np.array(run.response.via_times))[0]
    for i, pose in enumerate(at_via):
        axes.plot(*zip(*link_positions(run.config.model, pose)), color='0.65', linewidth=2.0,
                  marker='o', markersize=3, label='arm at via points' if i == 0 else None)
    axes.plot(*forward_kinematics(model, q).T, color='#cc79a7', linewidth=2.0, label='planned')
    executed = run.recorded.positions[run.recorded.times >= 0.0]
    axes.plot(*forward_kinematics(model, executed).T, **EXECUTED, label='executed')
    axes.scatter(*run.tips.T, color='#e69f00', edgecolor='black', s=30,
                 depthshade=False, label='via points', zorder=5)
    axes.set(xlabel='x [m]', ylabel='y [m]', zlabel='z [m]')
    axes.set_aspect('equal')
    for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
        axis.set_major_locator(MultipleLocator(_tick_step(axes)))
    axes.tick_params(pad=1)
    axes.view_init(elev=24.0, azim=-62.0)
    _number(axes, run.tips)
    axes.legend(loc='upper center', bbox_to_anchor=(0.5, 1.08), ncols=2, fontsize=8)


def _tick_step(axes: Any) -> float:
    """Return the distance of ticks, the same for all three axes."""
    longest = max(np.ptp(limits) for limits in (
        axes.get_xlim(), axes.get_ylim(), axes.get_zlim()))
    return next(step for step in (0.1 * 2.0 ** k for k in range(-9, 30)) if step > longest / 5.0)


def _number(axes: Any, points: Array) -> None:
    """Write each via point's index beside it, on the side away from its nearest neighbour."""
    projected = projection(axes, points)
    for i, point in enumerate(projected):
        same = np.flatnonzero(np.linalg.norm(point - projected, axis=1) <= SAME_PLACE)
        if same[0] < i:
            continue  # its index is in the label of the first one
        direction = away_from_nearest(point, np.delete(projected, same, axis=0))
        offset = LABEL_DISTANCE * (np.array([1.0, 0.0]) if direction is None else direction)
        axes.annotate(', '.join(map(str, same)), point, offset,
                      textcoords='offset points', ha='center', va='center')


def _tracking(axes: Any, run: Run) -> None:
    """Draw the distance between planned and actual tip position over time."""
    moving = run.recorded.times >= 0.0
    t, executed = run.recorded.times[moving], run.recorded.positions[moving]
    planned = spline_through(run.planned).at(t)[0]
    error = np.linalg.norm(forward_kinematics(run.config.model, executed)
                           - forward_kinematics(run.config.model, planned), axis=1)
    axes.plot(t, 1e6 * error, color='black', linewidth=1.0)
    _via_lines(axes, run)
    axes.set(xlabel='time [s]', ylabel='tip error [µm]', xlim=(0.0, t[-1]))
    axes.set_ylim(bottom=0.0)
