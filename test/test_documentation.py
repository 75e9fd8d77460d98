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

"""Everything public is documented: what it is, and each of its parameters."""

import ast
from functools import cache

from helpers.package import MODULES, modules_of, tree_of


@cache
def classes_by_name():
    """Return every class of the package with the names of its bases."""
    found = {}
    for module in MODULES:
        for node in ast.walk(tree_of(module)):
            if isinstance(node, ast.ClassDef):
                found[node.name] = node
    return found


def is_public(name):
    return not name.startswith('_')


def public_definitions(module):
    """Return public functions and classes with their dotted names, methods with their class."""
    for node in tree_of(module).body:
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
        base = classes_by_name().get(getattr(base, 'id', getattr(base, 'attr', '')))
        if base is None:
            continue
        same = [m for m in base.body
                if isinstance(m, ast.FunctionDef) and m.name == method.name]
        if any(has_parameters_section(m) for m in same) or is_documented_by_a_base(method, base):
            return True
    return False


def has_parameters_section(node):
    return '\nParameters\n----------\n' in (ast.get_docstring(node) or '')


def undocumented(wrong):
    """Return the public definitions of the layers without ROS that break a rule."""
    return [f'{module}: {name}' for module in modules_of('core', 'planners', 'report')
            for name, node, owner in public_definitions(module) if wrong(node, owner)]


def is_function(node):
    return isinstance(node, ast.FunctionDef)


def test_every_module_says_what_it_is():
    assert [module for module in MODULES if not ast.get_docstring(tree_of(module))] == []


def test_every_public_function_class_and_method_is_documented():
    assert undocumented(lambda node, _: not ast.get_docstring(node)) == []


def test_every_public_function_with_parameters_describes_them():
    assert undocumented(
        lambda node, owner: is_function(node) and parameters_of(node, owner)
        and not has_parameters_section(node)
        and not (owner and is_documented_by_a_base(node, owner))) == []


def described(node):
    """Return the names that the section of parameters describes."""
    section = ast.get_docstring(node).split('\nParameters\n----------\n')[1]
    return {word.strip(' *') for line in section.split('\n\n')[0].splitlines()
            if not line.startswith(' ') for word in line.split(' : ')[0].split(',')}


def test_parameters_sections_name_every_parameter():
    assert undocumented(
        lambda node, owner: is_function(node) and has_parameters_section(node)
        and set(parameters_of(node, owner)) - described(node)) == []
