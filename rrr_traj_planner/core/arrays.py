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

"""Checked, read-only arrays from callers' values."""

from __future__ import annotations

from math import isfinite
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray
from rrr_traj_planner.core.conversion import float_array, indexed
from rrr_traj_planner.core.errors import InvalidInputError, shown

Array: TypeAlias = NDArray[np.float64]
BoolArray: TypeAlias = NDArray[np.bool_]
IntArray: TypeAlias = NDArray[np.int_]


def finite_array(name: str, value: ArrayLike, shape: tuple[int, ...] | None = None) -> Array:
    """
    Return a read-only float copy of a value, checked.

    Parameters
    ----------
    name : str
        What the value is called in the error's text.
    value : array_like
        The value.
    shape : tuple of int, optional
        The shape that it must have; -1 stands for any length.

    Returns
    -------
    ndarray
        A copy that cannot be written to.

    Raises
    ------
    InvalidInputError
        If the value is not an array of numbers, has another shape or is not finite.

    """
    array = _checked(name, value, shape)
    _refuse_where(name, array, ~np.isfinite(array), 'finite')
    return array


def number_array(name: str, value: ArrayLike, shape: tuple[int, ...] | None = None) -> Array:
    """
    Return a read-only float copy of any numbers, also infinite ones and NaN.

    Parameters
    ----------
    name, value, shape
        As in `finite_array`.

    Returns
    -------
    ndarray
        A copy that cannot be written to.

    Raises
    ------
    InvalidInputError
        If the value is not an array of numbers or has another shape.

    """
    return _checked(name, value, shape)


def bound_array(name: str, value: ArrayLike, shape: tuple[int, ...] | None = None) -> Array:
    """
    Return a read-only float copy of bounds: finite or infinite, never NaN.

    Parameters
    ----------
    name, value, shape
        As in `finite_array`.

    Returns
    -------
    ndarray
        A copy that cannot be written to.

    Raises
    ------
    InvalidInputError
        If the value is not an array of numbers, has another shape or holds a NaN.

    """
    array = _checked(name, value, shape)
    _refuse_where(name, array, np.isnan(array), 'a number')
    return array


def joint_values(name: str, value: ArrayLike) -> Array:
    """
    Return joint values as a float array whose last axis is the joints.

    Parameters
    ----------
    name : str
        What the value is called in the error's text.
    value : array_like, shape (..., 3)
        The values.

    Returns
    -------
    ndarray, shape (..., 3)
        The same values; the same object if it is a float array.

    Raises
    ------
    InvalidInputError
        If the value is not an array of numbers, has another shape or is not finite.

    """
    array = float_array(name, value)
    if array.ndim < 1 or array.shape[-1] != 3:
        raise InvalidInputError(f'{name} has shape {array.shape}, must have (..., 3)')
    if not isfinite(np.add.reduce(array, axis=None)):  # of finite values too, where they are huge
        _refuse_where(name, array, ~np.isfinite(array), 'finite')
    return array


def joint_states(**values: ArrayLike) -> list[Array]:
    """
    Return joint values that belong together, each as from `joint_values`.

    Parameters
    ----------
    **values : array_like, shape (..., 3)
        By their names in the error's text.

    Returns
    -------
    list of ndarray
        In the same order, of shapes that broadcast.

    Raises
    ------
    InvalidInputError
        If `joint_values` refuses one, or the shapes do not broadcast.

    """
    arrays = [joint_values(name, value) for name, value in values.items()]
    shapes = {array.shape for array in arrays}
    if len(shapes) > 1:
        try:
            np.broadcast_shapes(*shapes)
        except ValueError:
            found = ', '.join(f'{name} {a.shape}' for name, a in zip(values, arrays))
            raise InvalidInputError(f'shapes do not go together: {found}') from None
    return arrays


def parameter_values(name: str, value: ArrayLike) -> Array:
    """
    Return values of a curve's parameter (time or arc length) as a float array.

    Parameters
    ----------
    name : str
        What the value is called in the error's text.
    value : array_like, shape (n,) or ()
        The values; may be infinite.

    Returns
    -------
    ndarray, shape (n,) or ()
        The same values; the same object if it is a float array.

    Raises
    ------
    InvalidInputError
        If the value is not an array of numbers, has another shape or holds a NaN.

    """
    array = float_array(name, value)
    if array.ndim > 1:
        raise InvalidInputError(f'{name} has shape {array.shape}, must have (n) or ()')
    if np.isnan(array).any():
        _refuse_where(name, array, np.isnan(array), 'a number')
    return array


def truth_array(name: str, value: ArrayLike, shape: tuple[int, ...]) -> BoolArray:
    """
    Return a read-only copy of bools, checked.

    Parameters
    ----------
    name : str
        What the value is called in the error's text.
    value : array_like of bool
        The value.
    shape : tuple of int
        The shape that it must have.

    Returns
    -------
    ndarray of bool
        A copy that cannot be written to.

    Raises
    ------
    InvalidInputError
        If the value is not an array of bools, or has another shape.

    """
    try:
        array = np.array(value)
    except ValueError:  # rows of several lengths
        array = np.empty(0)
    if array.dtype != np.bool_:
        raise InvalidInputError(f'{name} is {shown(value)}, must be truth values')
    if array.shape != shape:
        raise InvalidInputError(f'{name} has shape {array.shape}, must have {shape}')
    array.setflags(write=False)
    return array


def _refuse_where(name: str, array: Array, wrong: BoolArray, wanted: str) -> None:
    """
    Raise for the first value that is wrong.

    Parameters
    ----------
    name : str
        What the array is called.
    array : ndarray
        The values.
    wrong : ndarray of bool
        Whether each is wrong.
    wanted : str
        What they must be, for the error's text.

    Raises
    ------
    InvalidInputError
        If a value is wrong.

    """
    for where in np.argwhere(wrong):
        at = tuple(where.tolist())
        raise InvalidInputError(f'{name}{indexed(at)} is {array[at]}, must be {wanted}')


def _checked(name: str, value: ArrayLike, shape: tuple[int, ...] | None) -> Array:
    array = np.array(float_array(name, value))
    if shape is not None and not _fits(array.shape, shape):
        wanted = '(' + ', '.join('n' if n < 0 else str(n) for n in shape) + ')'
        raise InvalidInputError(f'{name} has shape {array.shape}, must have {wanted}')
    array.setflags(write=False)
    return array


def _fits(actual: tuple[int, ...], wanted: tuple[int, ...]) -> bool:
    return len(actual) == len(wanted) and all(
        w < 0 or a == w for a, w in zip(actual, wanted))
