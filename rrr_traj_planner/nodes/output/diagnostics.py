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

"""Diagnostics message of a node: one status with the same keys each time, for tools that plot."""

from __future__ import annotations

from collections.abc import Iterable

from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue

PERIOD = 1.0  # s, of steady time


def diagnostics(name: str, level: bytes, text: str, values: Iterable[tuple[str, str]],
                stamp: Time) -> DiagnosticArray:
    """
    Return one status as a message.

    Parameters
    ----------
    name : str
        Name of the status: the node's name and the part of it.
    level : bytes
        `DiagnosticStatus.OK`, `WARN` or `ERROR`.
    text : str
        Summary.
    values : iterable of (str, str)
        Keys and values.
    stamp : Time
        Present time.

    Returns
    -------
    DiagnosticArray
        The message.

    """
    message = DiagnosticArray(status=[DiagnosticStatus(
        level=level, name=name, message=text,
        values=[KeyValue(key=key, value=value) for key, value in values])])
    message.header.stamp = stamp
    return message
