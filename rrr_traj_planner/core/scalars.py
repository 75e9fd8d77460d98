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

"""Checked numbers, flags, choices and names: fields of value types other than arrays."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import inf, isfinite, ulp
from numbers import Integral
from typing import Any

import numpy as np
from rrr_traj_planner.core.conversion import real_number
from rrr_traj_planner.core.errors import InvalidInputError, shown


def finite(name: str, value: Any, unit: str = '') -> float:
    """
    Return a finite number as a float.

    Parameters
    ----------
    name : str
        What the value is called in the error's text.
    value : object
        The value.
    unit : str
        Its unit, for the error's text.

    Returns
    -------
    float
        The number.

    Raises
    ------
    InvalidInputError
        If it is not a real number, or not finite.

    """
    return _within(name, value, unit, -inf)


def positive(name: str, value: Any, unit: str = '', may_be_infinite: bool = False,
             least: float | None = None) -> float:
    """
    Return a positive number as a float.

    Parameters
    ----------
    name, value, unit
        As in `finite`.
    may_be_infinite : bool
        Whether infinity, for no bound, is accepted.
    least : float, optional
        Lower bound.

    Returns
    -------
    float
        The number.

    Raises
    ------
    InvalidInputError
        If it is not a real number, not positive and finite, or too small.

    """
    number = real_number(name, value)
    if may_be_infinite and number == inf:
        return number
    if least is None:
        return _within(name, number, unit, ulp(0.0), 'be positive')
    return _within(name, number, unit, least, f'be at least {least} {unit}')


def not_negative(name: str, value: Any, unit: str = '') -> float:
    """
    Return a number that is not negative as a float.

    Parameters
    ----------
    name, value, unit
        As in `finite`.

    Returns
    -------
    float
        The number.

    Raises
    ------
    InvalidInputError
        If it is not a real number, negative or not finite.

    """
    return _within(name, value, unit, 0.0, 'not be negative')


def positive_fraction(name: str, value: Any) -> float:
    """
    Return a fraction in (0, 1] as a float.

    Parameters
    ----------
    name, value
        As in `finite`.

    Returns
    -------
    float
        The number.

    Raises
    ------
    InvalidInputError
        If it is not a real number, or outside (0, 1].

    """
    number = real_number(name, value)
    if not 0.0 < number <= 1.0:
        raise InvalidInputError(f'{name} is {number}, must be in (0, 1]')
    return number


def whole_number(name: str, value: Any, least: int | None = None) -> int:
    """
    Return a whole number.

    Parameters
    ----------
    name, value
        As in `finite`.
    least : int, optional
        Lower bound.

    Returns
    -------
    int
        The number.

    Raises
    ------
    InvalidInputError
        If it is not a whole number, or too small.

    """
    if not isinstance(value, Integral) or isinstance(value, (bool, np.timedelta64)):
        raise InvalidInputError(f'{name} is {shown(value)}, must be a whole number')
    if least is not None and value < least:
        raise InvalidInputError(f'{name} is {shown(value)}, must be at least {least}')
    return int(value)


def truth(name: str, value: Any) -> bool:
    """
    Return a bool.

    Parameters
    ----------
    name, value
        As in `finite`.

    Returns
    -------
    bool
        The value; not a number or a text.

    Raises
    ------
    InvalidInputError
        If it is not a bool.

    """
    if not isinstance(value, (bool, np.bool_)):
        raise InvalidInputError(f'{name} is {shown(value)}, must be True or False')
    return bool(value)


def text(name: str, value: Any) -> str:
    """
    Return a text.

    Parameters
    ----------
    name, value
        As in `finite`.

    Returns
    -------
    str
        The text.

    Raises
    ------
    InvalidInputError
        If it is not a text.

    """
    if not isinstance(value, str):
        raise InvalidInputError(f'{name} is {shown(value)}, must be a text')
    return str(value)


def names(name: str, value: Any) -> tuple[str, ...]:
    """
    Return names in a tuple.

    Parameters
    ----------
    name, value
        As in `finite`.

    Returns
    -------
    tuple of str
        The names.

    Raises
    ------
    InvalidInputError
        If the value is not a sequence of texts, or is itself a text.

    """
    if isinstance(value, str) or not isinstance(value, Iterable):
        raise InvalidInputError(f'{name} is {shown(value)}, must be several texts')
    return tuple(text(f'{name}[{i}]', part) for i, part in enumerate(value))


def one_of(name: str, value: Any, options: Sequence[str]) -> None:
    """
    Raise if the value is not one of the options.

    Parameters
    ----------
    name, value
        As in `finite`.
    options : sequence of str
        Accepted texts.

    Raises
    ------
    InvalidInputError
        If it is not one of them.

    """
    if not (isinstance(value, str) and value in options):
        raise InvalidInputError(
            f"{name} is {shown(value)}, must be {' or '.join(map(repr, options))}")


def kind_of(name: str, value: Any, kind: type) -> None:
    """
    Raise if a value is not an instance of the required class.

    Parameters
    ----------
    name, value
        As in `finite`.
    kind : type
        Required class.

    Raises
    ------
    InvalidInputError
        If it is not.

    """
    if not isinstance(value, kind):
        raise InvalidInputError(f'{name} is {shown(value)}, must be of {kind.__name__}')


def _within(name: str, value: Any, unit: str, least: float, wanted: str = '') -> float:
    number = real_number(name, value)
    if isfinite(number) and number >= least:
        return number
    wanted = wanted if isfinite(number) else 'be finite'
    raise InvalidInputError(f"{name} is {number}{' ' * bool(unit)}{unit}, must {wanted}")
