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

"""Shape of the curved zones: tangent points and position of the via point."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple, TypeAlias

from rrr_traj_planner.core.arrays import Array, IntArray

# Half turn of a zone -> its tangent point (x along the tangent, y along the normal), for least
# radius 1.
ZoneEnds: TypeAlias = Callable[[Array], tuple[Array, Array]]


class ZoneKind(NamedTuple):
    """
    Shape of the curved zones: tangent points and position of the via point.

    Parameters
    ----------
    ends : callable
        Tangent points: where zones meet their lines.
    side : ndarray of int, shape (n - 2,), or int
        0: a zone's via point is in its middle. -1: at its end, so that the line after it begins at
        the via point; 1: at its beginning.

    """

    ends: ZoneEnds
    side: IntArray | int = 0
