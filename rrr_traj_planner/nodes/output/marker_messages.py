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

"""
Markers for RViz: the arm and where its tip has been, a plan's via points and path.

A marker's namespace and id are fixed, so that each message replaces what an earlier one showed.
The header's stamp is 0: markers that are kept for late subscribers stay good as they age.
"""

from __future__ import annotations

from collections.abc import Iterable

from geometry_msgs.msg import Point, Pose, Quaternion, Vector3
import numpy as np
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arm.urdf import COLOURS, RADIUS
from rrr_traj_planner.core.arm.wireframe import picked, Rod, rod
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.trajectory.interpolation import TrajectoryPoints
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import Marker, MarkerArray

ARM, EXECUTED, PLANNED, VIA_POINTS = 'arm', 'executed_path', 'planned_path', 'via_points'
RODS, JOINTS = (0, 1, 2), 3  # ids in the namespace of the arm

# Told apart by colour-blind eyes: the colours of the demonstration's plot.
BLUE, RED, GREEN = (0.0, 0.45, 0.7, 1.0), (0.84, 0.37, 0.0, 1.0), (0.0, 0.62, 0.45, 1.0)

# Sizes are parts of the arm's reach: of lines and of balls at via points.
LINE_WIDTH, BALL = 1.0 / 320.0, 1.0 / 64.0

# A plan may have any number of points; so many of its path, and of its via points, are drawn.
MOST_POINTS = 1000

SAME_TIME = 1e-9  # s, to which points meet via points


def arm_markers(model: RobotModel, frame: str, joints: Iterable[tuple[float, float, float]],
                trail: Iterable[tuple[float, float, float]]) -> MarkerArray:
    """
    Return the arm as it is, and where its tip has been.

    Parameters
    ----------
    model : RobotModel
        For the size of what is drawn.
    frame : str
        The base frame.
    joints : iterable of 4 points
        Base, shoulder, elbow and tip [m].
    trail : iterable of points
        The tip's places until now, from the oldest on [m].

    Returns
    -------
    MarkerArray
        Three rods, balls at the joints, a line.

    """
    points = list(joints)
    reach = model.reach[1]
    markers = [_rod_marker(frame, i, rod(*points[i:i + 2]), 2.0 * RADIUS * reach) for i in RODS]
    balls = _marker(frame, ARM, JOINTS, Marker.SPHERE_LIST, COLOURS['dark'],
                    (2.8 * RADIUS * reach,) * 3)
    balls.points = [point(*p) for p in points[1:3]]
    # The last place may be up to a step back.
    line = _line(frame, EXECUTED, GREEN, [point(*p) for p in (*trail, points[-1])], reach)
    return MarkerArray(markers=[*markers, balls, line])


def plan_markers(points: TrajectoryPoints, via_times: Array, model: RobotModel,
                 frame: str) -> MarkerArray:
    """
    Return the path of a plan, and its via points.

    Parameters
    ----------
    points : TrajectoryPoints
        The plan's.
    via_times : ndarray
        When each via point is passed [s]; there is a point at each of these times.
    model : RobotModel
        The arm.
    frame : str
        The base frame.

    Returns
    -------
    MarkerArray
        Balls, at most `MOST_POINTS`, and a line of at most twice as many points.

    """
    some = picked(len(via_times), MOST_POINTS)
    via = np.searchsorted(points.times, via_times[some] - SAME_TIME).clip(
        max=len(points.times) - 1)
    shown = picked(len(points.times), MOST_POINTS, via)
    path, passed = (_points(forward_kinematics(model, points.positions[i]))
                    for i in (shown, via))
    balls = _marker(frame, VIA_POINTS, 0, Marker.SPHERE_LIST, RED, (BALL * model.reach[1],) * 3)
    balls.points = passed
    return MarkerArray(markers=[_line(frame, PLANNED, BLUE, path, model.reach[1]), balls])


def no_plan_markers(frame: str) -> MarkerArray:
    """
    Return what takes the markers of a plan away.

    Parameters
    ----------
    frame : str
        The base frame.

    Returns
    -------
    MarkerArray
        Nothing else is taken away: DELETEALL would clear other nodes' markers too.

    """
    markers = MarkerArray(markers=[Marker(ns=ns, action=Marker.DELETE)
                                   for ns in (PLANNED, VIA_POINTS)])
    for marker in markers.markers:
        marker.header.frame_id = frame
    return markers


def point(x: float, y: float, z: float) -> Point:
    """
    Return a point's message.

    Parameters
    ----------
    x, y, z : float
        [m].

    Returns
    -------
    Point
        The message.

    """
    return Point(x=float(x), y=float(y), z=float(z))


def _points(positions: Array) -> list[Point]:
    return [point(*p) for p in positions.tolist()]


def _rod_marker(frame: str, number: int, shape: Rod, thickness: float) -> Marker:
    marker = _marker(frame, ARM, number, Marker.CYLINDER, COLOURS['light'],
                     (thickness, thickness, shape.length))
    x, y, z, w = shape.quaternion
    marker.pose = Pose(position=point(*shape.centre), orientation=Quaternion(x=x, y=y, z=z, w=w))
    if shape.length == 0.0:  # RViz complains of what has no size
        marker.action = Marker.DELETE
    return marker


def _line(frame: str, namespace: str, colour: tuple[float, ...], points: list[Point],
          reach: float) -> Marker:
    marker = _marker(frame, namespace, 0, Marker.LINE_STRIP, colour,
                     (LINE_WIDTH * reach, 0.0, 0.0))
    if len(points) < 2:  # no line yet, or no longer
        marker.action = Marker.DELETE
    else:
        marker.points = points
    return marker


def _marker(frame: str, namespace: str, number: int, kind: int, colour: tuple[float, ...],
            scale: tuple[float, ...]) -> Marker:
    r, g, b, a = colour
    x, y, z = scale
    marker = Marker(ns=namespace, id=number, type=kind, action=Marker.ADD,
                    scale=Vector3(x=x, y=y, z=z), color=ColorRGBA(r=r, g=g, b=b, a=a))
    marker.header.frame_id = frame
    return marker
