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

"""Whether an arm's inertia matrix is positive definite in every pose."""

from __future__ import annotations

import numpy as np
from rrr_traj_planner.core.arrays import Array

# Positions of joints 2 and 3 at which the matrix is checked: every 7.5 degrees, with the right
# angles at which terms of common arms vanish. Chosen.
ANGLES = np.arange(48) * (np.pi / 24.0)  # rad

# Part of a determinant's scale up to which it is zero: rounding of the table where terms cancel.
# Chosen.
ROUNDING = 1e-12


def singular_inertia_reason(table: Array) -> str:
    """
    Return why the inertia matrix is singular in some pose; '' where it never is.

    Parameters
    ----------
    table : ndarray, shape (6, 5, 5)
        Of the inertia matrix, as in `ArmTables`.

    Returns
    -------
    str
        Which links lack inertia, so that a torque could accelerate joints without bound; empty
        where the matrix is positive definite at every angle that is checked.

    """
    basis = np.stack([np.ones_like(ANGLES), np.cos(ANGLES), np.sin(ANGLES),
                      np.cos(2.0 * ANGLES), np.sin(2.0 * ANGLES)])
    M11, M12, M13, M22, M23, M33 = np.einsum('eab,ai,bj->eij', table, basis, basis)
    largest = [float(np.abs(m).max()) for m in (M11, M22, M33)]
    both = M22 * M33 - M23 ** 2
    all_three = (M11 * both - M12 * (M12 * M33 - M13 * M23) + M13 * (M12 * M23 - M13 * M22))
    scale = np.cumprod(largest[::-1])
    for determinant, size, text in (
            (M33, scale[0], 'link 3 has no inertia about joint axis 3'),
            (both, scale[1], 'links 2 and 3 have no inertia about joint axis 2'),
            (all_three, scale[2], 'the arm can have no inertia about joint axis 1')):
        if float(determinant.min()) <= ROUNDING * size:
            return text
    return ''
