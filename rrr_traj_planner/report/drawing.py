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

"""What several figures share: stacked axes, limits, via points, legends."""

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
ROW_HEIGHT = 1.35  # in
LEGEND_GAP = 0.06  # in, between a legend and the axes below it
MOST_LINES = 20  # for via points; more would hide what is drawn
TICK = 0.06      # of the axes' height
EDGE_HEIGHT = 0.75  # in, of legend and lowest labels


def stacked(figure: Any, labels: Sequence[str], x_label: str = TIME) -> list[Any]:
    """
    Return axes one above the other.

    Parameters
    ----------
    figure : Figure
        Where they go.
    labels : sequence of str
        Of the vertical axes.
    x_label : str
        Of the common horizontal axis.

    Returns
    -------
    list of Axes
        From the top.

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
    Return how high a figure of stacked axes is.

    Parameters
    ----------
    rows : int
        Number of axes.

    Returns
    -------
    float
        [in].

    """
    return rows * ROW_HEIGHT + EDGE_HEIGHT


def joint_lines(axes: Any, x: Array, values: Array) -> None:
    """
    Draw a quantity of all joints.

    Parameters
    ----------
    axes : Axes
        Where.
    x : ndarray, shape (n,)
        Horizontal values.
    values : ndarray, shape (n, 3)
        A column for each joint.

    """
    for joint, (colour, dashes) in enumerate(zip(JOINTS, DASHES)):
        axes.plot(x, values[:, joint], color=colour, linestyle=dashes)


def limit_band(axes: Any, limit: Array) -> None:
    """
    Show limits: a band where all joints have the same, else lines in the joints' colours.

    Parameters
    ----------
    axes : Axes
        Where.
    limit : ndarray, shape (3,)
        Bounds on the magnitude; infinite: none.

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
    Show the ends of the joints' ranges, those that come near what is drawn.

    Parameters
    ----------
    axes : Axes
        Where the positions are drawn already.
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
    Mark when, or where, via points are passed: by lines, by ticks where there are many.

    Parameters
    ----------
    axes : sequence of Axes
        Where.
    places : ndarray
        Horizontal values.

    """
    height = 1.0 if len(places) <= MOST_LINES else TICK
    for one in axes:
        one.add_collection(LineCollection(
            [((x, 0.0), (x, height)) for x in places], transform=one.get_xaxis_transform(),
            **{f'{key}s' if key in ('color', 'linestyle') else key: v for key, v in VIA.items()}),
            autolim=False)


def joint_handles(names: Sequence[str]) -> list[Any]:
    """
    Return what a legend says of the joints' lines.

    Parameters
    ----------
    names : sequence of str
        The joints'.

    Returns
    -------
    list of Line2D
        Handles.

    """
    return [Line2D([], [], color=c, linestyle=d, label=n)
            for c, d, n in zip(JOINTS, DASHES, names)]


def limit_handle() -> Any:
    """Return what a legend says of limits."""
    return Line2D([], [], **LIMIT, label='limit')


def via_handle() -> Any:
    """Return what a legend says of via points."""
    return Line2D([], [], **VIA, label='via point')


def shade_handle(label: str) -> Any:
    """
    Return what a legend says of shaded times.

    Parameters
    ----------
    label : str
        What they are.

    Returns
    -------
    Patch
        The handle.

    """
    return Patch(color=LIGHT['transition'], label=label)


def legend(figure: Any, handles: Sequence[Any], columns: int = 3) -> None:
    """
    Put a legend above all axes of a figure, where it covers nothing.

    Parameters
    ----------
    figure : Figure
        Where.
    handles : sequence
        What it says.
    columns : int
        At most so many beside each other.

    """
    found = figure.legend(handles=list(handles), loc='upper center',
                          ncols=min(columns, len(handles)), columnspacing=1.2, handlelength=2.2)
    share = found.get_window_extent().height / figure.bbox.height
    share += LEGEND_GAP / figure.get_figheight()
    engine = figure.get_layout_engine()
    if isinstance(engine, ConstrainedLayoutEngine):
        engine.set(rect=(0.0, 0.0, 1.0, 1.0 - share))
    else:
        for axes in figure.axes:
            left, bottom, width, height = axes.get_position(original=True).bounds
            axes.set_position((left, bottom, width, min(height, 1.0 - share - bottom)))
