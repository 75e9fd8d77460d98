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

"""ROS's own linters: those that are among the wheels, the others where apt has installed them."""

from __future__ import annotations

from configparser import ConfigParser
from pathlib import Path
from shutil import which
import subprocess

from helpers.places import ROOT
import pytest

SOURCES = [str(ROOT / name) for name in ('rrr_traj_planner', 'test', 'benchmarks', 'setup.py')]


def flake8_rules(file):
    """Return what a configuration of flake8 says, but for what it leaves out."""
    parser = ConfigParser()
    parser.read_string(file.read_text())
    return {key: value for key, value in parser['flake8'].items() if key != 'extend-exclude'}


def test_code_is_as_ament_flake8_wants_it():
    main = pytest.importorskip('ament_flake8.main')
    assert main.main(argv=SOURCES) == 0


def test_make_lint_has_the_rules_of_ament_flake8():
    package = Path(pytest.importorskip('ament_flake8').__file__).parent
    theirs = flake8_rules(package / 'configuration' / 'ament_flake8.ini')
    assert flake8_rules(ROOT / '.flake8') == theirs


@pytest.mark.skipif(which('make') is None, reason='make is not installed')
def test_make_test_leaves_out_ament_flake8_alone_since_it_runs_flake8():
    commands = subprocess.run(
        ['make', '--dry-run', '--always-make', 'test'], cwd=ROOT, text=True, capture_output=True,
        check=True).stdout
    assert commands.count('flake8') == 2 and commands.count('python -m flake8 ') == 1
    assert commands.count('--deselect') == 1
    name = test_code_is_as_ament_flake8_wants_it.__name__
    assert f' --deselect {Path(__file__).relative_to(ROOT)}::{name} ' in commands


def test_docstrings_are_as_ament_pep257_wants_them():
    main = pytest.importorskip('ament_pep257.main')
    assert main.main(argv=SOURCES) == 0


def test_notices_are_as_ament_copyright_wants_them():
    main = pytest.importorskip('ament_copyright.main')
    files = [str(ROOT / name) for name in ('scripts', 'LICENSE', 'CONTRIBUTING.md')]
    assert main.main(argv=[*SOURCES, *files]) == 0
