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

"""A loader of YAML: whatever is wrong with a file's text is an error of YAML's, with its line."""

from __future__ import annotations

from typing import Any

from rrr_traj_planner.core.errors import InvalidInputError, shown
import yaml
from yaml.constructor import ConstructorError

# What PyYAML lets through where a text is not of its tag: of int(), float(), dates and others.
RAISED = (ArithmeticError, AttributeError, LookupError, TypeError, ValueError)


class Loader(yaml.SafeLoader):
    """PyYAML's loader of plain values, which raises nothing but its own errors."""

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
