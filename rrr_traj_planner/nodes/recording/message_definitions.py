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

"""Message definitions in the form that bags contain: a type followed by the types it contains."""

from __future__ import annotations

import re

from ament_index_python.packages import get_package_share_path

PRIMITIVES = re.compile(r'(bool|byte|char|w?string|float(32|64)|u?int(8|16|32|64))\b')
SEPARATOR = '=' * 80


def definition(name: str) -> str:
    """
    Return a message's definition, followed by those of all types that it contains.

    Parameters
    ----------
    name : str
        Full name, such as `sensor_msgs/msg/JointState`.

    Returns
    -------
    str
        In the form that MCAP calls ros2msg: .msg files under headings `MSG: package/Name`.

    Raises
    ------
    FileNotFoundError
        If a package does not contain its .msg files.

    """
    package, _, kind = name.split('/')
    found = {f'{package}/{kind}': _text(package, kind)}
    waiting = list(found)
    while waiting:
        outer = waiting.pop(0)
        for inner in _inner_types(outer.split('/')[0], found[outer]):
            if inner not in found:
                found[inner] = _text(*inner.split('/'))
                waiting.append(inner)
    (_, text), *others = found.items()
    return '\n'.join([text, *(f'{SEPARATOR}\nMSG: {inner}\n{more}' for inner, more in others)])


def _text(package: str, kind: str) -> str:
    return (get_package_share_path(package) / 'msg' / f'{kind}.msg').read_text()


def _inner_types(package: str, text: str) -> list[str]:
    """Return the message types of a definition's fields, as `package/Name`."""
    names = []
    for line in text.splitlines():
        words = line.partition('#')[0].split()
        if not words or PRIMITIVES.match(words[0]):
            continue
        kind = words[0].partition('[')[0]
        names.append(kind if '/' in kind else f'{package}/{kind}')
    return names
