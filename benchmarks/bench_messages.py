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

"""How long a plan takes to become a JointTrajectory message, beside other ways of filling it."""

from __future__ import annotations

import argparse
from array import array
from collections.abc import Callable
from copy import copy

from measuring import in_turns, REPETITIONS, Row, setting, table, timed
import numpy as np
from ros_processes import MISSING
from rrr_traj_planner.core.trajectory.trajectory_points import TrajectoryPoints
from rrr_traj_planner.planners.planning import plan
from tasks import ARM, gentle, WEAK
from tasks import table as thesis_table

if not MISSING:
    from builtin_interfaces.msg import Duration
    from plan_and_echo import default_config
    from rclpy.serialization import deserialize_message, serialize_message
    from rrr_traj_planner.nodes.planner_node.planning_answer import joint_trajectory
    from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

POINTS = 5000
SECOND = 1_000_000_000  # ns
TARGET = 1.0            # of every way that rclpy allows


def rows(repetitions: int = REPETITIONS) -> list[Row]:
    """Return our time over that of each alternative; all make the same message."""
    if MISSING:
        print(MISSING, flush=True)
        return []
    points = _points()
    config = default_config()
    wire = serialize_message(joint_trajectory(points, config))
    ways: dict[str, tuple[Callable[[], JointTrajectory], float | None]] = {
        'fields set to rows of NumPy': (lambda: _by_rows(points), TARGET),
        'fields set to lists': (lambda: _by_lists(points), TARGET),
        'points made with arguments': (lambda: _by_arguments(points), TARGET),
        'copies of an empty point': (lambda: _by_copies(points), TARGET),
        'deserialised, the bytes ready': (
            lambda: deserialize_message(wire, JointTrajectory), TARGET),
        'private fields, no constructor': (lambda: _by_private_fields(points), None)}
    for name, (way, _) in ways.items():
        if way().points != joint_trajectory(points, config).points:
            raise RuntimeError(f'{name}: another message')
    medians = in_turns(lambda: joint_trajectory(points, config),
                       *(way for way, _ in ways.values()), repetitions=repetitions)
    return [timed(f'message of {POINTS:,} points / {name}', target, medians, theirs=i)
            for i, (name, (_, target)) in enumerate(ways.items(), 1)]


def _points() -> TrajectoryPoints:
    """Return a plan's first points."""
    task = thesis_table('6.1', gentle(WEAK), '')
    found = plan(task.model, task.limits, task.request).trajectory
    times = np.round(np.linspace(0.0, found.duration, POINTS) * SECOND) / SECOND
    return TrajectoryPoints(times, *found(times)[:3])


def _message(filled: list[JointTrajectoryPoint]) -> JointTrajectory:
    message = JointTrajectory(joint_names=list(ARM.joint_names))
    message.points = filled
    return message


def _stamps(points: TrajectoryPoints) -> list[int]:
    return np.round(points.times * SECOND).astype(np.int64).tolist()


def _by_rows(points: TrajectoryPoints) -> JointTrajectory:
    filled = []
    for stamp, q, qd, qdd in zip(
            _stamps(points), points.positions, points.velocities, points.accelerations):
        point = JointTrajectoryPoint()
        point.positions, point.velocities, point.accelerations = q, qd, qdd
        point.time_from_start.sec, point.time_from_start.nanosec = divmod(stamp, SECOND)
        filled.append(point)
    return _message(filled)


def _by_lists(points: TrajectoryPoints) -> JointTrajectory:
    filled = []
    for stamp, q, qd, qdd in zip(_stamps(points), *(
            x.tolist() for x in (points.positions, points.velocities, points.accelerations))):
        point = JointTrajectoryPoint()
        point.positions, point.velocities, point.accelerations = q, qd, qdd
        point.time_from_start.sec, point.time_from_start.nanosec = divmod(stamp, SECOND)
        filled.append(point)
    return _message(filled)


def _by_arguments(points: TrajectoryPoints) -> JointTrajectory:
    filled = []
    for stamp, q, qd, qdd in zip(_stamps(points), *_slices(points)):
        sec, nanosec = divmod(stamp, SECOND)
        filled.append(JointTrajectoryPoint(
            positions=q, velocities=qd, accelerations=qdd,
            time_from_start=Duration(sec=sec, nanosec=nanosec)))
    return _message(filled)


def _by_copies(points: TrajectoryPoints) -> JointTrajectory:
    filled, empty, start = [], JointTrajectoryPoint(), Duration()
    for stamp, q, qd, qdd in zip(_stamps(points), *_slices(points)):
        point, since = copy(empty), copy(start)
        point.positions, point.velocities, point.accelerations = q, qd, qdd
        since.sec, since.nanosec = divmod(stamp, SECOND)
        point.time_from_start = since
        filled.append(point)
    return _message(filled)


def _by_private_fields(points: TrajectoryPoints) -> JointTrajectory:
    """Fill what the generated class keeps its fields in: fast, and promised by nobody."""
    filled, effort = [], array('d')
    for stamp, q, qd, qdd in zip(_stamps(points), *_slices(points)):
        point = JointTrajectoryPoint.__new__(JointTrajectoryPoint)
        point._check_fields, point._effort = False, effort
        point._positions, point._velocities, point._accelerations = q, qd, qdd
        stamped = point._time_from_start = Duration.__new__(Duration)
        stamped._check_fields = False
        stamped._sec, stamped._nanosec = divmod(stamp, SECOND)
        filled.append(point)
    return _message(filled)


def _slices(points: TrajectoryPoints) -> list[list[array]]:
    """Return each row as an array of Python's, cut from one."""
    flat = (array('d', np.ascontiguousarray(x).tobytes())
            for x in (points.positions, points.velocities, points.accelerations))
    return [[x[i:i + 3] for i in range(0, len(x), 3)] for x in flat]


def main() -> None:
    """Print every ratio."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--repetitions', type=int, default=REPETITIONS)
    found = rows(parser.parse_args().repetitions)
    print(setting())
    print(table(found))


if __name__ == '__main__':
    main()
