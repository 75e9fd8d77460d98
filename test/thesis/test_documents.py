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

"""The documents about the thesis: what they name exists, and they agree with each other."""

import ast
from itertools import chain
from pathlib import Path
import re

from helpers.places import ROOT
import pytest

ERRATA = (ROOT / 'docs' / 'errata.md').read_text()
EQUATIONS = (ROOT / 'docs' / 'equations.md').read_text()
DOCUMENTS = {'errata.md': ERRATA, 'equations.md': EQUATIONS}

TEST = re.compile(r'`(test/[\w/]+\.py)::(\w+)`')
FUNCTION = re.compile(r'`((?:core|planners|nodes|helpers)(?:\.\w+)+)`')
NUMBER = re.compile(r'(\d|[AC])\.\d+(\.[ab]|-\1\.\d+)?')  # one, or several such as 5.41-5.43
PLACE = re.compile(r'(planned|not built|not needed): .|.*' + FUNCTION.pattern)

# How many equations each chapter and appendix numbers; 5.18 has two halves.
COUNTS = {'3': 18, '4': 13, '5': 68, '6': 8, 'A': 9, 'C': 11}
NUMBERED = {f'{part}.{n}' for part, count in COUNTS.items()
            for n in range(1, count + 1)} - {'5.18'} | {'5.18.a', '5.18.b'}


def definitions(path):
    """Return the names that a module defines at its top, those in a class after a point."""
    names = set()
    for node in ast.parse(path.read_text()).body:
        targets = [node.target] if isinstance(node, ast.AnnAssign) else getattr(
            node, 'targets', [])
        names |= {target.id for target in targets if isinstance(target, ast.Name)}
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            names.add(node.name)
            names |= {f'{node.name}.{inner.name}' for inner in getattr(node, 'body', [])
                      if isinstance(node, ast.ClassDef) and isinstance(inner, ast.FunctionDef)}
    return names


def missing_tests(text):
    return [f'{path}::{name}' for path, name in TEST.findall(text)
            if not (ROOT / path).is_file() or name not in definitions(ROOT / path)]


def missing_functions(text):
    missing = []
    for dotted in FUNCTION.findall(text):
        parts = dotted.split('.')
        folder = ROOT / ('test' if parts[0] == 'helpers' else 'rrr_traj_planner')
        while parts and (folder / parts[0]).is_dir():
            folder /= parts.pop(0)
        module, *name = parts or ['']
        path = folder / f'{module}.py'
        if not name or not path.is_file() or '.'.join(name) not in definitions(path):
            missing.append(dotted)
    return missing


def spread(entry):
    """Return the numbers that an entry such as 5.41-5.43 stands for."""
    first, _, last = entry.partition('-')
    part, start = first.split('.')[:2]
    if not last:
        return [first]
    return [f'{part}.{n}' for n in range(int(start), int(last.split('.')[1]) + 1)]


def rows():
    """Return the cells of every row of a numbered equation."""
    for line in EQUATIONS.splitlines():
        cells = [cell.strip() for cell in line.strip('|').split('|')]
        if NUMBER.fullmatch(cells[0]):
            yield cells


def entries():
    """Return heading and text of every erratum."""
    parts = re.split(r'^##+ ', ERRATA, flags=re.MULTILINE)
    return [part.split('\n', 1) for part in parts if '- printed:' in part]


def numbers_of(heading):
    """Return the equation numbers with which an erratum's heading begins."""
    found = re.match(r'(\([\w.]+\)(, )?)+', heading)
    return re.findall(r'\(([\w.]+)\)', found[0]) if found else []


@pytest.mark.parametrize('name', DOCUMENTS)
def test_every_test_named_in_a_document_exists(name):
    assert missing_tests(DOCUMENTS[name]) == []
    # None escapes the search for being written otherwise.
    assert len(TEST.findall(DOCUMENTS[name])) == DOCUMENTS[name].count('::') > 50


def test_every_function_named_in_a_document_exists():
    assert missing_functions(EQUATIONS) == []
    assert missing_functions(ERRATA) == []
    assert len(FUNCTION.findall(EQUATIONS)) > 50


def test_a_name_that_does_not_exist_would_be_noticed():
    assert missing_tests('`test/core/motion_laws/test_cycloid.py::test_nothing_of_the_kind`') != []
    assert missing_tests('`test/core/test_nothing.py::test_nothing_of_the_kind`') != []
    wrong = ['core.motion_laws.cycloid.nothing', 'core.nothing.ramp', 'core.motion_laws.cycloid']
    assert missing_functions(', '.join(f'`{name}`' for name in wrong)) == wrong
    right = '`core.motion_laws.cycloid.CycloidPiece.at`, `core.arm.limits.UNITS`'
    assert missing_functions(right) == []


def test_every_numbered_equation_has_one_row():
    listed = list(chain.from_iterable(spread(cells[0]) for cells in rows()))
    assert sorted(set(listed)) == sorted(listed)
    assert set(listed) == NUMBERED


def test_every_row_says_how_it_stands_and_where_it_is():
    for number, _, stands, place, test in rows():
        assert stands in ('holds', 'corrected', 'scan'), number
        assert PLACE.match(place), number
        assert TEST.search(test) or (test == 'a definition' and stands == 'holds'), number


def test_every_erratum_says_what_is_printed_what_is_right_why_and_which_test_shows_it():
    assert len(entries()) > 50
    for heading, text in entries():
        assert re.findall(r'^- (\w+):', text, flags=re.MULTILINE) == [
            'printed', 'corrected', 'why', 'test'], heading
        assert TEST.search(text.split('- test:')[1]), heading


def test_corrected_equations_are_those_with_an_erratum():
    corrected = {n for cells in rows() if cells[2] == 'corrected' for n in spread(cells[0])}
    # An erratum about the text beside an equation leaves the equation as it is.
    beside = {'3.4'}
    assert {n for heading, _ in entries() for n in numbers_of(heading)} == corrected | beside


def test_equations_that_the_scan_leaves_open_are_named_there():
    undecided = ERRATA.split('## What the scan does not let one decide')[1]
    for cells in rows():
        if cells[2] == 'scan':
            part, n = cells[0].split('.')
            named = [numbers for start, end in re.findall(
                rf'\({part}\.(\d+)\)(?: to \({part}\.(\d+)\))?', undecided)
                for numbers in range(int(start), int(end or start) + 1)]
            assert int(n) in named, cells[0]


def test_every_test_of_an_erratum_is_named():
    for path in sorted(Path(__file__).parent.glob('test_errata_*.py')):
        tests = {name for name in definitions(path) if name.startswith('test_')}
        assert tests - {name for _, name in TEST.findall(ERRATA + EQUATIONS)} == set(), path.name
