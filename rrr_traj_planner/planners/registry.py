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

"""The registry of planners by id; it imports every module of `methods`."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from importlib import import_module
from pkgutil import iter_modules
from typing import NamedTuple

from rrr_traj_planner.core.errors import InvalidInputError, quoted
from rrr_traj_planner.core.kinematics.travel_time import THROUGH, ViaPointBehaviour
from rrr_traj_planner.core.trajectory.trajectory import Trajectory
import rrr_traj_planner.planners.methods
from rrr_traj_planner.planners.request import CartesianTask, JointTask

JointPlanner = Callable[[JointTask], Trajectory]
CartesianPlanner = Callable[[CartesianTask], Trajectory]


class Registered(NamedTuple):
    """A planner, of motions in joint space or along a path of the tip, and its capabilities."""

    plan: JointPlanner | None
    some_durations: bool = False  # whether durations may be prescribed for some segments only
    plan_path: CartesianPlanner | None = None
    misses_via_points: bool = False  # whether it blends around via points instead of reaching them
    passing: ViaPointBehaviour = THROUGH  # at via points, for the choice of whole turns


_planners: dict[str, Registered] = {}


def register(planner_id: str, some_durations: bool = False,
             misses_via_points: bool = False,
             passing: ViaPointBehaviour = THROUGH) -> Callable[[JointPlanner], JointPlanner]:
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

    Returns
    -------
    callable
        Returns the function unchanged.

    """
    def remember(planner: JointPlanner) -> JointPlanner:
        _planners[planner_id] = Registered(
            planner, some_durations, misses_via_points=misses_via_points, passing=passing)
        return planner

    return remember


def register_path(planner_id: str) -> Callable[[CartesianPlanner], CartesianPlanner]:
    """
    Return a decorator that makes a function the planner of Cartesian paths of an id.

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
        _planners[planner_id] = Registered(None, plan_path=planner)
        return planner

    return remember


def planner_ids() -> list[str]:
    """Return every known id, sorted."""
    _import_planners()
    return sorted(_planners)


@cache
def _import_planners() -> None:
    for module in iter_modules(rrr_traj_planner.planners.methods.__path__):
        import_module(f'rrr_traj_planner.planners.methods.{module.name}')


def planner(planner_id: str) -> Registered:
    """
    Return the planner of an id.

    Parameters
    ----------
    planner_id : str
        The id.

    Returns
    -------
    Registered
        The planner.

    Raises
    ------
    InvalidInputError
        If there is none; the message lists the known ones.

    """
    known = planner_ids()
    if planner_id not in _planners:
        raise InvalidInputError(
            f"planner_id {quoted(planner_id)} is unknown, known are {', '.join(known)}")
    return _planners[planner_id]
