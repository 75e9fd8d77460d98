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
The compiled kernels: the C code of the `native` folders, one library, called through ctypes.

A kernel is a plain function over arrays that Python owns; a structure holds their addresses, made
once for each problem. A call takes microseconds to a few milliseconds and keeps Python's global
interpreter lock: releasing it would cost more than the shortest calls.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
import ctypes
from ctypes import c_int64
from importlib.machinery import EXTENSION_SUFFIXES
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from rrr_traj_planner.core.arrays import Array

_NATIVE = Path(__file__).parent / 'native'
_BUILD = 'build the package, which needs a C compiler: "make setup", or "pip install -e ."'

# For each kernel the types of its result and of its arguments.
Signatures = Mapping[str, tuple[Any, list[Any]]]


def load(folder: Path) -> Any:
    """
    Return the compiled kernels.

    Parameters
    ----------
    folder : Path
        The folder of the shared library.

    Returns
    -------
    ctypes.PyDLL
        Without declarations.

    Raises
    ------
    ImportError
        If the library is missing.

    """
    paths = [folder / f'kernels{suffix}' for suffix in EXTENSION_SUFFIXES]
    found = next((path for path in paths if path.exists()), None)
    if found is None:
        raise ImportError(f'no compiled kernels in {folder}: {_BUILD}')
    return ctypes.PyDLL(str(found))


_LIBRARY = load(_NATIVE)


def declared(signatures: Signatures) -> Any:
    """
    Return the kernels, with results and arguments of some of them declared.

    Parameters
    ----------
    signatures : mapping
        Of the kernels that the caller uses.

    Returns
    -------
    ctypes.PyDLL
        The library.

    Raises
    ------
    ImportError
        If it lacks one of them.

    """
    for name, (result, arguments) in signatures.items():
        if not hasattr(_LIBRARY, name):
            raise ImportError(f'the compiled kernels were built from other sources, without '
                              f'{name}: {_BUILD}')
        kernel = getattr(_LIBRARY, name)
        kernel.restype, kernel.argtypes = result, arguments
    return _LIBRARY


_S = TypeVar('_S', bound=type[ctypes.Structure])


def same_size_as(size: str) -> Callable[[_S], _S]:
    """
    Return a decorator of a structure that repeats one of the kernels: checks their sizes.

    Parameters
    ----------
    size : str
        Name of the kernels' constant that is the size of their structure.

    Returns
    -------
    callable
        Returns the structure unchanged; ImportError where the sizes differ.

    """
    def checked(structure: _S) -> _S:
        theirs, ours = c_int64.in_dll(_LIBRARY, size).value, ctypes.sizeof(structure)
        if theirs != ours:
            raise ImportError(f'the compiled kernels were built from other sources: {size} is '
                              f'{theirs}, not {ours}: {_BUILD}')
        return structure

    return checked


def contiguous(values: Array) -> Array:
    """
    Return an array in the layout that kernels read.

    Parameters
    ----------
    values : ndarray
        Numbers.

    Returns
    -------
    ndarray
        Of float64, in C order; the same array where it is already.

    """
    return np.ascontiguousarray(values, dtype=float)


def addresses(rows: Array) -> list[int]:
    """
    Return where the rows of an array begin: cheaper than the address of each.

    Parameters
    ----------
    rows : ndarray, shape (n, ...)
        Of float64, contiguous; to be held as long as the addresses are used.

    Returns
    -------
    list of int
        The n addresses.

    """
    first, step = rows.ctypes.data, rows.strides[0]
    return [first + k * step for k in range(len(rows))]
