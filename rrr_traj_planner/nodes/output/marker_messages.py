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
Markers for RViz: the arm and its tip's past path, the via points and path of a plan.

Namespaces and ids are fixed, so that each message replaces the markers of the one before. The
header's stamp is 0, so that RViz shows markers of any age, such as those of latched topics.
"""

from __future__ import annotations

from collections.abc import Iterable

from geometry_msgs.msg import Point, Pose, Quaternion, Vector3
import numpy as np
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arm.urdf import COLOURS, RADIUS
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.trajectory.trajectory_points import TrajectoryPoints
from rrr_traj_planner.nodes.output.wireframe import picked, Rod, rod
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import Marker, MarkerArray

ARM, EXECUTED, PLANNED, VIA_POINTS = 'arm', 'executed_path', 'planned_path', 'via_points'

# The colours of the demo's plot (Okabe and Ito's), which colour-blind people can distinguish.
BLUE, RED, GREEN = (0.0, 0.45, 0.7, 1.0), (0.84, 0.37, 0.0, 1.0), (0.0, 0.62, 0.45, 1.0)

# Width of lines and diameter of via points, as fractions of the arm's size.
LINE_WIDTH, BALL = 1.0 / 320.0, 1.0 / 64.0

MAX_POINTS = 1000  # largest number of via points drawn; RViz becomes slow with more

VIA_TIME_ROUNDING = 1e-9  # s, rounding of times


def arm_markers(model: RobotModel, frame: str, joints: Iterable[tuple[float, float, float]],
                trail: Iterable[tuple[float, float, float]]) -> MarkerArray:
    """
    Return the markers of the arm and of its tip's past path.

    Parameters
    ----------
    model : RobotModel
        Its size scales the markers.
    frame : str
        The base frame.
    joints : iterable of points
        Base, joints and tip, as `link_positions` returns them [m].
    trail : iterable of points
        Past tip positions, oldest first [m].

    Returns
    -------
    MarkerArray
        A rod from each point to the next, balls at the joints, a line.

    """
    points = list(joints)
    size = model.chain.size
    markers = [_rod_marker(frame, i, rod(*ends), 2.0 * RADIUS * size)
               for i, ends in enumerate(zip(points, points[1:]))]
    balls = _marker(frame, ARM, len(markers), Marker.SPHERE_LIST, COLOURS['dark'],
                    (2.8 * RADIUS * size,) * 3)
    balls.points = [point(*p) for p in points[1:-1]]
    # The trail's last point may be up to a step behind the tip.
    line = _line(frame, EXECUTED, GREEN, [point(*p) for p in (*trail, points[-1])], size)
    return MarkerArray(markers=[*markers, balls, line])


def plan_markers(points: TrajectoryPoints, via_times: Array, model: RobotModel,
                 frame: str) -> MarkerArray:
    """
    Return the markers of a plan's path and via points.

    Parameters
    ----------
    points : TrajectoryPoints
        The plan's points.
    via_times : ndarray
        Times of the via points [s]; `points` has a point at each.
    model : RobotModel
        The arm.
    frame : str
        The base frame.

    Returns
    -------
    MarkerArray
        At most `MAX_POINTS` balls, and a line of at most twice as many points.

    """
    some = picked(len(via_times), MAX_POINTS)
    via = np.searchsorted(points.times, via_times[some] - VIA_TIME_ROUNDING).clip(
        max=len(points.times) - 1)
    shown = picked(len(points.times), MAX_POINTS, via)
    path, passed = (_points(forward_kinematics(model, points.positions[i]))
                    for i in (shown, via))
    balls = _marker(frame, VIA_POINTS, 0, Marker.SPHERE_LIST, RED, (BALL * model.chain.size,) * 3)
    balls.points = passed
    return MarkerArray(markers=[_line(frame, PLANNED, BLUE, path, model.chain.size), balls])


def no_plan_markers(frame: str) -> MarkerArray:
    """
    Return a message that deletes the markers of a plan.

    Parameters
    ----------
    frame : str
        The base frame.

    Returns
    -------
    MarkerArray
        Deletes these two markers only: DELETEALL would delete other nodes' markers too.

    """
    markers = MarkerArray(markers=[Marker(ns=ns, action=Marker.DELETE)
                                   for ns in (PLANNED, VIA_POINTS)])
    for marker in markers.markers:
        marker.header.frame_id = frame
    return markers


def point(x: float, y: float, z: float) -> Point:
    """
    Return a point message.

    Parameters
    ----------
    x, y, z : float
        Coordinates [m].

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
    if shape.length == 0.0:  # RViz warns of markers without size
        marker.action = Marker.DELETE
    return marker


def _line(frame: str, namespace: str, colour: tuple[float, ...], points: list[Point],
          size: float) -> Marker:
    marker = _marker(frame, namespace, 0, Marker.LINE_STRIP, colour,
                     (LINE_WIDTH * size, 0.0, 0.0))
    if len(points) < 2:  # not a line
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
