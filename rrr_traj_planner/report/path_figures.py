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

"""Figures in space: the tip's path with the arm, and a magnified zone of it (6.12, 6.13)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from matplotlib.ticker import MaxNLocator
from mpl_toolkits.mplot3d import proj3d
import numpy as np
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.core.path.path_trajectory import PathTrajectory
from rrr_traj_planner.report import drawing
from rrr_traj_planner.report.attempts import Planned
from rrr_traj_planner.report.motion_samples import arm_points, sampled
from rrr_traj_planner.report.picture import Picture
from rrr_traj_planner.report.theme import DASHES, LIGHT, SERIES

# Chosen by eye:
POSES = 9          # poses of the arm in a figure, at equal time steps: more overlap
MAGNIFIED = 2.0    # length shown on either side of the via point, in half lengths of the zone: as
#                    much of the lines as of the zone
POINTS = 600       # of the curve of a magnified path
MIN_EXTENT = 0.02  # m, half length that is assumed for shorter zones
LABEL_DISTANCE = 10.0      # points (1/72 inch), from a via point to its number
LABEL_SIZE = (18.0, 11.0)  # points, width and height of three digits
MAX_LABELS = 24    # numbers of via points; more are illegible at the figure's width
MARKS = ((20, 5.0), (100, 2.5), (np.inf, 1.2))  # largest number of via points, mark [points]
POINTS_PER_INCH = 72.0
ZOOM = 0.88        # of the three-dimensional box, so that labels fit around it


def path_in_space(of: Planned, name: str, title: str, caption: str) -> Picture:
    """
    Return the figure of a tip's path with via points and poses of the arm.

    Parameters
    ----------
    of : Planned
        The motion.
    name, title, caption : str
        See `Picture`.

    Returns
    -------
    Picture
        In three dimensions, with equal scales.

    """
    s = sampled(of.task.model, of.plan.trajectory)
    q = of.plan.trajectory(np.linspace(0.0, of.plan.trajectory.duration, POSES))[0]
    poses = arm_points(of.task.model, q)

    def draw(figure: Any) -> None:
        axes = _space(figure)
        arms = [axes.plot(*pose.T, color=LIGHT['arm'], linewidth=1.2, marker='o', markersize=2.0,
                          label='arm') for pose in poses]
        path = axes.plot(*s.tip.T, color=LIGHT['tip'], linewidth=2.2, label='tip')
        _equal_scales(axes)
        via = _via_points(axes, of.task.via_points)
        drawing.legend(figure, [path[0], arms[0][0], via], 3)

    return Picture(name, title, caption, draw, 4.3, {
        'time [s]': s.t, **{f'tip {a} [m]': s.tip[:, i] for i, a in enumerate('xyz')}})


def paths_in_space(plans: Sequence[Planned], name: str, title: str, caption: str) -> Picture:
    """
    Return the figure of the tip's paths of several planners.

    Parameters
    ----------
    plans : sequence of Planned
        At least one, all of the same via points.
    name, title, caption : str
        See `Picture`.

    Returns
    -------
    Picture
        In three dimensions.

    """
    tips = [sampled(p.task.model, p.plan.trajectory).tip for p in plans]

    def draw(figure: Any) -> None:
        axes = _space(figure)
        lines = [axes.plot(*tip.T, color=SERIES[i % len(SERIES)], linewidth=1.5,
                           linestyle=DASHES[i % len(DASHES)], label=p.planner_id)[0]
                 for i, (p, tip) in enumerate(zip(plans, tips))]
        _equal_scales(axes)
        via = _via_points(axes, plans[0].task.via_points)
        drawing.legend(figure, [*lines, via], 2)

    return Picture(name, title, caption, draw, 4.0 + 0.17 * ((len(plans) + 2) // 2))


def magnified_zone(of: Planned, zone: int, name: str, title: str, caption: str) -> Picture:
    """
    Return the figure of a path near a via point, in the plane of its zone (figure 6.13).

    Parameters
    ----------
    of : Planned
        A motion along a path of the tip.
    zone : int
        Index of the curved zone; the index of its via point is one more.
    name, title, caption : str
        See `Picture`; radius and deviation are added to the caption.

    Returns
    -------
    Picture
        Path, polyline and the ends of the zone, relative to the via point.

    """
    trajectory = of.plan.trajectory
    assert isinstance(trajectory, PathTrajectory)
    path = trajectory.arm_path.path
    ends, radius = path.zone_ends[zone], float(path.radii[zone])
    half = MAGNIFIED * max(float(np.ptp(ends)) / 2.0, MIN_EXTENT)
    near = path.via_s[zone + 1]
    places = np.linspace(max(near - half, 0.0), min(near + half, path.length), POINTS)

    def in_plane(points: Array) -> Array:
        away = points - path.points[zone + 1]
        return np.stack((away @ path.tangent[zone], away @ path.normal[zone]), axis=1)

    line, at_ends = in_plane(path(places)[0]), in_plane(path(ends)[0])
    polyline = in_plane(path.points[zone:zone + 3])

    curved = (places >= ends[0]) & (places <= ends[1])

    def draw(figure: Any) -> None:
        axes = figure.subplots()
        _zone(axes, line, curved, at_ends, polyline)
        drawing.legend(figure, axes.get_legend_handles_labels()[0], 4)

    text = (f'{caption} Least radius {radius:.3f} m; the path leaves the polyline by at most '
            f'{1e3 * float(np.max(path.deviation)):.1f} mm.')
    return Picture(name, title, text, draw, 3.0, {
        'length along the path [m]': places, 'tangent [m]': line[:, 0], 'normal [m]': line[:, 1]})


def _zone(axes: Any, line: Array, curved: BoolArray, ends: Array, polyline: Array) -> None:
    """Draw a path in the plane of its zone, with the via point as origin [m]."""
    axes.plot(*polyline.T * 1e3, color=LIGHT['limit'], linestyle='--', linewidth=1.0,
              label='polyline')
    axes.plot(*line.T * 1e3, color=LIGHT['tip'], linewidth=1.6, label='line')
    axes.plot(*line[curved].T * 1e3, color=LIGHT['joint-1'], linewidth=2.4, label='zone')
    axes.plot(*ends.T * 1e3, 'o', color=LIGHT['joint-1'], markersize=4)
    axes.plot(0.0, 0.0, 'o', color=LIGHT['via'], markeredgecolor=LIGHT['ink'], markersize=6,
              label='via point')
    axes.set(xlabel='along the tangent [mm]', ylabel='along the normal [mm]',
             xlim=_padded(1e3 * line[:, 0]), ylim=_padded(1e3 * line[:, 1]))
    axes.set_aspect('equal', adjustable='box')


def _padded(values: Array) -> tuple[float, float]:
    padding = 0.06 * float(np.ptp(values))
    return float(values.min()) - padding, float(values.max()) + padding


def _via_points(axes: Any, points: Array) -> Any:
    """Draw via points with their indices; call it after the view is set."""
    projected = projection(axes, points)
    offsets = LABEL_DISTANCE * label_directions(projected)
    places = axes.transData.transform(projected) * POINTS_PER_INCH / axes.figure.dpi + offsets
    for i in legible(places):
        axes.annotate(str(i), projected[i], offsets[i], textcoords='offset points',
                      ha='center', va='center', zorder=10)
    size = next(size for most, size in MARKS if len(points) <= most)
    return axes.plot(*points.T, 'o', color=LIGHT['via'], markeredgecolor=LIGHT['ink'],
                     markersize=size, markeredgewidth=size / 5.0, label='via point', zorder=9)[0]


def legible(places: Array) -> list[int]:
    """
    Return the indices of labels that can be shown without overlap.

    Parameters
    ----------
    places : ndarray, shape (n, 2)
        Centres of the labels [points].

    Returns
    -------
    list of int
        The first, the last, and every k-th in between that overlaps none of the others.

    """
    stride = -(-len(places) // MAX_LABELS)
    found: list[int] = []
    for i in dict.fromkeys((0, len(places) - 1, *range(0, len(places), stride))):
        if (np.abs(places[i] - places[found]) > LABEL_SIZE).any(axis=1).all():
            found.append(i)
    return found


def label_directions(projected: Array) -> Array:
    """
    Return the direction of each point's label: away from the nearest other point.

    Parameters
    ----------
    projected : ndarray, shape (n, 2)
        Projected points.

    Returns
    -------
    ndarray, shape (n, 2)
        Unit vectors; to the upper right if another point is at the same place.

    """
    found = np.full(projected.shape, np.sqrt(0.5))
    for i, point in enumerate(projected):
        direction = away_from_nearest(point, np.delete(projected, i, axis=0))
        found[i] = found[i] if direction is None else direction
    return found


def projection(axes: Any, points: Array) -> Array:
    """
    Return where points in space appear in the picture.

    Parameters
    ----------
    axes : Axes3D
        The axes, with the view set.
    points : ndarray, shape (n, 3)
        The points.

    Returns
    -------
    ndarray, shape (n, 2)
        In the axes' data coordinates.

    """
    x, y, _ = proj3d.proj_transform(*points.T, axes.get_proj())
    return np.column_stack((x, y))


def away_from_nearest(point: Array, others: Array) -> Array | None:
    """
    Return the direction from the nearest other point to a point.

    Parameters
    ----------
    point : ndarray, shape (2,)
        The point.
    others : ndarray, shape (n, 2)
        The other points.

    Returns
    -------
    ndarray, shape (2,), or None
        Unit vector; None if there is no other point, or one at the same place.

    """
    away = point - others
    distance = np.linalg.norm(away, axis=1)
    if not len(others) or distance.min() == 0.0:
        return None
    return np.asarray(away[distance.argmin()] / distance.min())


def _equal_scales(axes: Any) -> None:
    """Set the view: equal scales, and space for the labels."""
    limits = (axes.get_xlim(), axes.get_ylim(), axes.get_zlim())
    axes.set_box_aspect([np.ptp(ends) for ends in limits], zoom=ZOOM)


def _space(figure: Any) -> Any:
    """Return axes in three dimensions that fill a figure up to its legend."""
    figure.set_layout_engine('none')
    axes = figure.add_axes((0.02, 0.02, 0.93, 0.98), projection='3d')
    axes.set(xlabel='x [m]', ylabel='y [m]', zlabel='z [m]')
    axes.view_init(elev=24.0, azim=-62.0)
    for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
        axis.set_major_locator(MaxNLocator(4))
        axis.set_pane_color((1.0, 1.0, 1.0, 0.0))
        axis.line.set_color(LIGHT['muted'])
        axis._axinfo['grid'].update(color=LIGHT['grid'], linewidth=0.6)
    axes.tick_params(pad=0, labelsize=8)
    return axes
