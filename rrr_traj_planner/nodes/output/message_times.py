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

"""Times and durations of messages as numbers."""

from __future__ import annotations

from builtin_interfaces.msg import Duration, Time
from rrr_traj_planner.core.nanoseconds import SECOND


def nanoseconds(time: Time | Duration) -> int:
    """
    Return a time or duration message in whole nanoseconds.

    Parameters
    ----------
    time : Time or Duration
        The message.

    Returns
    -------
    int
        Nanoseconds.

    """
    return int(time.sec) * SECOND + int(time.nanosec)


def seconds(time: Time | Duration) -> float:
    """
    Return a time or duration message in seconds.

    Parameters
    ----------
    time : Time or Duration
        The message.

    Returns
    -------
    float
        Seconds, rounded to a float.

    """
    return float(time.sec + 1e-9 * time.nanosec)
