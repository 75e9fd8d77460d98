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

"""The registry of planners by id: it imports every module of `methods`."""

from __future__ import annotations

from functools import cache
from importlib import import_module
from pkgutil import iter_modules

from rrr_traj_planner.core.errors import InvalidInputError, quoted
from rrr_traj_planner.planners import registration
import rrr_traj_planner.planners.methods


def planner_ids() -> list[str]:
    """Return every known id, sorted."""
    _import_planners()
    return sorted(registration.REGISTERED)


@cache
def _import_planners() -> None:
    for module in iter_modules(rrr_traj_planner.planners.methods.__path__):
        import_module(f'rrr_traj_planner.planners.methods.{module.name}')


def planner(planner_id: str) -> registration.Registered:
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
    if planner_id not in registration.REGISTERED:
        raise InvalidInputError(
            f"planner_id {quoted(planner_id)} is unknown, known are {', '.join(known)}")
    return registration.REGISTERED[planner_id]
