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

"""Cooperative cancellation: a callback polled in every loop, and the interrupted step's name."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TypeAlias

from rrr_traj_planner.core.errors import TimeLimitError

# Polled in every loop. True: return the best feasible result so far, or continue only until the
# first one exists. Exceptions that it raises abort planning.
ShouldStop: TypeAlias = Callable[[], bool]


def never() -> bool:
    """Return False: do not stop."""
    return False


def until_found(should_stop: ShouldStop) -> ShouldStop:
    """
    Return a callback for the search of a first feasible result, which is not to end without one.

    Parameters
    ----------
    should_stop : callable
        For the whole time.

    Returns
    -------
    callable
        It raises as the given one does, and otherwise returns False.

    """
    def goes_on() -> bool:
        should_stop()
        return False

    return goes_on


@contextmanager
def step(name: str) -> Iterator[None]:
    """
    Add the name of the current step to a `TimeLimitError`.

    Parameters
    ----------
    name : str
        What is done meanwhile; of nested steps the innermost is named.

    Raises
    ------
    TimeLimitError
        With the name.

    """
    try:
        yield
    except TimeLimitError as error:
        if not error.step:
            raise TimeLimitError(error.limit, error.elapsed, name) from None
        raise
