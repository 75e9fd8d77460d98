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
from graphlib import CycleError, TopologicalSorter
from importlib import import_module
from importlib.util import find_spec
import sys

from helpers.package import FILES, imports_of, layer_of, LAYERS, MODULES, modules_of, PACKAGE
from helpers.places import ROOT
import pytest
from rrr_traj_planner.planners.registry import planner_ids

NUMERICS = {'numpy', 'scipy'}
KNOWN = MODULES.keys() | {name.removesuffix('.__init__') for name in MODULES}
LONGEST = 300       # lines of a file
MOST_MODULES = 22   # in a folder


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
    assert foreign(('core', 'planners'), NUMERICS) == []


def test_report_needs_matplotlib_besides():
    assert foreign(('report',), {*NUMERICS, 'matplotlib', 'mpl_toolkits'}) == []


def test_nodes_alone_know_ros():
    assert [(module, name) for module in MODULES for name in imports_of(module)
            if layer_of(module) != 'nodes' and is_ros(name)] == []


def test_files_are_short():
    assert {str(path.relative_to(ROOT)): lines for path in FILES
            if (lines := path.read_text().count('\n')) > LONGEST} == {}


def test_folders_hold_few_modules():
    counts = Counter(path.parent for path in FILES if path.name != '__init__.py')
    assert {folder: count for folder, count in counts.items() if count > MOST_MODULES} == {}


def folder_of(module):
    """Return a module's folder below its layer; the module itself where it lies in the layer."""
    return '.'.join(module.removesuffix('.__init__').split('.')[:3])


def imports_of_folders():
    """Return for each folder, and each module beside folders, those that it imports."""
    found = {}
    for module in modules_of(*LAYERS):
        names = imports_of(module) | {name.rpartition('.')[0] for name in imports_of(module)}
        found.setdefault(folder_of(module), set()).update(
            folder_of(name) for name in names & KNOWN)
    return {folder: names - {folder} for folder, names in found.items()}


def test_folders_import_one_another_without_circles():
    list(TopologicalSorter(imports_of_folders()).static_order())


def test_an_import_of_a_whole_package_is_seen():
    assert 'rrr_traj_planner.planners.methods' in imports_of_folders()[
        'rrr_traj_planner.planners.registry']


def test_a_circle_of_folders_would_be_found():
    with pytest.raises(CycleError):
        list(TopologicalSorter({**imports_of_folders(), 'rrr_traj_planner.core.dynamics': {
            'rrr_traj_planner.core.path'}}).static_order())


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
