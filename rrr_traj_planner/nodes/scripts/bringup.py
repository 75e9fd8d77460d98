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

"""The script `bringup`: all nodes together; if one ends, the others are ended."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
import sys

from rrr_traj_planner.nodes.process.entry import (
    add_limits_option,
    limits_arguments,
    parse,
    run_script,
)
from rrr_traj_planner.nodes.process.processes import exit_message, NodeProcesses
from rrr_traj_planner.nodes.process.signals import defer_signals

DESCRIPTION = 'Run the trajectory planner, the simulated arm and the motion server, until Ctrl-C.'
NODES = ('planner', 'simulated_arm', 'motion_server')
THESIS_ARM = 'thesis_arm.yaml'


def main(arguments: Sequence[str] | None = None) -> int:
    """
    Run the nodes until SIGINT or SIGTERM, or until one of them ends.

    Parameters
    ----------
    arguments : sequence of str, optional
        The command line without the script's name; None: `sys.argv`'s.

    Returns
    -------
    int
        Exit code: 0 after a signal, else that of the node that ended.

    """
    def work() -> int:
        options, ros_arguments = parse('bringup', DESCRIPTION, arguments, _add_options)
        return _run(options, ros_arguments)

    return run_script('bringup', work)


def _add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        '--arm', metavar='FILE',
        help="parameters of the nodes: a file, or one of the package's config/ or config/arms/ "
             f'(default: {THESIS_ARM}, none with a parameter robot_description)')
    add_limits_option(parser)


def _run(options: argparse.Namespace, ros_arguments: list[str]) -> int:
    from rrr_traj_planner.nodes.parameters.configuration_files import found_file
    from rrr_traj_planner.nodes.parameters.ros_arguments import describes_an_arm

    own = [*ros_arguments, *limits_arguments(options.joint_limits)]
    name = options.arm or (None if describes_an_arm(ros_arguments) else THESIS_ARM)
    nodes = NodeProcesses(NODES, node_arguments(name and found_file(name, Path.cwd()), own))
    defer_signals()
    with nodes:
        ended = nodes.wait()
    if ended is None:
        return 0
    name, code = ended
    print(f'bringup: {exit_message(name, code)}', file=sys.stderr)
    return code if code >= 0 else 128 - code


def node_arguments(parameters: Path | None, ros_arguments: Sequence[str]) -> list[str]:
    """
    Return the ROS arguments of the nodes.

    Parameters
    ----------
    parameters : Path, optional
        The arm's parameter file.
    ros_arguments : sequence of str
        The user's own arguments, which take precedence over the file.

    Returns
    -------
    list of str
        The arguments in the order in which ROS reads them.

    """
    own = [a for a in ros_arguments if a not in ('--ros-args', '--')]
    file = [] if parameters is None else ['--params-file', str(parameters)]
    return ['--ros-args', *file, *own]


if __name__ == '__main__':
    raise SystemExit(main())
