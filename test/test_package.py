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

"""package.xml: as its schema has it, and a key for everything that is imported."""

from __future__ import annotations

import ast
import sys
from xml.etree import ElementTree

from catkin_pkg.package import parse_package
from helpers.places import ROOT
from lxml import etree
import pytest

PACKAGE = 'rrr_traj_planner'
STAND_INS = tuple(f'scripts/ros_messages/{name}' for name in ('control_msgs', 'tf2_msgs'))
PACKAGES = ('.', 'rrr_traj_planner_interfaces', *STAND_INS)
XML = ElementTree.parse(ROOT / 'package.xml').getroot()

# Keys that differ from the module's name; None where it may be missing: what needs it says so, and
# its tests are skipped. mcap, mcap_ros2 and rosbags (`--record`), viser with its
# websockets, trimesh and collada (`studio`) are pip's alone.
KEYS = {
    'catkin_pkg': 'python3-catkin-pkg-modules', 'collada': None,
    'hypothesis': 'python3-hypothesis',
    'lxml': 'python3-lxml', 'matplotlib': 'python3-matplotlib', 'mcap': None, 'mcap_ros2': None,
    'mpl_toolkits': 'python3-matplotlib', 'numpy': 'python3-numpy', 'pytest': 'python3-pytest',
    'rosbags': None, 'scipy': 'python3-scipy', 'tf2_ros': 'tf2_ros_py', 'trimesh': None,
    'urdf_parser_py': 'urdfdom_py', 'viser': None, 'websockets': None,
    'yaml': 'python3-yaml'}


def imported(folder):
    """Return what modules of a folder import from elsewhere, or skip tests without."""
    files = sorted((ROOT / folder).rglob('*.py'))
    names = set()
    for file in files:
        for node in ast.walk(ast.parse(file.read_text())):
            if isinstance(node, ast.Import):
                names |= {alias.name.split('.')[0] for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and not node.level:
                names.add(node.module.split('.')[0])
            elif isinstance(node, ast.Call) and ast.unparse(node.func) == 'pytest.importorskip':
                names.add(ast.literal_eval(node.args[0]).split('.')[0])
    own = {PACKAGE, 'helpers'} | {file.stem for file in files}
    return names - set(sys.stdlib_module_names) - own


def keys(*tags):
    return {element.text for tag in tags for element in XML.iter(tag)}


@pytest.mark.parametrize('folder', PACKAGES)
def test_package_xml_keeps_to_its_schema(folder):
    """Do what ament_xmllint does with xmllint, which fetches the schema at every call."""
    xml = etree.parse(ROOT / folder / 'package.xml')
    (model,) = xml.xpath('/processing-instruction("xml-model")')
    file = ROOT / 'test' / 'schema' / model.get('href').rpartition('/')[2]
    etree.XMLSchema(etree.parse(file)).assertValid(xml)


@pytest.mark.parametrize('folder', PACKAGES)
def test_package_xml_raises_no_warning(folder):
    warnings = []
    parse_package(str(ROOT / folder / 'package.xml'), warnings=warnings)
    assert warnings == []


def test_licence_that_package_xml_names_is_there():
    package = parse_package(str(ROOT / 'package.xml'))
    assert (package.name, package.licenses[0]) == (PACKAGE, 'Apache-2.0')
    assert (ROOT / package.licenses[0].file).is_file()


@pytest.mark.parametrize(('folder', 'tags'), [
    (PACKAGE, ('depend', 'exec_depend')),
    ('test', ('depend', 'exec_depend', 'test_depend'))])
def test_everything_that_is_imported_has_its_key(folder, tags):
    needed = {KEYS.get(name, name) for name in imported(folder)} - {None}
    assert needed - keys(*tags) == set()


def test_no_key_is_idle():
    used = {KEYS.get(name, name) for name in imported(PACKAGE) | imported('test')}
    assert keys('depend', 'exec_depend', 'test_depend') - used == set()


def test_no_key_stands_twice():
    for tag in ('exec_depend', 'test_depend'):
        found = [element.text for element in XML.iter(tag)]
        assert len(found) == len(set(found))
