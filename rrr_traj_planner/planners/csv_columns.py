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

"""Writing columns of numbers as a file of comma-separated values."""

from __future__ import annotations

from collections.abc import Mapping
import csv
from os import PathLike
from typing import TextIO

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.errors import InvalidInputError, shown


def write_columns(file: str | PathLike[str] | TextIO, columns: Mapping[str, Array],
                  digits: int | None = None) -> None:
    """
    Write a file of comma-separated values.

    Parameters
    ----------
    file : path or text file
        A path, which is overwritten, or a file that is open for text.
    columns : mapping
        Columns, shape (n,) each, by their headers.
    digits : int, optional
        Significant digits; None: as many as reproduce the same numbers.

    Raises
    ------
    InvalidInputError
        If the file is neither a path nor an open file.
    OSError
        If it cannot be written.

    """
    if isinstance(file, (str, PathLike)):
        with open(file, 'w', newline='', encoding='utf-8') as stream:
            write_columns(stream, columns, digits)
    elif hasattr(file, 'write'):
        rows = csv.writer(file, lineterminator='\n')
        rows.writerow(columns)
        values = np.column_stack([np.asarray(c, dtype=float) for c in columns.values()]).tolist()
        rows.writerows([repr(x) if digits is None else f'{x:.{digits}g}' for x in row]
                       for row in values)
    else:
        raise InvalidInputError(f'file is {shown(file)}, must be a path or an open text file')
