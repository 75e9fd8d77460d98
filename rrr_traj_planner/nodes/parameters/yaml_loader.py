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

"""
Loaders of YAML: whatever is wrong with a file's text is an error of YAML's, with its line.

PyYAML follows YAML 1.1, whose numbers are not those that people write: 1e-3 is a text, 010 is 8,
1_000 is 1000 and 1:30 is 90. `Loader` reads numbers by YAML 1.2's core schema (10.3.2): 0.001, 10,
and two texts. `RosLoader` reads plain values as ROS's parser of parameter files does.
"""

from __future__ import annotations

import re
from typing import Any

from rrr_traj_planner.core.errors import InvalidInputError, shown
import yaml
from yaml.composer import ComposerError
from yaml.constructor import ConstructorError

# What PyYAML lets through where a text is not of its tag: of int(), float(), dates and others.
RAISED = (ArithmeticError, AttributeError, LookupError, TypeError, ValueError)


TAG = 'tag:yaml.org,2002:'
PLAIN = f'{TAG}plain'  # of what is neither quoted nor tagged
INTEGER = re.compile(r'[-+]?[0-9]+$|0o[0-7]+$|0x[0-9a-fA-F]+$')
FLOAT = re.compile(r'[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?$'
                   r'|[-+]?\.(inf|Inf|INF)$|\.(nan|NaN|NAN)$')
NOT_THOSE_OF_1_1 = tuple(f'{TAG}{kind}' for kind in ('int', 'float'))

# rcl_yaml_param_parser: strtol with base 0, then strtod; its truth values.
ROS_INTEGER = re.compile(r'[-+]?(0[xX][0-9a-fA-F]+|0[0-7]*|[1-9][0-9]*)$')
ROS_FLOAT = re.compile(
    r'[-+]?((\d+\.?\d*|\.\d+)(e[-+]?\d+)?|inf(inity)?|nan'
    r'|0x([0-9a-f]+\.?[0-9a-f]*|\.[0-9a-f]+)(p[-+]?\d+)?)$', re.ASCII | re.IGNORECASE)
ROS_DOTTED = re.compile(r'[-+]?\.(inf|Inf|INF)$|\.(nan|NaN|NAN)$')
ROS_TRUTH = {text: value for value, texts in (
    (True, 'Y y yes Yes YES true True TRUE on On ON'),
    (False, 'N n no No NO false False FALSE off Off OFF')) for text in texts.split()}
LONG = 2 ** 63


class Loader(yaml.SafeLoader):
    """PyYAML's loader of plain values, with YAML 1.2's numbers; raises only its own errors."""

    yaml_implicit_resolvers = {
        first: [(tag, pattern) for tag, pattern in resolvers if tag not in NOT_THOSE_OF_1_1]
        for first, resolvers in yaml.SafeLoader.yaml_implicit_resolvers.items()}

    def get_single_node(self) -> Any:
        """Return the document's root."""
        try:
            return super().get_single_node()
        except RecursionError:
            raise yaml.YAMLError('nested too deeply') from None

    def get_node(self) -> Any:
        """Return the root of the next document."""
        try:
            return super().get_node()
        except RecursionError:
            raise yaml.YAMLError('nested too deeply') from None

    def construct_document(self, node: yaml.Node) -> Any:
        """Return the document's content."""
        try:
            return super().construct_document(node)
        except RecursionError:
            raise yaml.YAMLError('nested too deeply') from None

    def construct_object(self, node: yaml.Node, deep: bool = False) -> Any:
        """Return a value."""
        try:
            return super().construct_object(node, deep)
        except RAISED:
            kind = node.tag.rpartition(':')[2]
            raise ConstructorError(None, None, f'{shown(node.value)} is not of type {kind}',
                                   node.start_mark) from None

    def construct_integer(self, node: yaml.Node) -> int:
        """Return an integer: decimal, 0o17 or 0x1f."""
        text = str(self.construct_scalar(node))
        if not INTEGER.match(text):
            raise ValueError
        return int(text, {'0o': 8, '0x': 16}.get(text[:2], 10))

    def construct_float(self, node: yaml.Node) -> float:
        """Return a number."""
        text = str(self.construct_scalar(node))
        if not FLOAT.match(text):
            raise ValueError
        return float(text.lower().replace('.inf', 'inf').replace('.nan', 'nan'))


