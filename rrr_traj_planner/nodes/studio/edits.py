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

"""Changes of single via points: inserted, removed, exchanged; their stops, rests and times."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.nodes.studio.wanted import Wanted

FEWEST_POINTS = 2  # a motion begins at the first via point


def inserted(wanted: Wanted, index: int) -> Wanted:
    """
    Return the same with a via point more.

    Parameters
    ----------
    wanted : Wanted
        What is planned.
    index : int
        After which one: halfway to the next; after the last, halfway to the first.

    Returns
    -------
    Wanted
        The arm does not stop at the new one, unless it is the last; at the one that was the last
        it does only if it rests there.

    """
    points, count = wanted.points, len(wanted.points)
    is_last, new = index == count - 1, index + 1
    stops, dwell, durations = wanted.stops, wanted.rests, wanted.durations
    stops[-1] = not is_last
    if is_last:
        durations = np.append(durations, durations[-1])
    else:
        durations[index] *= 0.5
        durations = np.insert(durations, new, durations[index])
    joints = wanted.joints
    return _with(wanted, np.insert(points, new, 0.5 * (points[index] + points[new % count]), 0),
                 np.insert(stops, new, False), np.insert(dwell, new, 0.0), durations,
                 None if joints is None else np.insert(joints, new, np.nan, 0))


def removed(wanted: Wanted, index: int) -> Wanted:
    """
    Return the same without a via point.

    Parameters
    ----------
    wanted : Wanted
        What is planned.
    index : int
        Which one.

    Returns
    -------
    Wanted
        The same where only `FEWEST_POINTS` are left. The times of the segments on its sides are
        added.

    """
    count = len(wanted.points)
    if count <= FEWEST_POINTS:
        return wanted
    durations = wanted.durations
    if 0 < index < count - 1:
        durations[index] += durations[index - 1]
    joints = wanted.joints
    return _with(wanted, *(np.delete(rows, index, 0) for rows in (
        wanted.points, wanted.stops, wanted.rests)),
        np.delete(durations, max(index - 1, 0)),
        None if joints is None else np.delete(joints, index, 0))


def exchanged(wanted: Wanted, index: int, other: int) -> Wanted:
    """
    Return the same with two via points in one another's place.

    Parameters
    ----------
    wanted : Wanted
        What is planned.
    index, other : int
        Which ones; their stops and rests go with them, times of segments stay.

    Returns
    -------
    Wanted
        The same where one of them does not exist.

    """
    order = np.arange(len(wanted.points))
    if not (0 <= index < len(order) and 0 <= other < len(order)):
        return wanted
    order[[index, other]] = other, index
    stops, joints = wanted.stops, wanted.joints
    stops[-1] = order[-1] == len(order) - 1  # no longer the end
    return _with(wanted, wanted.points[order], stops[order], wanted.rests[order],
                 wanted.durations, None if joints is None else joints[order])


def with_stop(wanted: Wanted, index: int, stop: bool) -> Wanted:
    """
    Return the same with or without a stop.

    Parameters
    ----------
    wanted : Wanted
        What is planned.
    index : int
        At which via point.
    stop : bool
        Whether the arm stops there; if not, it does not rest there either.

    Returns
    -------
    Wanted
        The arm stops at the last in any case.

    """
    stops, dwell = wanted.stops, wanted.rests
    stops[index] = stop
    if not stop:
        dwell[index] = 0.0
    return _with(wanted, wanted.points, stops, dwell, wanted.durations, wanted.joints)


def with_dwell(wanted: Wanted, index: int, dwell: float) -> Wanted:
    """
    Return the same with another rest.

    Parameters
    ----------
    wanted : Wanted
        What is planned.
    index : int
        At which via point.
    dwell : float
        How long [s]; the arm stops there if it is not 0.

    Returns
    -------
    Wanted
        The same otherwise, and where there is no such via point.

    """
    if index >= len(wanted.points):
        return wanted
    rests = wanted.rests
    rests[index] = dwell
    return _with(wanted, wanted.points, wanted.stops, rests, wanted.durations,
                 wanted.joints)


def with_duration(wanted: Wanted, index: int, duration: float) -> Wanted:
    """
    Return the same with the time of a segment prescribed, or left to the planner.

    Parameters
    ----------
    wanted : Wanted
        What is planned.
    index : int
        Of the via point at the segment's end; nothing ends at the first.
    duration : float
        [s]; 0: as the planner chooses.

    Returns
    -------
    Wanted
        The same otherwise, and where there is no such via point.

    """
    if not 0 < index < len(wanted.points):
        return wanted
    durations = wanted.durations
    durations[index - 1] = duration if duration > 0.0 else np.nan
    return _with(wanted, wanted.points, wanted.stops, wanted.rests, durations,
                 wanted.joints)


def _with(wanted: Wanted, points: Array, stops: BoolArray, dwell: Array, durations: Array,
          joints: Array | None) -> Wanted:
    """Return other via points; stops, rests and durations are empty where there are none."""
    stops = stops | (dwell > 0.0)
    stops[-1] = True
    stops_between = bool(stops[:-1].any())
    return replace(wanted, joints=joints, task=replace(
        wanted.task, via_points=points,
        stop_at=stops if stops_between else stops[:0],
        dwell=dwell if (dwell > 0.0).any() else dwell[:0],
        segment_durations=durations if np.isfinite(durations).any() else durations[:0]))
