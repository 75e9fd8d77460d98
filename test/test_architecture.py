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

"""The rules of layers, folders and files: who imports whom, and how much is in one."""

import ast
from collections import Counter
from functools import cache
from graphlib import CycleError, TopologicalSorter
from importlib import import_module
from importlib.util import find_spec
import re
from subprocess import run
import sys

from helpers.package import FILES, imports_of, layer_of, LAYERS, MODULES, modules_of, PACKAGE
from helpers.places import ROOT
import pytest
from rrr_traj_planner.planners.registry import planner_ids

NUMERICS = {'numpy', 'scipy'}
KNOWN = MODULES.keys() | {name.removesuffix('.__init__') for name in MODULES}
LONGEST = 300       # lines of a file
MOST_MODULES = 22   # in a folder
COLUMN = 26         # of the picture, where the names of folders and modules begin


def is_ros(name):
    top = name.split('.')[0]
    return (top.startswith(('rclpy', 'ament', 'rosidl', 'launch', 'builtin_interfaces'))
            or top.endswith(('_msgs', '_srvs', '_interfaces')))


def test_the_layers_are_there():
    assert all(modules_of(layer) for layer in LAYERS)


def arrows(*layers):
    """Return who imports whom: pairs of names, for all modules of layers."""
    return [(module, name) for module in modules_of(*layers) for name in imports_of(module)]


def foreign(layers, allowed):
    """Return what modules of layers import beside the package, the standard library and more."""
    allowed = {PACKAGE, *sys.stdlib_module_names, *allowed}
    return [arrow for arrow in arrows(*layers) if arrow[1].split('.')[0] not in allowed]


def test_imports_point_from_nodes_to_report_to_planners_to_core():
    assert [(module, name) for module, name in arrows(*LAYERS)
            if name.split('.')[0] == PACKAGE
            and layer_of(name) not in LAYERS[LAYERS.index(layer_of(module)):]] == []


def test_core_and_planners_need_numpy_scipy_and_the_standard_library_alone():
    urdf = (f'{PACKAGE}.core.arm.urdf_document', 'urdf_parser_py.urdf.URDF')
    assert foreign(('core', 'planners'), NUMERICS) == [urdf]


def test_the_core_loads_no_urdf_parser_before_it_reads_one():
    code = ('import sys, rrr_traj_planner.core.arm.urdf_arm; '
            'sys.exit("urdf_parser_py" in sys.modules)')
    assert run([sys.executable, '-c', code], check=False).returncode == 0


def test_report_needs_matplotlib_besides():
    assert foreign(('report',), {*NUMERICS, 'matplotlib', 'mpl_toolkits'}) == []


def test_nodes_alone_know_ros():
    assert [(module, name) for module in MODULES for name in imports_of(module)
            if layer_of(module) != 'nodes' and is_ros(name)] == []


def test_only_what_draws_the_studio_s_page_knows_viser():
    studio = f'{PACKAGE}.nodes.studio'
    found = {module.removeprefix(f'{studio}.').split('.')[0] for module in MODULES
             if any(name.split('.')[0] == 'viser' for name in imports_of(module))}
    assert found == {'chart', 'panel', 'scene', 'web'}


def test_files_are_short():
    assert {str(path.relative_to(ROOT)): lines for path in FILES
            if (lines := path.read_text().count('\n')) > LONGEST} == {}


def test_folders_hold_few_modules():
    counts = Counter(path.parent for path in FILES if path.name != '__init__.py')
    assert {folder: count for folder, count in counts.items() if count > MOST_MODULES} == {}


def place_of(module):
    """Return a module's folder below its layer; the module itself where it lies in the layer."""
    return '.'.join(module.removesuffix('.__init__').split('.')[:3])


@cache
def imports_of_places():
    """Return for each folder, and each module beside folders, those that it imports."""
    found = {}
    for module in modules_of(*LAYERS):
        names = imports_of(module) | {name.rpartition('.')[0] for name in imports_of(module)}
        found.setdefault(place_of(module), set()).update(
            place_of(name) for name in names & KNOWN)
    return {place: names - {place} for place, names in found.items()}


