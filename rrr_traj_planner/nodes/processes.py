"""Both nodes as processes of their own: started, watched and ended together."""

from __future__ import annotations

from collections.abc import Sequence
import signal
import subprocess
import sys
from time import monotonic
from types import TracebackType

MODULES = {'planner': 'rrr_traj_planner.nodes.planner',
           'simulated_arm': 'rrr_traj_planner.nodes.simulated_arm'}

POLL_PERIOD = 0.1   # s
PATIENCE = 1.5      # s that a process is given to end by itself


class NodeProcesses:
    """
    The planner and the simulated arm; a context that ends them.

    Parameters
    ----------
    ros_arguments : sequence of str
        For both, as after `--ros-args`, that word included.

    """

    def __init__(self, ros_arguments: Sequence[str]) -> None:
        self._processes = {
            name: subprocess.Popen([sys.executable, '-m', module, *ros_arguments])
            for name, module in MODULES.items()}

    def __enter__(self) -> NodeProcesses:
        """Return itself; the processes run already."""
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None,
                 trace: TracebackType | None) -> None:
        """End both, whatever the reason."""
        self.stop()

    def ended(self) -> tuple[str, int] | None:
        """
        Return the process that has ended, if one has.

        Returns
        -------
        tuple of str and int, or None
            Its name and exit code.

        """
        for name, process in self._processes.items():
            if process.poll() is not None:
                return name, process.returncode
        return None

    def wait(self) -> tuple[str, int]:
        """
        Wait until one of them ends.

        Returns
        -------
        tuple of str and int
            Its name and exit code.

        """
        while True:
            for process in self._processes.values():
                try:
                    process.wait(POLL_PERIOD)
                except subprocess.TimeoutExpired:
                    continue
                ended = self.ended()
                if ended is not None:
                    return ended

    def stop(self) -> None:
        """End both: SIGINT, and SIGKILL for what does not heed it."""
        deadline = monotonic() + PATIENCE
        for process in self._processes.values():
            if process.poll() is None:
                process.send_signal(signal.SIGINT)
        for process in self._processes.values():
            try:
                process.wait(max(deadline - monotonic(), 0.0))
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
