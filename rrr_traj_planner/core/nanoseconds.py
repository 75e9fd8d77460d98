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

"""Whole nanoseconds: how clocks, messages and joint_trajectory_controller count time."""

from __future__ import annotations

SECOND = 1_000_000_000  # ns


def nanoseconds(seconds: float) -> int:
    """
    Return a time in whole nanoseconds.

    Parameters
    ----------
    seconds : float
        Finite [s].

    Returns
    -------
    int
        The nearest [ns]; exact for a whole number of them up to 20 days.

    """
    return round(seconds * SECOND)
