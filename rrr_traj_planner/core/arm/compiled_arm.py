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

"""An arm's tables as the compiled kernels read them: the coefficients that are not zero."""

from __future__ import annotations

import ctypes
from ctypes import c_int32, c_void_p
from functools import lru_cache
from typing import Any

import numpy as np
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.kernels import declared, same_size_as

KERNELS = declared({
    'arm_gravity_torque': (None, [c_void_p, c_int32, *[c_void_p] * 2]),
    'arm_inertia_and_bias': (None, [c_void_p, c_int32, *[c_void_p] * 4]),
    'arm_inverse_dynamics': (None, [c_void_p, c_int32, *[c_void_p] * 4]),
    'arm_jacobian': (None, [c_void_p, c_int32, *[c_void_p] * 2]),
    'arm_jacobian_rate': (None, [c_void_p, c_int32, *[c_void_p] * 3]),
    'arm_path_terms': (None, [c_void_p, c_int32, *[c_void_p] * 6]),
    'arm_potential_energy': (None, [c_void_p, c_int32, *[c_void_p] * 2]),
    'arm_tip': (None, [c_void_p, c_int32, *[c_void_p] * 2]),
})


@same_size_as('size_of_arm')
class _Arm(ctypes.Structure):  # as in native/arm.h
    _fields_ = [*((f'{name}_count', c_int32) for name in ('tip', 'inertia', 'potential')),
                *((f'{name}_at', c_void_p) for name in ('tip', 'inertia', 'potential')),
                *((name, c_void_p) for name in ('tip', 'inertia', 'potential', 'viscous'))]


class CompiledArm:
    """
    An arm for the kernels.

    Parameters
    ----------
    model : RobotModel
        The arm.

    Attributes
    ----------
    address : int
        Of its structure, valid as long as this object lives.

    """

    def __init__(self, model: RobotModel) -> None:
        self._arm, viscous = _Arm(), np.array(model.friction.viscous)
        self._arrays: list[Any] = [viscous]
        self._arm.viscous = viscous.ctypes.data
        for name, table in model.tables._asdict().items():
            self._bind(name, table)
        self.address: Any = ctypes.addressof(self._arm)

    def _bind(self, name: str, table: Array) -> None:
        """Give the kernels the indices and values of a table's coefficients."""
        at = np.argwhere(table)
        values, indices = table[tuple(at.T)], np.ascontiguousarray(at, dtype=np.int32)
        self._arrays += [values, indices]
        setattr(self._arm, name, values.ctypes.data)
        setattr(self._arm, f'{name}_at', indices.ctypes.data)
        setattr(self._arm, f'{name}_count', len(values))


@lru_cache(maxsize=16)
def compiled(model: RobotModel) -> CompiledArm:
    """
    Return an arm for the kernels, made once.

    Parameters
    ----------
    model : RobotModel
        The arm; a model never changes.

    Returns
    -------
    CompiledArm
        To be held as long as its address is used.

    """
    return CompiledArm(model)
