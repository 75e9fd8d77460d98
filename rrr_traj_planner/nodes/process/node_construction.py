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

"""Destruction of a node whose constructor fails."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from rclpy.node import Node


@contextmanager
def destroyed_on_error(node: Node) -> Iterator[None]:
    """
    Destroy a node if the body fails: other nodes would see it until Python's garbage collection.

    Parameters
    ----------
    node : Node
        The node; the constructor of `Node` must have returned.

    """
    try:
        yield
    except BaseException:
        Node.destroy_node(node)
        raise
