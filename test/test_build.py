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

"""The build of the kernels: with a compiler, without one, and with one that refuses a file."""

import os
import shutil
import subprocess
import sys

from helpers.places import ROOT
import pytest
from rrr_traj_planner.core.kernels import load

NATIVE = 'rrr_traj_planner/core/native'  # where the library is
OTHERS = 'rrr_traj_planner/planners/native'
NEEDED = ('rrr_traj_planner needs a C compiler that builds its kernels, '
          f'{NATIVE} and {OTHERS}: ')


@pytest.fixture
def sources(tmp_path):
    """Return a folder with what a build reads: nothing is built in the repository."""
    for name in ('setup.py', 'setup.cfg', 'package.xml'):
        shutil.copy(ROOT / name, tmp_path)
    for folder in (NATIVE, OTHERS):
        shutil.copytree(ROOT / folder, tmp_path / folder, ignore=shutil.ignore_patterns('*.so'))
    return tmp_path


def build(folder, compiler=None):
    """Return what building in a folder gives: exit code and lines of standard error."""
    chosen = {} if compiler is None else {'CC': compiler}
    done = subprocess.run(
        [sys.executable, 'setup.py', 'build_ext', '--inplace'], cwd=folder, text=True,
        capture_output=True, check=False, env={**os.environ, **chosen})
    return done.returncode, done.stderr.splitlines()


def libraries(folder):
    return list((folder / NATIVE).glob('kernels*'))


def test_kernels_are_built_beside_their_sources(sources):
    code, errors = build(sources)
    assert code == 0, errors
    assert len(libraries(sources)) == 1
    load(sources / NATIVE)


@pytest.mark.parametrize('compiler', ['false', 'no-such-compiler'])
def test_a_build_without_a_compiler_fails_with_one_line(sources, compiler):
    code, errors = build(sources, compiler)
    assert code == 1
    (line,) = errors
    assert line.startswith(NEEDED) and compiler in line
    assert not libraries(sources)


def test_a_file_that_does_not_compile_is_named_above_that_line(sources):
    (sources / NATIVE / 'torque.c').write_text('int half = ;\n')
    code, errors = build(sources)
    assert code == 1
    assert errors[0].startswith(f'{NATIVE}/torque.c:1:')
    assert errors[-1].startswith(NEEDED)
    assert not libraries(sources)
