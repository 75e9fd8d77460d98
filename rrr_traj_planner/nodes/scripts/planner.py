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

import argparse
from collections.abc import Sequence
from pathlib import Path
import sys
from typing import TYPE_CHECKING

from rrr_traj_planner.nodes.process.node_runner import run_node
from rrr_traj_planner.planners.method_summaries import method_summaries

if TYPE_CHECKING:
    from rrr_traj_planner.nodes.planner_node.node import TrajectoryPlanner

DESCRIPTION = """\
Plan motions of the arm's tip through via points, within the limits of joints and motors.

  serves      plan_trajectory (rrr_traj_planner_interfaces/srv/PlanTrajectory)
  publishes   planned_trajectory (trajectory_msgs/JointTrajectory), planned_path (nav_msgs/Path),
              diagnostics (diagnostic_msgs/DiagnosticArray)
              markers (visualization_msgs/MarkerArray)
  parameters  config/thesis_arm.yaml lists them all
  planner_id
{planners}

--check starts nothing: it prints what a URDF was understood to say, and whether this arm can be
planned for; if not, the exit code is 1."""


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
    lines = [f'    {name:<20}{text}' for name, text in method_summaries().items()]
    description = DESCRIPTION.format(planners='\n'.join(lines))
    return run_node('planner', description, _load, arguments, _add_options, _instead)


def _add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument('--check', metavar='URDF',
                        help='print what a URDF is understood to say: a file, or one of the '
                             "package's config/arms/")
    parser.add_argument('--base-frame', metavar='LINK',
                        help='of --check: link at the base (default: base_link, else the root)')
    parser.add_argument('--tip-frame', metavar='LINK',
                        help='of --check: link at the tip (default: tip, else the only leaf)')


def _instead(options: argparse.Namespace, ros_arguments: list[str]) -> int | None:
    if options.check is not None:
        return _check(options, ros_arguments)
    for name in ('base_frame', 'tip_frame'):
        if getattr(options, name) is not None:
            print(f'planner: --{name.replace("_", "-")} goes with --check; the node has the '
                  f'parameter {name}', file=sys.stderr)
            return 2
    return None


def _check(options: argparse.Namespace, ros_arguments: list[str]) -> int:
    """Print what a URDF says, and the parameters beside it, without ROS."""
    from rrr_traj_planner.nodes.parameters.arm_source import arm_source, LIMITS, read, URDF
    from rrr_traj_planner.nodes.parameters.planner_config import config_of, merged
    from rrr_traj_planner.nodes.parameters.ros_arguments import parameters_in
    from rrr_traj_planner.planners.arm_summary import summary

    asked = {URDF: options.check, LIMITS: options.joint_limits, 'base_frame': options.base_frame,
             'tip_frame': options.tip_frame}
    asked = {name: value for name, value in asked.items() if value}
    given, folder_of = merged([*parameters_in(ros_arguments), (asked, Path.cwd())])
    warnings = arm_source(given, folder_of, {URDF: '--check'}).warnings
    config = config_of(given, folder_of)
    arm = read(config.urdf, config.base_frame, config.tip_frame)
    found = summary(arm, config.model, config.limits)
    print('\n'.join([f'{options.check}: {found[0]}', *found[1:]]))
    print('\n'.join(f'warning: {text}' for text in warnings), end='\n' if warnings else '')
    print('this arm can be planned for')
    return 0


def _load() -> type[TrajectoryPlanner]:
    from rrr_traj_planner.nodes.planner_node.node import TrajectoryPlanner
    from rrr_traj_planner.planners.registry import planner_ids
    planner_ids()  # imports the planners now: once ROS has started, signals would wait for that
    return TrajectoryPlanner


if __name__ == '__main__':
    raise SystemExit(main())