Loader.add_constructor(f'{TAG}int', Loader.construct_integer)
Loader.add_constructor(f'{TAG}float', Loader.construct_float)
Loader.add_implicit_resolver(f'{TAG}int', INTEGER, list('-+0123456789'))
Loader.add_implicit_resolver(f'{TAG}float', FLOAT, list('-+.0123456789'))


class RosLoader(Loader):
    """Reads plain values as ROS does in parameter files and behind `-p NAME:=`; keys are texts."""

    def compose_node(self, parent: yaml.Node, index: Any) -> Any:
        """Return the next node; ROS refuses aliases."""
        if self.check_event(yaml.AliasEvent):
            event = self.peek_event()
            raise ComposerError(
                None, None, f'the alias *{event.anchor} is refused by ROS', event.start_mark)
        return super().compose_node(parent, index)

    def resolve(self, kind: type[yaml.Node], value: Any, implicit: Any) -> Any:
        """Return the tag of a node that has none."""
        if kind is yaml.ScalarNode:
            return PLAIN if implicit[0] else f'{TAG}str'
        return super().resolve(kind, value, implicit)

    def construct_plain(self, node: yaml.ScalarNode) -> Any:
        """Return the truth value, the number or the text of a value without a tag."""
        return ros_value(str(node.value))

    def construct_mapping(self, node: yaml.MappingNode, deep: bool = False) -> dict[Any, Any]:
        """Return a mapping with keys as they are written: a joint may be called 1, or y."""
        for key, _ in node.value:
            if not isinstance(key, yaml.ScalarNode):
                raise ConstructorError(None, None, 'a key must be a text', key.start_mark)
        return {key.value: self.construct_object(value, deep=True) for key, value in node.value}


RosLoader.add_constructor(PLAIN, RosLoader.construct_plain)


def ros_value(text: str) -> bool | int | float | str | None:
    """
    Return what ROS reads in a plain value of a parameter file.

    Parameters
    ----------
    text : str
        The value as it is written, without quotation marks.

    Returns
    -------
    bool, int, float or str, or None
        By the first rule that fits; None where there is no text, which ROS refuses.

    """
    if text in ROS_TRUTH:
        return ROS_TRUTH[text]
    if ROS_INTEGER.match(text):
        digits = text.lstrip('-+')
        octal = len(digits) > 1 and digits.isdigit() and digits[0] == '0'
        number = int(text, 8) if octal else int(text, 0)
        if -LONG <= number < LONG:
            return number
    if ROS_DOTTED.match(text):
        return float(text.lower().replace('.', ''))
    if ROS_FLOAT.match(text):
        is_hex = 'x' in text.lower()
        try:
            value = float.fromhex(text) if is_hex else float(text)
        except OverflowError:
            return text
        if abs(value) != float('inf') or 'n' in text.lower():  # else it overflows
            return value
    return text or None


def input_error(error: yaml.YAMLError) -> InvalidInputError:
    """
    Return an error of YAML's as one of the input.

    Parameters
    ----------
    error : YAMLError
        Of a text.

    Returns
    -------
    InvalidInputError
        One line, which begins with that of the text if it is known.

    """
    if not isinstance(error, yaml.MarkedYAMLError):
        return InvalidInputError(' '.join(str(error).split()))
    mark = error.problem_mark or error.context_mark
    return InvalidInputError((f'line {mark.line + 1}: ' if mark else '')
                             + ', '.join(filter(None, (error.context, error.problem))))
