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

"""The meshes of a URDF: where their files are looked for, and what is in them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.nodes.output.mesh_files import mesh_file, meshes

TRIANGLE = ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 2.0, 0.0))

STL = """solid part
facet normal 0 0 1
outer loop
vertex 0 0 0
vertex 1 0 0
vertex 0 2 0
endloop
endfacet
endsolid part
"""

OBJ = """v 0 0 0
v 1 0 0
v 0 2 0
f 1 2 3
"""

DAE = """<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><created>2026-01-01T00:00:00</created><modified>2026-01-01T00:00:00</modified>
<unit name="centimetre" meter="0.01"/><up_axis>Y_UP</up_axis></asset>
<library_effects><effect id="e"><profile_COMMON><technique sid="t"><phong>
<diffuse><color>1 0 0 1</color></diffuse></phong></technique></profile_COMMON></effect>
</library_effects>
<library_materials><material id="m" name="m"><instance_effect url="#e"/></material>
</library_materials>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="f" count="9">0 0 0 100 0 0 0 200 0</float_array>
<technique_common><accessor source="#f" count="3" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1" material="s"><input semantic="VERTEX" source="#v" offset="0"/>
<p>0 1 2</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node><instance_geometry url="#g"><bind_material>
<technique_common><instance_material symbol="s" target="#m"/></technique_common></bind_material>
</instance_geometry></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>
"""


@pytest.fixture
def package(tmp_path):
    """Give a test a package of an arm with meshes, and its folder of URDFs."""
    (tmp_path / 'arm_description' / 'meshes').mkdir(parents=True)
    (tmp_path / 'arm_description' / 'urdf').mkdir()
    (tmp_path / 'arm_description' / 'meshes' / 'a b.stl').write_text(STL)
    return tmp_path / 'arm_description'


@pytest.mark.parametrize('name', [
    'package://arm_description/meshes/a b.stl', 'package://arm_description/meshes/a%20b.stl',
    '../meshes/a b.stl', '{}/meshes/a b.stl', 'file://{}/meshes/a b.stl'])
def test_files_are_found_by_package_by_address_and_by_path(package, name):
    file = mesh_file(name.format(package), package / 'urdf')
    assert file.resolve() == package / 'meshes' / 'a b.stl'


def test_installed_packages_are_found_anywhere(tmp_path):
    file = mesh_file('package://rrr_traj_planner/config/thesis_arm.yaml', tmp_path)
    assert file.name == 'thesis_arm.yaml' and file.is_file()


@pytest.mark.parametrize(('name', 'why'), [
    ('package://no_such_package/a.stl', 'no package no_such_package'), ('a.stl', 'no such file'),
    ('package://arm_description/a.stl', 'no such file'), ('https://host/a.stl', 'not a file'),
    ('package:///a.stl', 'no package')])
def test_what_is_not_found_is_named(package, name, why):
    with pytest.raises(InvalidInputError, match=why) as caught:
        mesh_file(name, package)
    assert name in str(caught.value)


@pytest.mark.parametrize(('name', 'text'), [('a.stl', STL), ('a.obj', OBJ), ('a.DAE', DAE)])
def test_triangles_are_in_metres_and_scaled(tmp_path, name, text):
    pytest.importorskip('trimesh', reason='trimesh is not installed: make studio installs it')
    if text is DAE:
        pytest.importorskip('collada', reason='pycollada is not installed: make studio does')
    (tmp_path / name).write_text(text)
    mesh, = meshes(name, (2.0, 3.0, 1.0), tmp_path)
    np.testing.assert_allclose(mesh.vertices[mesh.faces[0]], np.array(TRIANGLE) * (2, 3, 1))
    assert mesh.colour == ((255, 0, 0) if text is DAE else None)
    mesh, = meshes(name, (-1.0, 1.0, 1.0), tmp_path)
    a, b, c = mesh.vertices[mesh.faces[0]]
    assert np.cross(b - a, c - a)[2] > 0.0  # mirrored, and outside still


@pytest.mark.parametrize(('name', 'text'), [
    ('a.stl', 'solid'), ('a.dae', '<COLLADA'), ('a.xyz123', STL), ('a.obj', 'v 0 0 0')])
def test_malformed_file_is_named(tmp_path, name, text):
    pytest.importorskip('trimesh', reason='trimesh is not installed: make studio installs it')
    Path(tmp_path, name).write_text(text)
    with pytest.raises(InvalidInputError, match=f'^{name}: ..'):
        meshes(name, (1.0, 1.0, 1.0), tmp_path)
