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

"""Elements of several figures: stacked axes, limits, via points, legends."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from matplotlib.collections import LineCollection
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.report.theme import DASHES, JOINTS, LIGHT, LIMIT, VIA

POSITION, VELOCITY = 'position [rad]', 'velocity [rad/s]'
ACCELERATION, JERK, TORQUE = 'acceleration [rad/s²]', 'jerk [rad/s³]', 'torque [N m]'
TIME = 'time [s]'
ROW_HEIGHT = 1.35   # inches, of each of the stacked axes
LEGEND_GAP = 0.06   # inches, between a legend and the axes below it
MAX_LINES = 20      # largest number of via points that are marked by lines; more hide the curves
TICK = 0.06         # height of a via point's tick, as a fraction of the axes' height
EDGE_HEIGHT = 0.75  # inches, for the legend and the labels of the lowest axis


def stacked(figure: Any, labels: Sequence[str], x_label: str = TIME) -> list[Any]:
    """
    Return axes one above the other.

    Parameters
    ----------
    figure : Figure
        The figure.
    labels : sequence of str
        Labels of the vertical axes.
    x_label : str
        Label of the common horizontal axis.

    Returns
    -------
    list of Axes
        From top to bottom.

    """
    axes = list(np.atleast_1d(figure.subplots(len(labels), 1, sharex=True)))
    for one, label in zip(axes, labels):
        one.set_ylabel(label)
        one.margins(x=0.0)
    axes[-1].set_xlabel(x_label)
    figure.align_ylabels(axes)
    return axes


def height_of(rows: int) -> float:
    """
    Return the height of a figure of stacked axes.

    Parameters
    ----------
    rows : int
        Number of axes.

    Returns
    -------
    float
        Height [inches].

    """
    return rows * ROW_HEIGHT + EDGE_HEIGHT


def joint_lines(axes: Any, x: Array, values: Array) -> None:
    """
    Draw a quantity for all joints.

    Parameters
    ----------
    axes : Axes
        The axes.
    x : ndarray, shape (n,)
        Horizontal values.
    values : ndarray, shape (n, 3)
        A column for each joint.

    """
    for joint, (colour, dashes) in enumerate(zip(JOINTS, DASHES)):
        axes.plot(x, values[:, joint], color=colour, linestyle=dashes)


def limit_band(axes: Any, limit: Array) -> None:
    """
    Draw limits: a band up to the largest, and lines, in the joints' colours if they differ.

    Parameters
    ----------
    axes : Axes
        The axes.
    limit : ndarray, shape (3,)
        Bounds on the magnitude; infinite ones are not drawn.

    """
    finite = limit[np.isfinite(limit)]
    if not len(finite):
        return
    widest = float(finite.max())
    if len(finite) == len(limit):
        axes.axhspan(-widest, widest, color=LIGHT['band'], linewidth=0.0, zorder=0)
    for joint, bound in enumerate(limit):
        if np.isfinite(bound):
            same = np.ptp(finite) == 0.0
            for sign in (-1.0, 1.0):
                axes.axhline(sign * bound, **{**LIMIT, **({} if same else {
                    'color': JOINTS[joint]})})


def range_lines(axes: Any, low: Array, high: Array) -> None:
    """
    Draw the ends of the joints' ranges that lie within the axes' limits.

    Parameters
    ----------
    axes : Axes
        The axes, with the positions drawn.
    low, high : ndarray, shape (3,)
        Ends of the ranges.

    """
    bottom, top = axes.get_ylim()
    for ends in (low, high):
        for joint, end in enumerate(ends):
            if bottom <= end <= top:
                axes.axhline(end, **{**LIMIT, 'color': JOINTS[joint]})


def via_lines(axes: Sequence[Any], places: Array) -> None:
    """
    Mark the via points by vertical lines, or by ticks if there are many.

    Parameters
    ----------
    axes : sequence of Axes
        The axes.
    places : ndarray
        Horizontal values: times or path lengths.

    """
    height = 1.0 if len(places) <= MAX_LINES else TICK
    for one in axes:
        one.add_collection(LineCollection(
            [((x, 0.0), (x, height)) for x in places], transform=one.get_xaxis_transform(),
            **{f'{key}s' if key in ('color', 'linestyle') else key: v for key, v in VIA.items()}),
            autolim=False)


def joint_handles(names: Sequence[str]) -> list[Any]:
    """
    Return the legend's handles for the joints.

    Parameters
    ----------
    names : sequence of str
        Names of the joints.

    Returns
    -------
    list of Line2D
        Handles.

    """
    return [Line2D([], [], color=c, linestyle=d, label=n)
            for c, d, n in zip(JOINTS, DASHES, names)]


def limit_handle() -> Any:
    """Return the legend's handle for limits."""
    return Line2D([], [], **LIMIT, label='limit')


def via_handle() -> Any:
    """Return the legend's handle for via points."""
    return Line2D([], [], **VIA, label='via point')


def shade_handle(label: str) -> Any:
    """
    Return the legend's handle for shaded intervals.

    Parameters
    ----------
    label : str
        Its text.

    Returns
    -------
    Patch
        The handle.

    """
    return Patch(color=LIGHT['transition'], label=label)


def legend(figure: Any, handles: Sequence[Any], columns: int = 3) -> None:
    """
    Put a legend above all axes of a figure, and shrink the axes to make space for it.

    Parameters
    ----------
    figure : Figure
        The figure.
    handles : sequence
        Entries of the legend.
    columns : int
        Largest number of columns.

    """
    found = figure.legend(handles=list(handles), loc='upper center',
                          ncols=min(columns, len(handles)), columnspacing=1.2, handlelength=2.2)
    fraction = found.get_window_extent().height / figure.bbox.height
    fraction += LEGEND_GAP / figure.get_figheight()
    engine = figure.get_layout_engine()
    if isinstance(engine, ConstrainedLayoutEngine):
        engine.set(rect=(0.0, 0.0, 1.0, 1.0 - fraction))
    else:
        for axes in figure.axes:
            left, bottom, width, height = axes.get_position(original=True).bounds
            axes.set_position((left, bottom, width, min(height, 1.0 - fraction - bottom)))
