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

"""Runs a node: starts ROS, creates the node, spins, and cleans up."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
import gc
from threading import Event, Thread
from time import monotonic
from typing import Any
import warnings

from rrr_traj_planner.nodes.process.entry import (
    add_limits_option,
    limits_arguments,
    parse,
    run_script,
    StartError,
)
from rrr_traj_planner.nodes.process.signals import defer_signals, end_if_signalled, signal_arrived

AddOptions = Callable[[argparse.ArgumentParser], None]
Instead = Callable[[argparse.Namespace, list[str]], 'int | None']

WAKE_PERIOD = 0.25     # s, after which the executor checks for signals at the latest
FINISH_TIMEOUT = 0.5   # s in which clients may still ask for the results of goals that are aborted
DELIVERY_TIME = 0.1    # s for what has been sent to arrive, by DDS, before its writer is gone


def run_node(name: str, description: str, load: Callable[[], Callable[[], Any]],
             arguments: Sequence[str] | None = None, add_options: AddOptions | None = None,
             instead: Instead | None = None) -> int:
    """
    Run one node until SIGINT or SIGTERM.

    Parameters
    ----------
    name, description : str
        The script's name and description, for `--help`.
    load : callable
        Imports the node's module and returns its class; not called for `--help`.
    arguments : sequence of str, optional
        The command line without the script's name; None: `sys.argv`'s.
    add_options : callable, optional
        Adds options to the parser beside `--joint-limits`.
    instead : callable, optional
        Gets options and arguments for ROS; does what the options ask for in place of running the
        node, and returns the exit code; None: the node is to be run.

    Returns
    -------
    int
        Exit code: 0 after SIGINT or SIGTERM, 1 after a start that failed.

    """
    def add_all(parser: argparse.ArgumentParser) -> None:
        if add_options is not None:
            add_options(parser)
        add_limits_option(parser)

    def work() -> int:
        options, own = parse(name, description, arguments, add_all)
        ros_arguments = [*own, *limits_arguments(options.joint_limits)]
        code = None if instead is None else instead(options, ros_arguments)
        return spin(load, ros_arguments) if code is None else code

    return run_script(name, work)


def spin(load: Callable[[], Callable[[], Any]], ros_arguments: list[str]) -> int:
    """
    Start ROS and a node, spin until a signal arrives, let the node finish, and clean up.

    ROS is still there while the node finishes (`finish` of `ServiceNode`): rclpy's own handler
    would shut it down at once, and the client of an action would wait for a result for ever.

    Parameters
    ----------
    load : callable
        Imports the node's module and returns its class.
    ros_arguments : list of str
        From `entry.parse`.

    Returns
    -------
    int
        Exit code.

    """
    from rclpy.clock import Clock, ClockType
    from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor

    make_node = load()
    executor = node = None
    try:
        start_ros(ros_arguments)
        executor = SingleThreadedExecutor()
        node = create_node(make_node)
        # A signal does not wake the executor: the timer does.
        node.create_timer(WAKE_PERIOD, lambda: None, clock=Clock(
            clock_type=ClockType.STEADY_TIME))
        executor.add_node(node)
        while not signal_arrived():
            executor.spin_once()
        finish(executor, node)
    except ExternalShutdownException:
        pass
    finally:
        _clean_up(executor, node)
    return 0


def finish(executor: Any, node: Any) -> None:
    """
    Let a node end what it does for clients, and let what it has sent arrive.

    Parameters
    ----------
    executor : Executor
        Spins the node.
    node : ServiceNode
        The node, which is destroyed next: DDS then drops what has not arrived.

    """
    deadline = monotonic() + FINISH_TIMEOUT
    while not node.finish() and monotonic() < deadline:
        executor.spin_once(DELIVERY_TIME)
    deadline = monotonic() + DELIVERY_TIME
    while monotonic() < deadline:
        executor.spin_once(DELIVERY_TIME)


@contextmanager
def spin_in_background(make_node: Callable[[], Any], ros_arguments: list[str]) -> Iterator[Any]:
    """
    Start ROS and a node, spin it in a thread, and clean up at the end of the context.

    Parameters
    ----------
    make_node : callable
        The node's class.
    ros_arguments : list of str
        From `entry.parse`.

    Yields
    ------
    Node
        The node.

    Raises
    ------
    StartError
        If ROS or the node does not start.
    KeyboardInterrupt
        After SIGINT or SIGTERM, in place of any other exception of the body.

    """
    from rclpy.executors import SingleThreadedExecutor

    node = executor = thread = None
    closing = Event()
    try:
        start_ros(ros_arguments)
        node = create_node(make_node)
        executor = SingleThreadedExecutor()
        executor.add_node(node)
        thread = Thread(target=_spin_until, args=(closing, executor), daemon=True)
        thread.start()
        yield node
    except Exception:
        if not signal_arrived():  # else a consequence: the nodes get the signal too
            raise
        raise KeyboardInterrupt from None
    finally:
        closing.set()
        if executor is not None and thread is not None:
            executor.create_task(lambda: None)  # wakes it
            thread.join(1.0)  # an executor that is shut down while it spins may raise
        _clean_up(executor, node)
        end_if_signalled()


def _spin_until(closing: Event, executor: Any) -> None:
    import rclpy
    try:
        while rclpy.ok() and not closing.is_set():
            executor.spin_once()
    except Exception:
        if rclpy.ok():  # else somebody has shut ROS down, which the main thread finds
            raise


def start_ros(ros_arguments: list[str]) -> None:
    """
    Start ROS; from then on SIGINT and SIGTERM are recorded, and do not end the process.

    Parameters
    ----------
    ros_arguments : list of str
        From `entry.parse`.

    Raises
    ------
    StartError
        If an argument or a parameter file is wrong.

    """
    import rclpy
    from rclpy.signals import SignalHandlerOptions
    try:
        defer_signals()
        rclpy.init(args=ros_arguments, signal_handler_options=SignalHandlerOptions.NO)
    except Exception as error:
        raise StartError(f'ROS refuses to start: {_one_line(error)}') from error


def end_ros() -> None:
    """Shut ROS down, and end the process if a signal has arrived."""
    import rclpy
    rclpy.try_shutdown()
    end_if_signalled()


def create_node(make_node: Callable[[], Any]) -> Any:
    """
    Create a node; turn ROS's errors about names and parameters into messages for the user.

    Objects that exist by then are exempt from garbage collection: they live as long as the
    process, and searching them takes tens of milliseconds, during planning or a control step.

    Parameters
    ----------
    make_node : callable
        The node's class.

    Returns
    -------
    Node
        The node.

    Raises
    ------
    StartError
        If ROS refuses a name or a parameter.

    """
    from rclpy.exceptions import NameValidationException, ParameterException
    from rclpy.impl.implementation_singleton import rclpy_implementation
    try:
        node = make_node()
    except (ParameterException, NameValidationException, rclpy_implementation.RCLError) as error:
        raise StartError(_one_line(error)) from error
    gc.collect()
    gc.freeze()
    return node


def _clean_up(executor: Any, node: Any) -> None:
    """Shut down the executor, the node and ROS."""
    import rclpy
    # It is no error that the executor could not start a coroutine before a signal.
    warnings.filterwarnings('ignore', 'coroutine .* was never awaited', RuntimeWarning)
    if executor is not None:
        executor.shutdown(timeout_sec=1.0)
    if node is not None:
        node.destroy_node()
    rclpy.try_shutdown()


def _one_line(error: BaseException) -> str:
    return ' '.join(str(error).split())
