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

"""Base of value types with read-only arrays."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np


class ReadOnlyArrays:
    """
    Base of value types with read-only arrays, also in tuples.

    NumPy drops the flag on pickling and deepcopy; here it is restored.
    """

    def __post_init__(self) -> None:
        """Make the arrays read-only; for dataclasses that have nothing to check."""
        make_read_only(vars(self).values())

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Restore what was pickled or copied."""
        vars(self).update(state)
        make_read_only(state.values())


def make_read_only(values: Iterable[Any]) -> None:
    """
    Make arrays read-only.

    Parameters
    ----------
    values : iterable
        Arrays and tuples of arrays; other values are ignored.

    """
    for value in values:
        if isinstance(value, np.ndarray):
            value.setflags(write=False)
        elif isinstance(value, tuple):
            make_read_only(value)
