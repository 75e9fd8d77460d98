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

"""
Lock on a node's name among the processes of this machine.

DDS discovery takes up to three seconds to find a running node. A socket in Linux's
abstract namespace is visible at once, is local to the machine, and disappears with its process.
"""

from __future__ import annotations

from errno import EADDRINUSE
import socket


def claim(domain: int, name: str) -> socket.socket | None:
    """
    Claim a node's name.

    Parameters
    ----------
    domain : int
        ROS domain id.
    name : str
        The node's fully qualified name.

    Returns
    -------
    socket or None
        The lock, to be closed when the node ends; None if another process holds it.

    """
    held = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
    try:
        held.bind(_address(domain, name))
    except OSError as error:
        held.close()
        if error.errno != EADDRINUSE:
            raise
        return None
    return held


def is_claimed(domain: int, name: str) -> bool:
    """
    Return whether a node of this package with a given name runs on this machine.

    Parameters
    ----------
    domain : int
        ROS domain id.
    name : str
        The node's fully qualified name.

    Returns
    -------
    bool
        Whether a process holds the lock.

    """
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as probe:
        return probe.connect_ex(_address(domain, name)) == 0


def _address(domain: int, name: str) -> str:
    return f'\0rrr_traj_planner/{domain}{name}'
