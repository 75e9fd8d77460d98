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

"""Detection of angles given in degrees: far out of bounds, within them once converted."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

HINT = ' (in degrees?)'  # appended to an error or a warning


def explained_by_degrees(sent: ArrayLike, low: float, high: float) -> bool:
    """
    Return whether values out of bounds are probably degrees.

    Parameters
    ----------
    sent : array_like, shape (n,) or ()
        The values as received.
    low, high : float
        Their bounds [rad, or rad/s, ...].

    Returns
    -------
    bool
        True if one of them is far out of bounds, and all are within them once converted.

    """
    # Nearer than this to their bounds, values are not suspected to be degrees; chosen.
    numbers, far = np.asarray(sent, dtype=float), high - low
    as_degrees = np.radians(numbers)
    return bool(((numbers < low - far) | (numbers > high + far)).any()
                and ((as_degrees >= low) & (as_degrees <= high)).all())
