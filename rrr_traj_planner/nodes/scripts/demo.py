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

"""The script `demo`: plans through via points, moves the simulated arm, compares the two."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
import sys

from rrr_traj_planner.nodes.process.entry import (
    add_limits_option,
    limits_arguments,
    parse,
    run_script,
)

DESCRIPTION = """\
Plan a motion through the via points of a file, run it on the simulated arm and show the figures.

Starts the planner and the arm, calls the planner's service, sends its answer to the arm, and
compares the requested, planned and executed motion. The exit code is 0 only if every figure is
inside its bound."""

UNKNOWN_FRICTION = (
    "demo: the joints have friction: friction.known_to_controller: true lets the arm's controller "
    'make up for it')


FRAMES = ['--ros-args', '-p', 'publish_tf:=true', '--']  # for who looks at the recording


def main(arguments: Sequence[str] | None = None) -> int:
    """
    Run the demonstration.

    Parameters
    ----------
    arguments : sequence of str, optional
        The command line without the script's name; None: `sys.argv`'s.

    Returns
    -------
    int
        Exit code: 0 if every figure is inside its bound, 1 if not, or if a step failed.

    """
    def work() -> int:
        options, ros_arguments = parse('demo', DESCRIPTION, arguments, _add_options)
        return _run(options, ros_arguments)

    return run_script('demo', work)


def _add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument('task', nargs='?', default='table_6_1.yaml', metavar='FILE',
                        help="via points: a file, or one of the package's config/ or "
                             'config/arms/ (default: %(default)s)')
    parser.add_argument('--planner', default='', metavar='ID',
                        help="planner id (default: the file's)")
    parser.add_argument('--plot', type=Path, metavar='PNG',
                        help='file of the plot (default: demo_TASK.png); "" for none; folders '
                             'that do not exist are made')
    parser.add_argument('--record', type=Path, metavar='MCAP',
                        help='record all topics in this new file, a ROS 2 bag; folders that do '
                             'not exist are made')
    add_limits_option(parser)


def _run(options: argparse.Namespace, own_arguments: list[str]) -> int:
    from rrr_traj_planner.core.errors import counted
    from rrr_traj_planner.nodes.demo.bounds import bounds_text, checked_values
    from rrr_traj_planner.nodes.demo.client import Client
    from rrr_traj_planner.nodes.parameters.ros_arguments import describes_an_arm
    from rrr_traj_planner.nodes.point_files.reading import read_task
    from rrr_traj_planner.nodes.process.node_runner import spin_in_background
    from rrr_traj_planner.nodes.process.processes import NodeProcesses
    from rrr_traj_planner.nodes.recording.bag import Bag
    from rrr_traj_planner.nodes.runs.table import table
    from rrr_traj_planner.nodes.scripts.bringup import node_arguments

    frames = [] if options.record is None else FRAMES
    ros_arguments = [*frames, *own_arguments, *limits_arguments(options.joint_limits)]
    task = read_task(options.task)
    task = replace(task, planner_id=options.planner or task.planner_id)
    with ExitStack() as stack:
        client = stack.enter_context(spin_in_background(Client, ros_arguments))
        client.check_free()
        bag = None if options.record is None else stack.enter_context(Bag(options.record))
        arm = None if describes_an_arm(ros_arguments) else task.arm
        nodes = stack.enter_context(NodeProcesses(
            ('planner', 'simulated_arm'), node_arguments(arm, ros_arguments)))
        run = client.run(task, nodes.ended, bag)
    found = checked_values(run)
    print(f'{table(run)}\n\n{bounds_text(found)}', flush=True)
    if bag is not None:
        print(f'recording: {bag.file}, {counted(bag.count, "message")}', flush=True)
    plot = Path(f'demo_{task.name}.png') if options.plot is None else options.plot
    if str(plot) not in ('', '.'):
        _plot(run, plot)
    exceeded = [value for value in found if not value.within_bound]
    for value in exceeded:
        print(f'demo: out of bounds: {value.text}', file=sys.stderr)
    if exceeded and not run.config.model.friction.is_none:
        print(UNKNOWN_FRICTION, file=sys.stderr)
    return 1 if exceeded else 0


def _plot(run: object, file: Path) -> None:
    try:
        from rrr_traj_planner.nodes.demo.plot import draw
    except ImportError as error:
        print(f'demo: no plot, matplotlib is missing ({error})', file=sys.stderr)
        return
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        draw(run, file)  # type: ignore[arg-type]
    except (OSError, ValueError) as error:  # ValueError: an unknown suffix
        print(f'demo: no plot: {error}', file=sys.stderr)
        return
    print(f'plot: {file}')


if __name__ == '__main__':
    raise SystemExit(main())
