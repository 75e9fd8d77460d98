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

"""The layers' rules: who imports whom, and that everything public is documented."""

import ast
from graphlib import CycleError, TopologicalSorter
import sys

from helpers.places import ROOT
import pytest
from rrr_traj_planner.planners.registry import planner_ids

PACKAGE = 'rrr_traj_planner'
MODULES = {
    '.'.join(path.relative_to(ROOT).with_suffix('').parts): ast.parse(path.read_text())
    for path in sorted((ROOT / PACKAGE).rglob('*.py'))}

# Arrows point only this way: a layer sees itself and those after it.
LAYERS = ('nodes', 'report', 'planners', 'core')
NUMERICS = {'numpy', 'scipy'}


def layer_of(module):
    """Return a module's layer; an empty text for what lies on top of all layers."""
    parts = module.split('.')
    return parts[1] if len(parts) > 1 and parts[1] in LAYERS else ''


def imports_of(module):
    """Return the full names of what a module imports, wherever in it."""
    names = set()
    for node in ast.walk(MODULES[module]):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            package = module.split('.')[:-node.level] if node.level else []
            source = '.'.join([*package, *([node.module] if node.module else [])])
            # "from package import name" may name a module as well as what is in one.
            names |= {f'{source}.{alias.name}' for alias in node.names}
    return names


def modules_of(*layers):
    return [module for module in MODULES if layer_of(module) in layers]


def is_ros(name):
    top = name.split('.')[0]
    return (top.startswith(('rclpy', 'ament', 'rosidl', 'launch', 'builtin_interfaces'))
            or top.endswith(('_msgs', '_srvs', '_interfaces')))


def test_the_layers_are_there():
    assert all(modules_of(layer) for layer in LAYERS)


@pytest.mark.parametrize('module', MODULES)
def test_imports_point_from_nodes_to_report_to_planners_to_core(module):
    if not layer_of(module):
        return
    below = LAYERS[LAYERS.index(layer_of(module)):]
    inner = [name for name in imports_of(module) if name.split('.')[0] == PACKAGE]
    assert [name for name in inner if layer_of(name) not in below] == []


@pytest.mark.parametrize('module', modules_of('core', 'planners'))
def test_core_and_planners_need_numpy_scipy_and_the_standard_library_alone(module):
    allowed = {PACKAGE, *NUMERICS, *sys.stdlib_module_names}
    assert [name for name in imports_of(module) if name.split('.')[0] not in allowed] == []


@pytest.mark.parametrize('module', modules_of('report'))
def test_report_needs_matplotlib_besides(module):
    allowed = {PACKAGE, *NUMERICS, 'matplotlib', 'mpl_toolkits', *sys.stdlib_module_names}
    assert [name for name in imports_of(module) if name.split('.')[0] not in allowed] == []


@pytest.mark.parametrize('module', MODULES)
def test_nodes_alone_know_ros(module):
    if layer_of(module) != 'nodes':
        assert [name for name in imports_of(module) if is_ros(name)] == []


def folder_of(module):
    """Return a module's folder below its layer; the module itself where it lies in the layer."""
    return '.'.join(module.split('.')[:3])


def imports_of_folders():
    """Return for each folder, and each module beside folders, those that it imports."""
    found = {}
    for module in modules_of(*LAYERS):
        names = imports_of(module) | {name.rpartition('.')[0] for name in imports_of(module)}
        found.setdefault(folder_of(module), set()).update(
            folder_of(name) for name in names & MODULES.keys())
    return {folder: names - {folder} for folder, names in found.items()}


def test_folders_import_one_another_without_circles():
    list(TopologicalSorter(imports_of_folders()).static_order())


def test_a_circle_of_folders_would_be_found():
    with pytest.raises(CycleError):
        list(TopologicalSorter({**imports_of_folders(), 'rrr_traj_planner.core.dynamics': {
            'rrr_traj_planner.core.path'}}).static_order())


def test_the_files_of_methods_are_the_planner_ids():
    names = [m.split('.')[-1] for m in MODULES if '.planners.methods.' in m]
    assert sorted(set(names) - {'__init__'}) == planner_ids()


def classes_by_name():
    """Return every class of the package with the names of its bases."""
    found = {}
    for tree in MODULES.values():
        for node in ast.walk(tree):
            if isinstance(node, ast.ClassDef):
                found[node.name] = node
    return found


CLASSES = classes_by_name()


def is_public(name):
    return not name.startswith('_')


def public_definitions(module):
    """Return public functions and classes with their dotted names, methods with their class."""
    for node in MODULES[module].body:
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)) and is_public(node.name):
            yield node.name, node, None
        if isinstance(node, ast.ClassDef) and is_public(node.name):
            for inner in node.body:
                if isinstance(inner, ast.FunctionDef) and is_public(inner.name):
                    yield f'{node.name}.{inner.name}', inner, node


def parameters_of(function, owner):
    """Return the names of a function's parameters, without self or cls."""
    arguments = function.args
    names = [a.arg for a in (*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs)]
    names += [a.arg for a in (arguments.vararg, arguments.kwarg) if a]
    static = any(getattr(d, 'id', '') == 'staticmethod' for d in function.decorator_list)
    return names[1:] if owner and not static else names


def is_documented_by_a_base(method, owner):
    """Return whether a base class of the package describes the method's parameters already."""
    for base in owner.bases:
        base = CLASSES.get(getattr(base, 'id', getattr(base, 'attr', '')))
        if base is None:
            continue
        same = [m for m in base.body
                if isinstance(m, ast.FunctionDef) and m.name == method.name]
        if any(has_parameters_section(m) for m in same) or is_documented_by_a_base(method, base):
            return True
    return False


def has_parameters_section(node):
    return '\nParameters\n----------\n' in (ast.get_docstring(node) or '')


@pytest.mark.parametrize('module', MODULES)
def test_every_module_says_what_it_is(module):
    assert ast.get_docstring(MODULES[module]), module


@pytest.mark.parametrize('module', modules_of('core', 'planners', 'report'))
def test_every_public_function_class_and_method_is_documented(module):
    bare = [name for name, node, _ in public_definitions(module) if not ast.get_docstring(node)]
    assert bare == []


@pytest.mark.parametrize('module', modules_of('core', 'planners', 'report'))
def test_every_public_function_with_parameters_describes_them(module):
    bare = [name for name, node, owner in public_definitions(module)
            if isinstance(node, ast.FunctionDef) and parameters_of(node, owner)
            and not has_parameters_section(node)
            and not (owner and is_documented_by_a_base(node, owner))]
    assert bare == []


@pytest.mark.parametrize('module', modules_of('core', 'planners', 'report'))
def test_parameters_sections_name_every_parameter(module):
    missing = []
    for name, node, owner in public_definitions(module):
        if isinstance(node, ast.FunctionDef) and has_parameters_section(node):
            section = ast.get_docstring(node).split('\nParameters\n----------\n')[1]
            described = {word.strip(' *') for line in section.split('\n\n')[0].splitlines()
                         if not line.startswith(' ') for word in line.split(' : ')[0].split(',')}
            missing += [f'{name}: {parameter}' for parameter in parameters_of(node, owner)
                        if parameter not in described]
    assert missing == []
