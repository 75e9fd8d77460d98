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

"""SIGINT and SIGTERM: they interrupt a script, until ROS takes over or all is about to end."""

from __future__ import annotations

import signal
from types import FrameType

SIGNALS = (signal.SIGINT, signal.SIGTERM)


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


def interrupt_on_signals() -> None:
    """Let both signals interrupt the script, also where they have been held back so far."""
    interrupt_again()
    for number in SIGNALS:
        signal.signal(number, _interrupt)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, SIGNALS)  # see processes.py


def interrupt_again() -> None:
    """Let both signals interrupt the script: ROS answers them no longer."""
    _interrupt.raises = True


def interrupt_no_longer() -> None:
    """Raise nothing at either signal: ROS answers them."""
    _interrupt.raises = False


def ignore_signals() -> None:
    """Let no further SIGINT or SIGTERM disturb the end of the process."""
    for number in SIGNALS:
        signal.signal(number, signal.SIG_IGN)
