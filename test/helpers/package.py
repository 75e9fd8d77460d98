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

"""Syntax trees and layers of the package's modules."""

import ast
from functools import cache

from helpers.places import ROOT

PACKAGE = 'rrr_traj_planner'
FILES = sorted((ROOT / PACKAGE).rglob('*.py'))
MODULES = {'.'.join(path.relative_to(ROOT).with_suffix('').parts): path for path in FILES}

# A layer may import itself and the layers after it.
LAYERS = ('nodes', 'report', 'planners', 'core')


def layer_of(module):
    """Return a module's layer; an empty string for modules outside all layers."""
    parts = module.split('.')
    return parts[1] if len(parts) > 1 and parts[1] in LAYERS else ''


@cache
def tree_of(module):
    """Return a module's syntax tree."""
    return ast.parse(MODULES[module].read_text())


@cache
def imports_of(module):
    """Return the full names of everything that a module imports, anywhere in it."""
    names = set()
    for node in ast.walk(tree_of(module)):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            package = module.split('.')[:-node.level] if node.level else []
            source = '.'.join([*package, *([node.module] if node.module else [])])
            # In "from package import name", the name may be a module.
            names |= {f'{source}.{alias.name}' for alias in node.names}
    return names


def modules_of(*layers):
    return [module for module in MODULES if layer_of(module) in layers]
