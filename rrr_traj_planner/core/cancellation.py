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

"""How work is given up: a callback that is asked in every loop, and the step that it ended in."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TypeAlias

from rrr_traj_planner.core.errors import TimeLimitError

# Asked in every loop. Once it answers True, the best that there is is the answer; where there is
# nothing yet, the least work that gives an answer goes on. What it raises ends the work.
ShouldStop: TypeAlias = Callable[[], bool]


def never() -> bool:
    """Return that there is no reason to stop."""
    return False


@contextmanager
def step(name: str) -> Iterator[None]:
    """
    Tell of a time limit that ends a step in which step it was.

    Parameters
    ----------
    name : str
        What is done meanwhile; of steps within steps the inner one is told.

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
