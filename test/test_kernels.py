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
from rrr_traj_planner.core.arm.compiled_arm import _Arm
from rrr_traj_planner.core.kernels import declared, load, same_size_as
from rrr_traj_planner.core.kinematics.common_normal import CommonNormal
from rrr_traj_planner.core.simulation.time_step import Load
from rrr_traj_planner.planners.solver.segment_steps import _Rules, _Segments
from rrr_traj_planner.planners.solver.timing_problem import _Problem
from rrr_traj_planner.planners.solver.via_barrier import _ViaProblem
from rrr_traj_planner.planners.solver.workspace import _Step
from rrr_traj_planner.planners.transitions.local_steps import _LocalRules

SOURCES = [path for layer in ('core', 'planners')
           for path in sorted((ROOT / 'rrr_traj_planner' / layer / 'native').glob('*.[ch]'))]
REPEATED = {'arm': _Arm, 'common_normal': CommonNormal, 'load': Load, 'local_rules': _LocalRules,
            'problem': _Problem, 'segment_rules': _Rules, 'segments': _Segments, 'step': _Step,
            'via_problem': _ViaProblem}
C_TYPES = {'int32_t': 'c_int', 'double': 'c_double', 'Ramp': '_Ramp'}


def declared_fields(name):
    """Return the fields of a structure of the C headers, each with the ctypes type it needs."""
    struct = name.title().replace('_', '')
    headers = '\n'.join(path.read_text() for path in SOURCES)
    body = re.search(rf'typedef struct \{{([^}}]*)\}} {struct};', headers)[1]
    fields = []
    for declaration in re.sub(r'/\*.*?\*/', '', body, flags=re.S).split(';')[:-1]:
        words = declaration.replace('const ', '').split(maxsplit=1)
        for field in words[1].split(','):
            name, count = re.search(r'(\w+)(?:\[(\d)\])?', field).groups()
            ctype = 'c_void_p' if '*' in field else C_TYPES[words[0]]
            is_array = count and '*' not in field
            fields.append((name, ctype + (f'_Array_{count}' if is_array else '')))
    return fields


def test_every_exported_size_is_that_of_a_repeated_structure():
    exported = {name for path in SOURCES
                for name in re.findall(r'size_of_(\w+) = sizeof', path.read_text())}
    assert exported == set(REPEATED)


@pytest.mark.parametrize('name', REPEATED)
def test_a_structure_of_another_size_is_refused(name):
    same_size_as(f'size_of_{name}')(REPEATED[name])

    class Longer(REPEATED[name]):
        _fields_ = [('more', ctypes.c_double)]

    with pytest.raises(ImportError, match=f'other sources: size_of_{name} .*make setup'):
        same_size_as(f'size_of_{name}')(Longer)


@pytest.mark.parametrize('name', REPEATED)
def test_a_structure_has_the_fields_of_its_header_in_their_order(name):
    assert declared_fields(name) == [
        (field, ctype.__name__) for field, ctype in REPEATED[name]._fields_]


def test_kernels_that_are_not_built_are_named(tmp_path):
    with pytest.raises(ImportError, match=f'^no compiled kernels in {tmp_path}: .*make setup'):
        load(tmp_path)


def test_kernels_without_a_function_are_those_of_other_sources():
    with pytest.raises(ImportError, match='other sources, without no_such_kernel: .*make setup'):
        declared({'no_such_kernel': (None, [])})