def is_single(place):
    """Return whether a place is a module beside folders."""
    return place in MODULES


def by_folders(imports):
    """Return imports with a layer's single modules as two places: above its folders, and below."""
    above = {place for place in imports if is_single(place)
             and any(layer_of(name) == layer_of(place) and not is_single(name)
                     for name in imports[place])}
    while more := {place for place in imports.keys() - above
                   if is_single(place) and imports[place] & above}:
        above |= more

    def group(place):
        if not is_single(place):
            return place
        return f'{layer_of(place)}, {"above" if place in above else "below"} its folders'

    found = {}
    for place, names in imports.items():
        found.setdefault(group(place), set()).update(map(group, names))
    return {place: names - {place} for place, names in found.items()}


def in_order(imports):
    return list(TopologicalSorter(imports).static_order())


def test_folders_and_the_modules_beside_them_import_one_another_without_circles():
    assert in_order(imports_of_places())
    assert in_order(by_folders(imports_of_places()))


def test_an_import_of_a_whole_package_is_seen():
    assert f'{PACKAGE}.planners.methods' in imports_of_places()[f'{PACKAGE}.planners.registry']


def test_a_circle_of_folders_would_be_found():
    with pytest.raises(CycleError):
        in_order({**imports_of_places(), f'{PACKAGE}.core.dynamics': {f'{PACKAGE}.core.path'}})


def test_a_circle_through_the_modules_beside_a_folder_would_be_found(monkeypatch):
    """A module that imports `transitions` and serves `methods` was once beside the folders."""
    planners, single = f'{PACKAGE}.planners', f'{PACKAGE}.planners.prescribed_by_search'
    there = imports_of_places()
    monkeypatch.setitem(MODULES, single, None)
    imports = {**there, single: {f'{planners}.transitions', f'{planners}.tasks'},
               f'{planners}.methods': {*there[f'{planners}.methods'], single}}
    assert in_order(imports)
    with pytest.raises(CycleError):
        in_order(by_folders(imports))


def rows_of(layer):
    """Return the rows of a layer in the picture of docs/architecture.md, by names."""
    picture = (ROOT / 'docs/architecture.md').read_text().split('```')[1]
    text = picture[picture.index(f'\n{layer} ') + 1:].split('\n   |\n')[0]
    return [re.sub(r'\(.*?\)', '', line[COLUMN:]).split() for line in text.splitlines()]


@pytest.mark.parametrize('layer', ['nodes', 'planners', 'core'])
def test_the_picture_shows_every_folder_and_module_above_what_it_imports(layer):
    row = {f'{PACKAGE}.{layer}.{name}': k for k, names in enumerate(rows_of(layer))
           for name in names}
    places = {place: names for place, names in imports_of_places().items()
              if layer_of(place) == layer and place.count('.') == 2}
    assert row.keys() == places.keys()
    assert [(place, name) for place, names in places.items() for name in names & row.keys()
            if row[name] <= row[place]] == []


def test_the_files_of_methods_are_the_planner_ids():
    names = [m.split('.')[-1] for m in MODULES if '.planners.methods.' in m]
    assert sorted(set(names) - {'__init__'}) == planner_ids()


def test_benchmarks_import_only_what_the_package_has():
    """No test runs them: a renamed function would be noticed by the next user of `make bench`."""
    missing = []
    for file in sorted((ROOT / 'benchmarks').glob('*.py')):
        for node in ast.walk(ast.parse(file.read_text())):
            if not isinstance(node, ast.ImportFrom) or not node.module.startswith(PACKAGE):
                continue
            module = import_module(node.module)
            names = {f'{node.module}.{alias.name}' for alias in node.names
                     if not hasattr(module, alias.name)}
            is_package = hasattr(module, '__path__')
            missing += [f'{file.name}: {name}' for name in names
                        if not (is_package and find_spec(name))]
    assert not missing
