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

"""The script `move`: moves an arm through via points, by any trajectory controller."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import replace
from functools import partial
from pathlib import Path

from rrr_traj_planner.nodes.process.entry import parse, run_script, StartError

DESCRIPTION = """\
Move an arm from where it is through the via points of a file: call the planner, have a trajectory
controller run its answer, and show what was planned and reached. SIGINT (Ctrl-C) stops the arm.

  uses        plan_trajectory (service of the script planner, which must run)
              CONTROLLER/follow_joint_trajectory (control_msgs/action/FollowJointTrajectory)
  subscribes  joint_states, CONTROLLER/controller_state

The exit code is 0 only if the controller has reported success, or after a signal."""
NO_TABLE = """\
The controller has reported success. What was reached is not known: no positions of all joints were
published meanwhile."""


def main(arguments: Sequence[str] | None = None) -> int:
    """
    Move an arm.

    Parameters
    ----------
    arguments : sequence of str, optional
        The command line without the script's name; None: `sys.argv`'s.

    Returns
    -------
    int
        Exit code: 0 if the motion has reached its end, 1 if not.

    """
    def work() -> int:
        options, ros_arguments = parse('move', DESCRIPTION, arguments, _add_options)
        return _run(options, ros_arguments)

    return run_script('move', work)


def _add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument('points', metavar='POINTS',
                        help="via points: a .yaml or .csv file, or one of the package's config/; "
                             'one via point is enough')
    parser.add_argument('--controller', default='simulated_arm', metavar='NAME',
                        help='the controller, such as /arm_controller (default: %(default)s)')
    parser.add_argument('--planner', default='', metavar='ID',
                        help="planner id (default: the file's, else the planner node's)")
    parser.add_argument('--dry-run', action='store_true',
                        help="print the planner's answer, and send nothing")
    parser.add_argument('--record', type=Path, metavar='MCAP',
                        help='record all topics in this new file, a ROS 2 bag; folders that do '
                             'not exist are made')


def _run(options: argparse.Namespace, ros_arguments: list[str]) -> int:
    from rrr_traj_planner.core.errors import counted
    from rrr_traj_planner.nodes.move.client import MoveClient
    from rrr_traj_planner.nodes.move.dry_run import answer_text
    from rrr_traj_planner.nodes.move.from_here import read_task_from_here
    from rrr_traj_planner.nodes.process.node_runner import spin_in_background
    from rrr_traj_planner.nodes.recording.bag import Bag
    from rrr_traj_planner.nodes.runs.answer import refused_text
    from rrr_traj_planner.nodes.runs.table import table

    if options.dry_run and options.record is not None:
        raise StartError('--record records a motion, and --dry-run has none: leave one out')
    task = read_task_from_here(options.points)
    task = replace(task, planner_id=options.planner or task.planner_id)
    with ExitStack() as stack:
        client = stack.enter_context(spin_in_background(
            partial(MoveClient, options.controller), ros_arguments))
        if options.dry_run:
            response, config = client.dry_run(task)
        else:
            bag = None if options.record is None else stack.enter_context(Bag(options.record))
            run = client.run(task, bag)
    if options.dry_run:
        print(answer_text(response, config), flush=True)
        if response.error_code != response.SUCCESS:
            raise StartError(refused_text(response))
        return 0
    print(NO_TABLE if run is None else table(run), flush=True)
    if bag is not None:
        print(f'recording: {bag.file}, {counted(bag.count, "message")}', flush=True)
    return 0


if __name__ == '__main__':
    raise SystemExit(main())
