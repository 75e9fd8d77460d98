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
Strict conversion of real numbers to float.

Text, booleans and masked values are rejected.
"""

from __future__ import annotations

from decimal import Decimal
from numbers import Real
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from rrr_traj_planner.core.errors import InvalidInputError, shown


def float_array(name: str, value: ArrayLike) -> NDArray[np.float64]:
    """
    Return numbers as a float array.

    Parameters
    ----------
    name : str
        What the value is called in the error's text.
    value : array_like
        Real numbers; text, booleans and masked values are rejected.

    Returns
    -------
    ndarray
        The same values; the same object if it is a float array.

    Raises
    ------
    InvalidInputError
        If the value is not an array of numbers.

    """
    if type(value) is np.ndarray and value.dtype == np.float64:
        return value
    if np.ma.is_masked(value):
        raise InvalidInputError(f'{name} has masked values, must have numbers')
    try:
        array = np.asarray(value)
    except (TypeError, ValueError, OverflowError):  # rows of several lengths
        array = np.empty((), dtype=object)
    if array.dtype.kind in 'iuf' and not _has_truth_value(value):
        return np.asarray(array, dtype=float)
    if array.dtype.kind in 'mM':
        raise InvalidInputError(f'{name} is {shown(value)}, must be numbers, without a unit')
    return _converted(name, value)


def _converted(name: str, value: Any) -> NDArray[np.float64]:
    """Convert elements one by one; reject the first that is not a number."""
    try:
        parts = np.array(value, dtype=object)
    except (TypeError, ValueError):
        raise InvalidInputError(f'{name} is no array of numbers: {shown(value)}') from None
    array = np.empty(parts.shape)
    for at in np.ndindex(parts.shape):
        part, where = parts[at], f'{name}{indexed(at)}'
        if isinstance(part, (list, tuple, np.ndarray)):
            # The lengths of four rows show what differs.
            lengths = ', '.join(str(np.size(row)) for row in parts[:4])
            raise InvalidInputError(
                f'{name} has rows of {lengths} ... values, must have rows of one length')
        array[at] = real_number(where, part)
    return array


def real_number(name: str, value: Any) -> float:
    """
    Return a number as a float.

    Parameters
    ----------
    name : str
        What the value is called in the error's text.
    value : object
        Real; may be infinite or NaN.

    Returns
    -------
    float
        The number.

    Raises
    ------
    InvalidInputError
        If it is not a real number, or larger than any float.

    """
    if type(value) is float:
        return value
    if isinstance(value, np.ndarray) and value.shape == ():
        value = value[()]
    if not isinstance(value, (Real, Decimal)) or isinstance(value, (bool, np.timedelta64)):
        raise InvalidInputError(f'{name} is {shown(value)}, must be a number')
    try:
        return float(value)
    except OverflowError:
        raise InvalidInputError(f'{name} is {shown(value)}, must be finite') from None


def _has_truth_value(value: Any) -> bool:
    return isinstance(value, (list, tuple)) and any(
        isinstance(part, (bool, np.bool_)) or _has_truth_value(part) for part in value)


def indexed(where: tuple[int, ...]) -> str:
    """
    Return the index of a value in an array as text, for an error's text.

    Parameters
    ----------
    where : tuple of int
        Its indices.

    Returns
    -------
    str
        As in Python: [1][0].

    """
    return ''.join(f'[{i}]' for i in where)
