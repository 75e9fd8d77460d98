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

"""Values whose arrays nobody can write to: what every value type of the core is made of."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np


class ReadOnlyArrays:
    """
    Base of values whose arrays, those in tuples too, nobody can write to.

    NumPy's arrays forget that they are read-only where they are pickled or deeply copied; those
    of such a value do not.
    """

    def __post_init__(self) -> None:
        """Make the arrays read-only; for dataclasses that have nothing to check."""
        make_read_only(vars(self).values())

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Take what was pickled or copied."""
        vars(self).update(state)
        make_read_only(state.values())


def make_read_only(values: Iterable[Any]) -> None:
    """
    Make arrays read-only.

    Parameters
    ----------
    values : iterable
        Arrays, tuples of arrays, and what else there is, which is left alone.

    """
    for value in values:
        if isinstance(value, np.ndarray):
            value.setflags(write=False)
        elif isinstance(value, tuple):
            make_read_only(value)
