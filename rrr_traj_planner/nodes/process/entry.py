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
How every script begins and ends: its arguments, what goes wrong, its exit code.

`--help` is answered before ROS is touched; a start that fails says why in one line and ends with
exit code 1; SIGINT and SIGTERM end the script with exit code 0, from its first lines on. What is
imported here is light, so that those lines come early.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
import os
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

EPILOG = (
    'ROS arguments follow --ros-args, as in '
    '--ros-args --params-file FILE -p NAME:=VALUE -r FROM:=TO')


class StartError(RrrPlannerError):
    """A script that cannot start: its text is all that a user needs."""


def parse(name: str, description: str, arguments: Sequence[str] | None,
          add_options: Callable[[argparse.ArgumentParser], None] | None = None,
          ) -> tuple[argparse.Namespace, list[str]]:
    """
    Answer `--help` and wrong options, and set aside what is for ROS.

    Parameters
    ----------
    name, description : str
        The script and what it does.
    arguments : sequence of str, optional
        The command line without the script's name; None: `sys.argv`'s.
    add_options : callable, optional
        Adds a script's own options to the parser.

    Returns
    -------
    options : argparse.Namespace
        The script's own.
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


def split_ros_arguments(arguments: Sequence[str]) -> tuple[list[str], list[str]]:
    """
    Return the arguments of a script and those of ROS.

    Parameters
    ----------
    arguments : sequence of str
        A command line without the script's name.

    Returns
    -------
    tuple of two lists of str
        ROS's own begin with `--ros-args` and end with `--` or the line's end.

    """
    own: list[str] = []
    ros: list[str] = []
    to_ros = False
    for argument in arguments:
        to_ros = to_ros or argument == '--ros-args'
        (ros if to_ros else own).append(argument)
        to_ros = to_ros and argument != '--'
    return own, ros


def guarded(name: str, work: Callable[[], int]) -> int:
    """
    Run a script's work; turn its end, whichever way, into an exit code.

    Parameters
    ----------
    name : str
        The script, named before an error's text.
    work : callable
        Returns an exit code.

    Returns
    -------
    int
        The work's; 0 after SIGINT or SIGTERM; 1, and one line on stderr, after an error that
        has a text for users. Other exceptions are bugs and pass.

    """
    end_at_signals()
    # The planners' matrices are small: more threads only wait for each other. Told before NumPy
    # is loaded, and to the children too.
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
        elif missing in ('rclpy', 'rcl_interfaces'):
            text = NO_ROS.format(error=error)
        else:
            raise
    finally:
        end_if_signalled()
    print(f'{name}: {text}', file=sys.stderr)
    return 1
