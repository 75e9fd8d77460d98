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

"""Reads bags with MCAP's reference reader for ROS 2."""

from __future__ import annotations

import pytest

MISSING = 'needs mcap-ros2-support, of requirements/test.in'
mcap_reader = pytest.importorskip('mcap.reader', reason=MISSING)
mcap_decoder = pytest.importorskip('mcap_ros2.decoder', reason=MISSING)


def messages_by_topic(file):
    """Return the (record, decoded message) pairs of each topic, in order."""
    found = {}
    with file.open('rb') as stream:
        reader = mcap_reader.make_reader(
            stream, validate_crcs=True, decoder_factories=[mcap_decoder.DecoderFactory()])
        for _, channel, record, message in reader.iter_decoded_messages():
            found.setdefault(channel.topic, []).append((record, message))
    return found


def summary(file):
    """Return header and summary of a bag."""
    with file.open('rb') as stream:
        reader = mcap_reader.make_reader(stream)
        return reader.get_header(), reader.get_summary()


def plain(message):
    """Return a message of ROS or of the reader as plain values, for comparison."""
    if hasattr(message, 'get_fields_and_field_types'):
        return {f: plain(getattr(message, f)) for f in message.get_fields_and_field_types()}
    if hasattr(message, '__slots__'):
        return {f: plain(getattr(message, f)) for f in message.__slots__}
    if isinstance(message, bytes):  # a single byte in ROS, any number of them in the reader
        return message[0] if len(message) == 1 else list(message)
    if isinstance(message, str) or not hasattr(message, '__len__'):
        return message
    return [plain(item) for item in message]
