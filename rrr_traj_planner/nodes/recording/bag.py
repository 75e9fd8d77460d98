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

"""A bag: serialized messages in an MCAP file, which ROS 2's tools can open."""

from __future__ import annotations

from pathlib import Path
import sys
from threading import Lock
from types import TracebackType
from typing import Any

from rrr_traj_planner.nodes.process.entry import StartError

NO_MCAP = ('recording needs the Python package mcap: python3 -m pip install mcap, in this '
           'environment')


class Bag:
    """
    An MCAP file with profile ros2; a context manager that completes the file when it exits.

    Parameters
    ----------
    file : Path
        A file that does not exist yet, or a device.

    Raises
    ------
    StartError
        If the package mcap is missing, or the file exists already or cannot be written.

    """

    def __init__(self, file: Path) -> None:
        try:
            from mcap.writer import Writer
        except ImportError:
            raise StartError(NO_MCAP) from None
        if file.is_file():
            raise StartError(f'{file} exists already: choose another file, or remove it')
        self.file = file
        self.count = 0  # of messages
        self._channels: dict[str, int] = {}
        self._sequence: dict[str, int] = {}
        self._lock, self._closed = Lock(), False
        self._error: OSError | None = None
        try:
            file.parent.mkdir(parents=True, exist_ok=True)
            self._stream = file.open('wb')
        except OSError as error:
            raise StartError(f'cannot write {file}: {error.strerror}') from None
        self._writer: Any = Writer(self._stream)
        self._writer.start(profile='ros2', library='rrr_traj_planner')

    def __enter__(self) -> Bag:
        """Return the bag."""
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None,
                 trace: TracebackType | None) -> None:
        """Write the index and close the file; print a message if the file is incomplete."""
        with self._lock:
            self._closed = True
            try:
                if self._error is None:
                    self._writer.finish()
                self._stream.close()
            except OSError as problem:
                self._error = problem
        if self._error is not None:
            print(f'{self.file} is incomplete: {self._error.strerror}', file=sys.stderr)

    def has(self, topic: str) -> bool:
        """Return whether a topic has been added."""
        return topic in self._channels

    def add_topic(self, topic: str, kind: str, definition: str, qos: str) -> None:
        """
        Add a topic, before its first message.

        Parameters
        ----------
        topic : str
            Full name.
        kind, definition : str
            Type, such as `sensor_msgs/msg/JointState`, and its definition in the form ros2msg.
        qos : str
            Quality of service that its publishers offer, in rosbag2's YAML form.

        """
        with self._lock:
            schema = self._writer.register_schema(kind, 'ros2msg', definition.encode())
            self._channels[topic] = self._writer.register_channel(
                topic, 'cdr', schema, {'offered_qos_profiles': qos})
            self._sequence[topic] = 0

    def write(self, topic: str, message: bytes, received: int, sent: int) -> None:
        """
        Add a message; does nothing after a write has failed.

        Parameters
        ----------
        topic : str
            A topic that has been added.
        message : bytes
            The serialized message.
        received, sent : int
            Wall times [ns].

        """
        with self._lock:
            if self._closed or self._error is not None:
                return
            self._sequence[topic] += 1
            try:
                self._writer.add_message(self._channels[topic], received, message, sent,
                                         self._sequence[topic])
                self.count += 1
            except OSError as error:  # a full disk ends the recording, not the demo
                self._error = error
