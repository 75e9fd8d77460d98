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

"""The meshes of a URDF: their files, and the triangles in them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple
from urllib.parse import unquote, urlsplit

import numpy as np
from rrr_traj_planner.core.arrays import Array, IntArray
from rrr_traj_planner.core.errors import InvalidInputError

Rgb = tuple[int, int, int]


class Mesh(NamedTuple):
    """Triangles of one colour."""

    vertices: Array       # shape (n, 3) [m]
    faces: IntArray       # shape (k, 3): indices of vertices, counterclockwise from outside
    colour: Rgb | None    # None: the file has none


def mesh_file(name: str, folder: Path) -> Path:
    """
    Return the file of a mesh.

    Parameters
    ----------
    name : str
        package://PACKAGE/PATH, file:///PATH or a path, absolute or relative.
    folder : Path
        Of the URDF: what relative paths refer to; a package that is not installed may be one of
        the folders above it.

    Returns
    -------
    Path
        An existing file.

    Raises
    ------
    InvalidInputError
        If there is none.

    """
    parts = urlsplit(name)
    if parts.scheme not in ('', 'file', 'package'):
        raise InvalidInputError(f'{name}: not a file')
    path = unquote(parts.path) if parts.scheme else name
    tried = [folder / path] if parts.scheme != 'package' else [
        place / path.lstrip('/') for place in _package_folders(parts.netloc, folder)]
    found = next((file for file in tried if file.is_file()), None)
    if found is None:
        what = 'no such file' if tried else f'no package {parts.netloc}'
        raise InvalidInputError(f'{name}: {what}')
    return found


def _package_folders(package: str, folder: Path) -> Iterator[Path]:
    from ament_index_python.packages import get_package_share_path, PackageNotFoundError
    if not package:
        return
    try:
        yield get_package_share_path(package)
    except (PackageNotFoundError, ValueError):  # no such package, no name of one
        pass
    yield from (place for place in (folder, *folder.parents) if place.name == package)


def meshes(name: str, scale: Sequence[float], folder: Path) -> list[Mesh]:
    """
    Return what is in a mesh's file.

    Parameters
    ----------
    name : str
        As in `mesh_file`.
    scale : sequence of 3 floats
        Factors of its axes.
    folder : Path
        Of the URDF.

    Returns
    -------
    list of Mesh
        In metres where the file says its unit (COLLADA does), times the factors; which axis is up
        is left as it is, as RViz does.

    Raises
    ------
    InvalidInputError
        If the file is missing, malformed, of an unknown format or without triangles.

    """
    file = mesh_file(name, folder)
    import trimesh  # comes with viser
    try:
        found = trimesh.load_scene(file, process=False).dump()
    except Exception as error:  # the loaders of many formats raise anything
        why = ' '.join(str(error).split()) or type(error).__name__
        raise InvalidInputError(f'{name}: {why}') from None
    parts = [_mesh(mesh, np.array(scale)) for mesh in found if len(getattr(mesh, 'faces', ()))]
    if not parts:
        raise InvalidInputError(f'{name}: no triangles')
    return parts


def _mesh(mesh: Any, scale: Array) -> Mesh:
    metres, _, unit = str(mesh.metadata.get('units') or '').partition(' * ')
    vertices, faces = np.array(mesh.vertices), np.array(mesh.faces)
    if scale.prod() < 0.0:  # mirrored: inside out
        faces = faces[:, ::-1]
    return Mesh(vertices * scale * (float(metres) if unit else 1.0), faces,
                _colour(mesh.visual) if mesh.visual.defined else None)


def _colour(visual: Any) -> Rgb | None:
    main = getattr(getattr(visual, 'material', visual), 'main_color', None)
    if main is None:
        return None
    red, green, blue = (int(c) for c in main[:3])
    return red, green, blue
