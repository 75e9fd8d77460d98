"""
How every node script starts and ends.

`--help` is answered before ROS is touched; a start that fails says why in one line and ends with
exit code 1; SIGINT and SIGTERM end the script with exit code 0, from its first lines on.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
import os
import signal
import sys
from types import FrameType
from typing import Any
import warnings

from rrr_traj_planner.core.errors import RrrPlannerError

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


SIGNALS = (signal.SIGINT, signal.SIGTERM)
WATCH_PERIOD = 0.25  # s


class StartError(RrrPlannerError):
    """A script that cannot start: its text is all that a user needs."""


class Interrupt:
    """
    The handler of SIGINT and SIGTERM: Ctrl-C for both, until ROS takes over.

    rclpy's own handlers shut its context down, which ends a spin in order, and call this one
    afterwards. An exception would then hit whatever code is running, destructors included.
    """

    raises = True

    def __call__(self, number: int, frame: FrameType | None) -> None:
        """Interrupt the script, if that is still wanted."""
        if self.raises:
            raise KeyboardInterrupt


_interrupt = Interrupt()  # one for the process, as signals are


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


def run_node(name: str, description: str, load: Callable[[], Callable[[], Any]],
             arguments: Sequence[str] | None = None) -> int:
    """
    Run one node until it is told to end.

    Parameters
    ----------
    name, description : str
        The script and what it does.
    load : callable
        Imports the node's module and returns its class; called when `--help` is out of the way.
    arguments : sequence of str, optional
        The command line without the script's name; None: `sys.argv`'s.

    Returns
    -------
    int
        Exit code: 0 after SIGINT or SIGTERM, 1 after a start that failed.

    """
    return guarded(name, lambda: spin(load, parse(name, description, arguments)[1]))


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
    # The planners' matrices are small: more threads only wait for each other. Told before NumPy
    # is loaded, and to the children too.
    os.environ.setdefault('OPENBLAS_NUM_THREADS', '1')
    try:
        _interrupt.raises = True
        for number in SIGNALS:
            signal.signal(number, _interrupt)
        signal.pthread_sigmask(signal.SIG_UNBLOCK, SIGNALS)  # see processes.py
        return work()
    except KeyboardInterrupt:
        ignore_signals()  # nothing is left to be ended
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
    print(f'{name}: {text}', file=sys.stderr)
    return 1


def spin(load: Callable[[], Callable[[], Any]], ros_arguments: list[str]) -> int:
    """
    Start ROS and a node, spin until the context is shut down, and clean up.

    Parameters
    ----------
    load : callable
        Imports the node's module and returns its class.
    ros_arguments : list of str
        As from `parse`.

    Returns
    -------
    int
        Exit code.

    """
    import rclpy
    from rclpy.clock import Clock, ClockType
    from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
    from rclpy.impl.implementation_singleton import rclpy_implementation

    make_node = load()
    executor = node = None
    try:
        start_ros(ros_arguments)
        executor = SingleThreadedExecutor()
        node = made(make_node)
        # A signal wakes the executor before it shuts the context down: on a busy machine the
        # executor may find the context well and go to sleep for good. So it looks again.
        node.create_timer(WATCH_PERIOD, lambda: None, clock=Clock(
            clock_type=ClockType.STEADY_TIME))
        executor.add_node(node)
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    except rclpy_implementation.RCLError:
        if rclpy.ok():  # else the context was shut down under a callback, by SIGTERM
            raise
    finally:
        _clean_up(executor, node)
    return 0


def start_ros(ros_arguments: list[str]) -> None:
    """
    Start ROS; from then on SIGINT and SIGTERM shut its context down and raise nothing.

    Parameters
    ----------
    ros_arguments : list of str
        As from `parse`.

    Raises
    ------
    StartError
        If an argument or a parameter file is wrong.

    """
    import rclpy
    try:
        rclpy.init(args=ros_arguments)
        _interrupt.raises = False
    except Exception as error:
        raise StartError(f'ROS refuses to start: {_one_line(error)}') from error


def end_ros() -> None:
    """End ROS; from then on SIGINT and SIGTERM interrupt the script again."""
    import rclpy
    rclpy.try_shutdown()
    _interrupt.raises = True


def ignore_signals() -> None:
    """Let no further SIGINT or SIGTERM disturb the end of the process."""
    for number in SIGNALS:
        signal.signal(number, signal.SIG_IGN)


def made(make_node: Callable[[], Any]) -> Any:
    """
    Make a node; names and parameter files that ROS refuses are the user's to read.

    Parameters
    ----------
    make_node : callable
        Its class.

    Returns
    -------
    Node
        The node.

    Raises
    ------
    StartError
        If ROS refuses.

    """
    import rclpy
    from rclpy.exceptions import NameValidationException, ParameterException
    from rclpy.impl.implementation_singleton import rclpy_implementation
    try:
        return make_node()
    except (ParameterException, NameValidationException, rclpy_implementation.RCLError) as error:
        if not rclpy.ok():  # shut down meanwhile: no fault of the node
            raise
        raise StartError(_one_line(error)) from error


def _clean_up(executor: Any, node: Any) -> None:
    """End what was started, also when a second signal comes meanwhile."""
    import rclpy
    ignore_signals()
    # What a signal has kept the executor from starting is no news.
    warnings.filterwarnings('ignore', 'coroutine .* was never awaited', RuntimeWarning)
    if executor is not None:
        executor.shutdown(timeout_sec=1.0)
    if node is not None:
        node.destroy_node()
    rclpy.try_shutdown()


def _one_line(error: BaseException) -> str:
    return ' '.join(str(error).split())
