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
Start and end of every script: command line, error messages, exit code.

`--help` works without ROS; a start that fails prints the reason in one line and exits with code 1;
SIGINT and SIGTERM end the script with exit code 0 from its first lines on. This module imports
little, so that it handles signals early.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
import json
import os
from pathlib import Path
import sys

from rrr_traj_planner.core.errors import RrrPlannerError
from rrr_traj_planner.nodes.process.signals import end_at_signals, end_if_signalled

NO_ROS = (
    'ROS 2 is not in this environment ({error}): source /opt/ros/jazzy/setup.bash and the '
    "workspace's install/setup.bash, or scripts/env.bash of this repository")

NO_INTERFACES = (
    'the package rrr_traj_planner_interfaces is not built: colcon builds it with this one at the '
    "repository's root, or in a workspace after "
    '`cd src && ln -s rrr_traj_planner/rrr_traj_planner_interfaces . && cd .. && colcon build`')

MESSAGES = ('control_msgs', 'tf2_msgs')  # not in every installation of ROS
NO_MESSAGES = (
    "ROS's package {} is not installed: call `rosdep install --from-paths src -yi` in the "
    'workspace, or `make setup` in this repository')

EPILOG = (
    'ROS arguments follow --ros-args, as in '
    '--ros-args --params-file FILE -p NAME:=VALUE -r FROM:=TO')


class StartError(RrrPlannerError):
    """A script that cannot start: its message is printed without a traceback."""


def parse(name: str, description: str, arguments: Sequence[str] | None,
          add_options: Callable[[argparse.ArgumentParser], None] | None = None,
          ) -> tuple[argparse.Namespace, list[str]]:
    """
    Parse a script's options, and separate the arguments for ROS.

    Parameters
    ----------
    name, description : str
        The script's name and description, for `--help`.
    arguments : sequence of str, optional
        The command line without the script's name; None: `sys.argv`'s.
    add_options : callable, optional
        Adds the script's own options to the parser.

    Returns
    -------
    options : argparse.Namespace
        The script's options.
    ros_arguments : list of str
        From each `--ros-args` up to `--` or the end, for `rclpy.init`.

    """
    own, ros = split_ros_arguments(sys.argv[1:] if arguments is None else arguments)
    parser = argparse.ArgumentParser(
        prog=name, description=description, epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter)
    if add_options is not None:
        add_options(parser)
    return parser.parse_args(own), ros


def add_limits_option(parser: argparse.ArgumentParser) -> None:
    """
    Add the option `--joint-limits`.

    Parameters
    ----------
    parser : argparse.ArgumentParser
        The script's.

    """
    parser.add_argument(
        '--joint-limits', metavar='FILE', help='a MoveIt joint_limits.yaml, as parameter '
        "joint_limits_file: limits that the parameters do not give, in place of the URDF's")


def limits_arguments(file: str | None) -> list[str]:
    """
    Return the arguments for ROS that stand for the option `--joint-limits`.

    Parameters
    ----------
    file : str, optional
        The option's value.

    Returns
    -------
    list of str
        Empty without the option.

    Raises
    ------
    InvalidInputError
        If there is no such file.

    """
    if file is None:
        return []
    from rrr_traj_planner.nodes.parameters.configuration_files import found_file
    path = json.dumps(str(found_file(file, Path.cwd())), ensure_ascii=False)
    return ['--ros-args', '-p', f'joint_limits_file:={path}', '--']


def split_ros_arguments(arguments: Sequence[str]) -> tuple[list[str], list[str]]:
    """
    Split a command line into the script's arguments and those for ROS.

    Parameters
    ----------
    arguments : sequence of str
        A command line without the script's name.

    Returns
    -------
    tuple of two lists of str
        The script's, and those for ROS: from each `--ros-args` up to `--` or the end.

    """
    own: list[str] = []
    ros: list[str] = []
    to_ros = False
    for argument in arguments:
        to_ros = to_ros or argument == '--ros-args'
        (ros if to_ros else own).append(argument)
        to_ros = to_ros and argument != '--'
    return own, ros


def run_script(name: str, work: Callable[[], int]) -> int:
    """
    Run a script's main function and return the exit code.

    Parameters
    ----------
    name : str
        The script's name, for error messages.
    work : callable
        The main function; returns an exit code.

    Returns
    -------
    int
        The main function's code; 0 after SIGINT or SIGTERM; 1 after an error that concerns the
        user, whose message is printed on stderr. Other exceptions are bugs and are not caught.

    """
    end_at_signals()
    # The planners' matrices are too small for several threads. Set before NumPy is imported, and
    # inherited by child processes.
    os.environ.setdefault('OPENBLAS_NUM_THREADS', '1')
    try:
        return work()
    except KeyboardInterrupt:
        return 0
    except RrrPlannerError as error:
        text = str(error)
    except ImportError as error:
        missing = (error.name or '').partition('.')[0]
        if missing == 'rrr_traj_planner_interfaces':
            text = NO_INTERFACES
        elif missing in MESSAGES:
            text = NO_MESSAGES.format(missing)
        elif missing in ('rclpy', 'rcl_interfaces'):
            text = NO_ROS.format(error=error)
        else:
            raise
    finally:
        end_if_signalled()
    print(f'{name}: {text}', file=sys.stderr)
    return 1
