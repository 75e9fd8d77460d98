"""package.xml: well formed, and a key for everything that is imported."""

from __future__ import annotations

import ast
from pathlib import Path
import sys
from xml.etree import ElementTree

from catkin_pkg.package import parse_package
import pytest

ROOT = Path(__file__).parents[1]
PACKAGE = 'rrr_traj_planner'
XML = ElementTree.parse(ROOT / 'package.xml').getroot()

# Keys that differ from the module's name; None where rosdep has no key: an extra of setup.py.
KEYS = {
    'hypothesis': 'python3-hypothesis', 'matplotlib': 'python3-matplotlib', 'mcap': None,
    'mcap_ros2': None, 'mpl_toolkits': 'python3-matplotlib', 'numpy': 'python3-numpy',
    'pytest': 'python3-pytest', 'scipy': 'python3-scipy', 'urdf_parser_py': 'urdfdom_py',
    'yaml': 'python3-yaml', 'catkin_pkg': 'python3-catkin-pkg-modules'}


def imported(folder):
    """Return what modules of a folder import from elsewhere."""
    files = sorted((ROOT / folder).rglob('*.py'))
    names = set()
    for file in files:
        for node in ast.walk(ast.parse(file.read_text())):
            if isinstance(node, ast.Import):
                names |= {alias.name.split('.')[0] for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and not node.level:
                names.add(node.module.split('.')[0])
    return names - set(sys.stdlib_module_names) - {PACKAGE} - {file.stem for file in files}


def keys(*tags):
    return {element.text for tag in tags for element in XML.iter(tag)}


def test_package_xml_is_valid():
    warnings = []
    package = parse_package(str(ROOT / 'package.xml'), warnings=warnings)
    assert (package.name, warnings) == (PACKAGE, [])
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
