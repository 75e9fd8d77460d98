"""The demonstration's plot: every profile against its limits, and the tip's path in space."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import matplotlib
from matplotlib.figure import Figure
import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.dynamics import inverse_dynamics
from rrr_traj_planner.core.interpolation import Interpolant
from rrr_traj_planner.core.kinematics import forward_kinematics
from rrr_traj_planner.nodes.demo_client import Run

COLOURS = ('#0072b2', '#d55e00', '#009e73')  # told apart by colour-blind eyes, and in print
STEPS = 2000
STYLE = {
    'font.size': 9, 'axes.grid': True, 'grid.alpha': 0.25, 'grid.linewidth': 0.6,
    'axes.spines.top': False, 'axes.spines.right': False, 'lines.linewidth': 1.4,
    'legend.frameon': False, 'figure.constrained_layout.use': True}


def draw(run: Run, file: Path) -> None:
    """
    Draw a run.

    Parameters
    ----------
    run : Run
        What was asked, planned and done.
    file : Path
        Where the picture goes; its ending says the format.

    """
    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(11.0, 9.0))
        grid = figure.add_gridspec(5, 2, width_ratios=(1.25, 1.0))
        _profiles(figure, grid, run)
        _space(figure.add_subplot(grid[:3, 1], projection='3d'), run)
        _tracking(figure.add_subplot(grid[3:, 1]), run)
        planner = run.task.planner_id or run.config.default_planner_id
        figure.suptitle(f'{run.task.name}: {len(run.task.via_points)} via points, planner '
                        f'{planner}, {run.response.via_times[-1]:.3f} s', fontsize=11)
        figure.savefig(file, dpi=150)


def _profiles(figure: Figure, grid: Any, run: Run) -> None:
    """Draw position to torque over time, one above the other."""
    limits, names = run.config.limits, run.config.model.joint_names
    t = np.linspace(0.0, run.planned.duration, STEPS)
    q, qd, qdd = Interpolant(run.planned)(t)
    jerk = np.gradient(qdd, t, axis=0)
    torque = inverse_dynamics(run.config.model, q, qd, qdd)
    rows: list[tuple[str, Array, Array | None]] = [
        ('position [rad]', q, None), ('velocity [rad/s]', qd, limits.max_velocity),
        ('acceleration [rad/s²]', qdd, limits.max_acceleration),
        ('jerk [rad/s³]', jerk, limits.max_jerk), ('torque [N m]', torque, limits.max_effort)]
    first = None
    for row, (label, values, limit) in enumerate(rows):
        axes = figure.add_subplot(grid[row, 0], sharex=first)
        first = first or axes
        for joint, colour in enumerate(COLOURS):
            axes.plot(t, values[:, joint], color=colour, label=names[joint])
        if label.startswith('torque'):
            for joint, colour in enumerate(COLOURS):
                axes.plot(run.recorded.times, run.torque[:, joint], color=colour, linewidth=0.8,
                          linestyle=':')
        if limit is not None:
            _limit_lines(axes, limit)
        for via in run.response.via_times:
            axes.axvline(via, color='0.75', linewidth=0.8, zorder=0)
        axes.set_ylabel(label)
        axes.tick_params(labelbottom=row == len(rows) - 1)
    first.set_xlim(0.0, run.planned.duration)
    axes.set_xlabel('time [s]; grey: via points; dashed: limits; dotted: torque driven')
    figure.axes[0].legend(ncols=3, loc='lower center', bbox_to_anchor=(0.5, 1.0))


def _limit_lines(axes: Any, limit: Array) -> None:
    """Draw finite limits, in the joints' colours where they differ."""
    same = np.ptp(limit[np.isfinite(limit)]) == 0.0 if np.isfinite(limit).any() else True
    for joint, colour in enumerate(COLOURS):
        if np.isfinite(limit[joint]):
            for sign in (-1.0, 1.0):
                axes.axhline(sign * limit[joint], color='0.4' if same else colour,
                             linewidth=0.9, linestyle='--', zorder=1)


def _space(axes: Any, run: Run) -> None:
    """Draw the tip's path, the via points and the arm at each of them."""
    model = run.config.model
    q = Interpolant(run.planned)(np.linspace(0.0, run.planned.duration, STEPS))[0]
    axes.plot(*forward_kinematics(model, q).T, color='#cc79a7', label='planned')
    driven = run.recorded.positions[run.recorded.times >= 0.0]
    axes.plot(*forward_kinematics(model, driven).T, color='black', linestyle=':',
              linewidth=1.0, label='driven')
    at_via = Interpolant(run.planned)(np.array(run.response.via_times))[0]
    for i, pose in enumerate(at_via):
        axes.plot(*_links(run, pose).T, color='0.6', linewidth=2.0, marker='o', markersize=3,
                  label='arm at via points' if i == 0 else None)
    axes.scatter(*run.task.via_points.T, color='#e69f00', edgecolor='black', s=36, depthshade=False,
                 label='via points', zorder=5)
    for i, point in enumerate(run.task.via_points):
        axes.text(*point, f'  {i}')
    axes.set(xlabel='x [m]', ylabel='y [m]', zlabel='z [m]')
    axes.set_aspect('equal')
    axes.view_init(elev=22.0, azim=-60.0)
    axes.legend(loc='upper left', fontsize=8)


def _links(run: Run, q: Array) -> Array:
    """Return base, shoulder, elbow and tip [m]."""
    model = run.config.model
    reach = model.a2 * np.cos(q[1])
    elbow = (reach * np.cos(q[0]), reach * np.sin(q[0]), model.d1 + model.a2 * np.sin(q[1]))
    return np.array([(0.0, 0.0, 0.0), (0.0, 0.0, model.d1), elbow,
                     forward_kinematics(model, q)])


def _tracking(axes: Any, run: Run) -> None:
    """Draw how far the tip is from the plan."""
    t = run.recorded.times[(run.recorded.times >= 0.0)]
    driven = run.recorded.positions[run.recorded.times >= 0.0]
    wanted = Interpolant(run.planned)(t)[0]
    error = np.linalg.norm(forward_kinematics(run.config.model, driven)
                           - forward_kinematics(run.config.model, wanted), axis=1)
    axes.plot(t, 1e6 * error, color='black')
    for via in run.response.via_times:
        axes.axvline(via, color='0.75', linewidth=0.8, zorder=0)
    axes.set(xlabel='time [s]', ylabel='tip off the plan [µm]', xlim=(0.0, t[-1]))
    axes.set_ylim(bottom=0.0)
