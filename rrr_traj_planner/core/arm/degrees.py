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

"""Whether numbers that are far out of bounds would be within them as degrees."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

HINT = ' (in degrees?)'  # what an error or a warning then asks

# Numbers that miss their bounds by less than this many times the width between them are not taken
# for degrees.
NEAR = 1.0


def explained_by_degrees(sent: ArrayLike, low: float, high: float) -> bool:
    """
    Return whether degrees explain numbers that are out of bounds.

    Parameters
    ----------
    sent : array_like, shape (n,) or ()
        Numbers, as they were given.
    low, high : float
        Their bounds [rad, or rad/s, ...].

    Returns
    -------
    bool
        True if one of them is far from the bounds, and all are within them as degrees.

    """
    numbers, far = np.asarray(sent, dtype=float), NEAR * (high - low)
    as_degrees = np.radians(numbers)
    return bool(((numbers < low - far) | (numbers > high + far)).any()
                and ((as_degrees >= low) & (as_degrees <= high)).all())
