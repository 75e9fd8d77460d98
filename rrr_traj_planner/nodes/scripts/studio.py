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

"""The script `studio`: a page in the browser: drag via points, see the plan, run it."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import replace
from typing import Any, TYPE_CHECKING

from rrr_traj_planner.nodes.process.entry import (
    add_limits_option,
    limits_arguments,
    parse,
    run_script,
    StartError,
)

if TYPE_CHECKING:
    from rrr_traj_planner.nodes.studio.ros_client import StudioClient
    from rrr_traj_planner.nodes.studio.studio import Studio
    from rrr_traj_planner.nodes.studio.tasks import Start

DESCRIPTION = """\
Show a page in the browser, on which via points are dragged with the mouse, and the motion through
them is planned at once and run on the simulated arm.

Starts the planner, the arm and the motion server, and prints the page's address. SIGINT (Ctrl-C)
ends all. With --controller, a real arm is moved in place of the simulated one, after a question:

  uses        CONTROLLER/follow_joint_trajectory (control_msgs/action/FollowJointTrajectory)
  subscribes  joint_states, CONTROLLER/controller_state"""

NO_VISER = (
    'the page needs the Python package viser, which is not installed: call `make studio`, or '
    "pip install viser (the package's extra 'studio')")

NODES = ('planner', 'simulated_arm', 'motion_server')
NODES_WITHOUT_ARM = ('planner', 'motion_server')
PORT, HIGHEST_PORT = 8080, 65535
FRAME_PERIOD = 0.04  # s between two pictures of the arm


def main(arguments: Sequence[str] | None = None) -> int:
    """
    Show the page until SIGINT or SIGTERM.

    Parameters
    ----------
    arguments : sequence of str, optional
        The command line without the script's name; None: `sys.argv`'s.

    Returns
    -------
    int
        Exit code: 0 after a signal, 1 if it cannot start, or if a node has ended.

    """
    def work() -> int:
        options, ros_arguments = parse('studio', DESCRIPTION, arguments, _add_options)
        return _run(options, ros_arguments)

    return run_script('studio', work)


def _add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument('task', nargs='?', default='table_6_1.yaml', metavar='FILE',
                        help="via points: a file, or one of the package's config/ or "
                             'config/arms/ (default: %(default)s)')
    parser.add_argument('--host', default='127.0.0.1', metavar='ADDRESS',
                        help='address to listen at (default: %(default)s, this machine only); '
                             'everyone who can reach it can move the arm')
    parser.add_argument('--port', type=_port, default=PORT, metavar='N',
                        help='port (default: %(default)s); the next free one if it is in use')
    parser.add_argument('--controller', default='', metavar='NAME',
                        help='move a real arm, by this controller, such as /arm_controller; no '
                             'arm is simulated (default: the simulated arm)')
    add_limits_option(parser)


def _port(text: str) -> int:
    """Return a port of the command line."""
    if not text.isdecimal() or int(text) > HIGHEST_PORT:
        raise argparse.ArgumentTypeError(f'{text!r}, must be 0 to {HIGHEST_PORT}')
    return int(text)


def _run(options: argparse.Namespace, own_arguments: list[str]) -> int:
    _check_viser()
    from rrr_traj_planner.nodes.point_files.reading import read_task
    from rrr_traj_planner.nodes.runs.spun_node import pause
    from rrr_traj_planner.nodes.studio.page import show_wait
    from rrr_traj_planner.nodes.studio.tasks import another_start, first_start, started_again
    from rrr_traj_planner.nodes.studio.web.server import address, serving

    ros_arguments = [*own_arguments, *limits_arguments(options.joint_limits)]
    start, before = first_start(read_task(options.task), ros_arguments), None
    with serving(options.host, options.port) as server:
        print_address = True
        while True:  # until a signal, by KeyboardInterrupt
            with ExitStack() as stack:
                try:
                    client, studio = _started(stack, server, options.controller, start)
                except StartError as error:
                    if before is None:
                        raise
                    start, before = started_again(before, start, str(error)), None
                    continue
                if print_address:
                    port = server.get_port()
                    taken = f'port {options.port} is in use; ' * (options.port not in (0, port))
                    print(f'studio: {address(options.host, port)}  ({taken}Ctrl-C ends)',
                          flush=True)
                    print_address = False
                while studio.tasks.next is None:
                    client.check_processes()
                    pause()
                before = replace(start, wanted=studio.editor.wanted)
            start = another_start(studio.tasks.next, before)
            show_wait(server, start.task.name)


def _started(stack: ExitStack, server: Any, controller: str, start: Start
             ) -> tuple[StudioClient, Studio]:
    """Start nodes, and show the page of their arm; all ends with a stack of contexts."""
    from functools import partial

    from rrr_traj_planner.nodes.parameters.ros_arguments import description_folder
    from rrr_traj_planner.nodes.process.node_runner import spin_in_background
    from rrr_traj_planner.nodes.process.processes import NodeProcesses
    from rrr_traj_planner.nodes.scripts.bringup import node_arguments
    from rrr_traj_planner.nodes.studio.page import Page
    from rrr_traj_planner.nodes.studio.ros_client import StudioClient
    from rrr_traj_planner.nodes.studio.studio import Studio
    from rrr_traj_planner.planners.registry import planner_ids

    client = stack.enter_context(spin_in_background(
        partial(StudioClient, controller), start.ros_arguments))
    arguments = node_arguments(start.arm, start.ros_arguments)
    nodes = stack.enter_context(NodeProcesses(*_nodes(client.controller, arguments)))
    config = client.connect(nodes.ended)
    wanted = start.first_wanted(config, client.payload)
    page = Page(server, config, description_folder(arguments), planner_ids(), wanted)
    studio = Studio(client, config, wanted, page, start.arm)
    stack.callback(page.disconnect)
    page.connect(studio, client.post)
    client.in_executor(lambda: studio.start(start.error))
    client.in_executor(lambda: client.create_timer(FRAME_PERIOD, studio.tick))
    return client, studio


def _nodes(controller: str, ros_arguments: list[str]) -> tuple[Sequence[str], list[str]]:
    """Return the nodes to start and their arguments; no arm for the controller of a real one."""
    if not controller:
        return NODES, ros_arguments
    return NODES_WITHOUT_ARM, [
        *ros_arguments, '-p', f'motion_server:controller_name:={controller}']


def _check_viser() -> None:
    """Refuse to start without viser, before anything else is started."""
    from importlib.util import find_spec
    if find_spec('viser') is None:
        raise StartError(NO_VISER)


if __name__ == '__main__':
    raise SystemExit(main())
