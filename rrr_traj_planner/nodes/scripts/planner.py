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

"""The script `planner`: the trajectory planner on a ROS service."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from rrr_traj_planner.nodes.process.node_runner import run_node

if TYPE_CHECKING:
    from rrr_traj_planner.nodes.planner_node.node import TrajectoryPlanner

DESCRIPTION = """\
Plan motions of the arm's tip through via points, within the limits of joints and motors.

  serves      plan_trajectory (rrr_traj_planner_interfaces/srv/PlanTrajectory)
  publishes   planned_trajectory (trajectory_msgs/JointTrajectory), planned_path (nav_msgs/Path),
              diagnostics (diagnostic_msgs/DiagnosticArray)
              markers (visualization_msgs/MarkerArray)
  parameters  config/thesis_arm.yaml lists them all"""


def main(arguments: Sequence[str] | None = None) -> int:
    """
    Run the planner until SIGINT or SIGTERM.

    Parameters
    ----------
    arguments : sequence of str, optional
        The command line without the script's name; None: `sys.argv`'s.

    Returns
    -------
    int
        Exit code.

    """
    return run_node('planner', DESCRIPTION, _load, arguments)


def _load() -> type[TrajectoryPlanner]:
    from rrr_traj_planner.nodes.planner_node.node import TrajectoryPlanner
    from rrr_traj_planner.planners.registry import planner_ids
    planner_ids()  # imports the planners now: once ROS has started, signals would wait for that
    return TrajectoryPlanner


if __name__ == '__main__':
    raise SystemExit(main())
