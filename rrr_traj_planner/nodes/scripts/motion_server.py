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

"""The script `motion_server`: plans motions and has a controller run them, as one ROS action."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from rrr_traj_planner.nodes.process.node_runner import run_node

if TYPE_CHECKING:
    from rrr_traj_planner.nodes.motion_server.node import MotionServer

DESCRIPTION = """\
Move the arm through via points by one call: plan from where it is, at rest or moving, and have a
trajectory controller run the plan. A new goal takes over in motion.

  action      move_through (rrr_traj_planner_interfaces/action/MoveThrough)
  uses        plan_trajectory (service of the script planner)
              CONTROLLER_NAME/follow_joint_trajectory (action of any trajectory controller)
  subscribes  joint_states, CONTROLLER_NAME/controller_state
  parameters  controller_name (default: simulated_arm), and others in config/thesis_arm.yaml"""


def main(arguments: Sequence[str] | None = None) -> int:
    """
    Run the motion server until SIGINT or SIGTERM.

    Parameters
    ----------
    arguments : sequence of str, optional
        The command line without the script's name; None: `sys.argv`'s.

    Returns
    -------
    int
        Exit code.

    """
    return run_node('motion_server', DESCRIPTION, _load, arguments)


def _load() -> type[MotionServer]:
    from rrr_traj_planner.nodes.motion_server.node import MotionServer
    return MotionServer


if __name__ == '__main__':
    raise SystemExit(main())
