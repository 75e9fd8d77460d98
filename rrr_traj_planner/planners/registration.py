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

"""How a planner registers under its id: the methods import this, `registry` imports them."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from rrr_traj_planner.core.kinematics.travel_time import THROUGH, ViaPointBehaviour
from rrr_traj_planner.core.trajectory.trajectory import Trajectory
from rrr_traj_planner.planners.tasks import CartesianTask, JointTask

JointPlanner = Callable[[JointTask], Trajectory]
CartesianPlanner = Callable[[CartesianTask], Trajectory]


class Registered(NamedTuple):
    """A planner, of motions in joint space or along a path of the tip, and its capabilities."""

    plan: JointPlanner | None
    some_durations: bool = False  # whether durations may be prescribed for some segments only
    plan_path: CartesianPlanner | None = None
    misses_via_points: bool = False  # whether it blends around via points instead of reaching them
    passing: ViaPointBehaviour = THROUGH  # at via points, for the choice of whole turns
    needs_acceleration_limit: bool = True  # of a joint that has an effort limit too
    starts_moving: bool = False  # whether a motion may start from any state, else from rest


REGISTERED: dict[str, Registered] = {}  # by id


def register(planner_id: str, some_durations: bool = False,
             misses_via_points: bool = False, passing: ViaPointBehaviour = THROUGH,
             needs_acceleration_limit: bool = True, starts_moving: bool = False,
             ) -> Callable[[JointPlanner], JointPlanner]:
    """
    Return a decorator that makes a function the planner of an id.

    Parameters
    ----------
    planner_id : str
        The id, as requests name it.
    some_durations : bool
        Whether it accepts durations that are NaN, for segments that are free.
    misses_via_points : bool
        Whether it blends around via points between the first and the last; the plan's note then
        has the distances.
    passing : ViaPointBehaviour
        How it passes via points, for the estimate of time by which whole turns are chosen.
    needs_acceleration_limit : bool
        Whether every joint needs an acceleration limit; else an effort limit does as well.
    starts_moving : bool
        Whether a motion may start from any state; else it starts from rest.

    Returns
    -------
    callable
        Returns the function unchanged.

    """
    def remember(planner: JointPlanner) -> JointPlanner:
        REGISTERED[planner_id] = Registered(
            planner, some_durations, misses_via_points=misses_via_points, passing=passing,
            needs_acceleration_limit=needs_acceleration_limit, starts_moving=starts_moving)
        return planner

    return remember


def register_path(planner_id: str) -> Callable[[CartesianPlanner], CartesianPlanner]:
    """
    Return a decorator that makes a function the planner of Cartesian paths of an id.

    Along a path an effort limit does as well as an acceleration limit.

    Parameters
    ----------
    planner_id : str
        The id, as requests name it.

    Returns
    -------
    callable
        Returns the function unchanged.

    """
    def remember(planner: CartesianPlanner) -> CartesianPlanner:
        REGISTERED[planner_id] = Registered(
            None, plan_path=planner, needs_acceleration_limit=False)
        return planner

    return remember
