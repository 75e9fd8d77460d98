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
import re
from shutil import which
import subprocess
import sys

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


def test_docstrings_are_as_ament_pep257_wants_them():
    main = pytest.importorskip('ament_pep257.main')
    assert main.main(argv=SOURCES) == 0


def test_make_lint_has_the_rules_of_ament_flake8():
    package = Path(pytest.importorskip('ament_flake8').__file__).parent
    theirs = flake8_rules(package / 'configuration' / 'ament_flake8.ini')
    assert flake8_rules(ROOT / '.flake8') == theirs


def test_make_lint_has_the_rules_of_ament_pep257():
    """Both leave them to pydocstyle, flake8 by a plugin."""
    theirs = pytest.importorskip('ament_pep257.main')._ament_ignore
    rules = flake8_rules(ROOT / '.flake8')['extend-ignore'].split(',')
    assert [rule for rule in rules if rule.startswith('D')] == theirs
    versions = subprocess.run(
        [sys.executable, '-m', 'flake8', '--version'], text=True, capture_output=True,
        check=True).stdout
    assert 'flake8-docstrings: ' in versions.replace('\n', '')


@pytest.mark.skipif(which('make') is None, reason='make is not installed')
def test_make_test_leaves_out_what_lint_has_checked_and_nothing_else():
    commands = subprocess.run(
        ['make', '--dry-run', '--always-make', 'test'], cwd=ROOT, text=True, capture_output=True,
        check=True).stdout
    assert commands.count('python -m flake8 ') == 1
    left_out = {f'{Path(__file__).relative_to(ROOT)}::{test.__name__}' for test in (
        test_code_is_as_ament_flake8_wants_it, test_docstrings_are_as_ament_pep257_wants_them)}
    assert set(re.findall(r'--deselect (\S+)', commands)) == left_out


def test_notices_are_as_ament_copyright_wants_them():
    main = pytest.importorskip('ament_copyright.main')
    files = [str(ROOT / name) for name in ('scripts', 'LICENSE', 'CONTRIBUTING.md')]
    assert main.main(argv=[*SOURCES, *files]) == 0
