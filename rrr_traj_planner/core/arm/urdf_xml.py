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

"""The XML of a URDF: its text, and its root element."""

from __future__ import annotations

from pathlib import Path
import re
from xml.etree import ElementTree as ET
from xml.parsers.expat import ErrorString

from rrr_traj_planner.core.errors import InvalidInputError, shown

BEFORE_XML = '\ufeff \t\r\n'  # a byte order mark, and white space
XACRO = '{http://www.ros.org/wiki/xacro}'


def is_xml(value: str) -> bool:
    """
    Return whether a value is a document's text, and no path: its first character is '<'.

    Parameters
    ----------
    value : str
        The value.

    Returns
    -------
    bool
        White space and a byte order mark before that do not matter.

    """
    return value.lstrip(BEFORE_XML).startswith('<')


def file_text(path: str) -> str:
    """
    Return a document's text from its file.

    Parameters
    ----------
    path : str
        Of the file.

    Returns
    -------
    str
        By the encoding that it declares, where it is not UTF-8.

    Raises
    ------
    InvalidInputError
        If there is no such file, or it cannot be read.

    """
    if not path.strip():
        raise InvalidInputError("the URDF is empty, must be its text or a file's path")
    try:
        return _decoded(Path(path).read_bytes())
    except (OSError, ValueError) as error:  # no such file, a folder, a null character, no UTF-8
        why = error.strerror if isinstance(error, OSError) else str(error)
        raise InvalidInputError(
            f"{shown(path)} is neither a URDF, whose text begins with '<', nor a file that can be "
            f'read: {why}') from None


def robot_element(text: str) -> ET.Element:
    """
    Return the element `robot` of a URDF.

    Parameters
    ----------
    text : str
        XML.

    Returns
    -------
    Element
        Without the namespace of the whole document, if it has one.

    Raises
    ------
    InvalidInputError
        If the text is no well-formed XML, with the line; or no URDF.

    """
    if not is_xml(text):
        raise InvalidInputError("no URDF, whose text begins with '<'")
    xml = text.lstrip(BEFORE_XML)
    try:
        root = ET.fromstring(xml)
    except ET.ParseError as error:
        line = error.position[0] + text[:len(text) - len(xml)].count('\n')
        raise InvalidInputError(
            f'line {line}, column {error.position[1]}: not well-formed XML, '
            f'{ErrorString(error.code)}') from None
    except ValueError as error:
        raise InvalidInputError(f'not well-formed XML, {error}') from None
    if any(str(element.tag).startswith(XACRO) for element in root.iter()):
        raise InvalidInputError('this is a xacro file, must be expanded: xacro FILE > FILE.urdf')
    namespace, _, root.tag = root.tag.rpartition('}')
    for element in root.iter():
        if namespace and str(element.tag).startswith(namespace):
            element.tag = str(element.tag)[len(namespace) + 1:]
    if root.tag != 'robot':
        raise InvalidInputError(f'the root element is <{root.tag}>, must be <robot>')
    return root


def _decoded(content: bytes) -> str:
    """Return the text of a file's bytes."""
    declared = re.match(rb"""\s*<\?xml[^>]*?encoding\s*=\s*["']([\w.:-]+)["']""", content)
    try:
        return content.decode('utf-8-sig')
    except UnicodeDecodeError:
        if declared is None:
            raise
    try:
        return content.decode(declared[1].decode('ascii'))
    except LookupError as error:
        raise ValueError(str(error)) from None
