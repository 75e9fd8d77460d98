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

"""What crosses to the compiled kernels by position: structures and constants."""

import ctypes
import re

from helpers.places import ROOT
import pytest
from rrr_traj_planner.core.dynamics.equations import Constants
from rrr_traj_planner.planners.path_timing.dense_check import _PathCheck
from rrr_traj_planner.planners.solver.library import load, same_size_as
from rrr_traj_planner.planners.solver.timing_problem import _Problem, _Step
from rrr_traj_planner.planners.solver.via_barrier import _ViaProblem

NATIVE = ROOT / 'rrr_traj_planner' / 'planners' / 'native'
REPEATED = {'problem': _Problem, 'step': _Step, 'via_problem': _ViaProblem,
            'path_check': _PathCheck}


def test_every_exported_size_is_that_of_a_repeated_structure():
    exported = {name for path in NATIVE.glob('*.c')
                for name in re.findall(r'size_of_(\w+) = sizeof', path.read_text())}
    assert exported == set(REPEATED)


@pytest.mark.parametrize('name', REPEATED)
def test_a_structure_of_another_size_is_refused(name):
    same_size_as(f'size_of_{name}')(REPEATED[name])

    class Longer(REPEATED[name]):
        _fields_ = [('more', ctypes.c_double)]

    with pytest.raises(ImportError, match=f'other sources: size_of_{name} .*make setup'):
        same_size_as(f'size_of_{name}')(Longer)


def test_kernels_that_are_not_built_are_named(tmp_path):
    with pytest.raises(ImportError, match=f'^no compiled kernels in {tmp_path}: .*make setup'):
        load(tmp_path)


def test_the_arm_s_constants_have_one_order():
    order = re.search(r'enum \{\s*(A2,[^}]*?)\s*\}', (NATIVE / 'torque.c').read_text())[1]
    assert [name.strip().lower() for name in order.split(',')] == list(Constants._fields)
