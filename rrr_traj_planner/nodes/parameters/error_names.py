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

"""Names of parameters and message fields in the library's errors, in place of its arguments."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import fields
from re import match
from typing import Any, TypeVar

from rrr_traj_planner.core.errors import InvalidInputError

Value = TypeVar('Value')


@contextmanager
def named(names: Mapping[str, str]) -> Iterator[None]:
    """
    Replace the argument's name at the start of an error's message.

    Parameters
    ----------
    names : mapping
        The name to show for each argument.

    Raises
    ------
    InvalidInputError
        The error raised within the context, with the name replaced.

    """
    try:
        yield
    except InvalidInputError as error:
        argument = match(r'\w*', str(error))[0]
        if argument not in names:
            raise
        message = names[argument] + str(error)[len(argument):]
        raise InvalidInputError(message, error.via_point) from None


def from_group(kind: type[Value], group: str, values: Mapping[str, Any]) -> Value:
    """
    Build a dataclass from a group of parameters.

    Parameters
    ----------
    kind : type
        A dataclass whose fields have the names of the group's parameters.
    group : str
        The group's name.
    values : mapping
        Each parameter's value by name.

    Returns
    -------
    object
        An instance of that class.

    Raises
    ------
    InvalidInputError
        If the class refuses a value; the message begins with the parameter's name.

    """
    parameters = {field.name: f'{group}.{field.name}' for field in fields(kind)}
    with named(parameters):
        return kind(**{name: values[parameter] for name, parameter in parameters.items()})
