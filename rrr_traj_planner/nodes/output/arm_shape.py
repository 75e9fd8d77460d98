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

"""The shapes that the arm is drawn with: its URDF's, and rods where these cannot be read."""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, sqrt
from pathlib import Path
from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arm.urdf import FrameNames, urdf
from rrr_traj_planner.core.arm.urdf_frames import (
    LinkFrame,
    MovingFrame,
    Placement,
    urdf_frames,
    UrdfFrames,
)
from rrr_traj_planner.core.arm.urdf_visuals import UnreadVisual, urdf_visuals, Visual
from rrr_traj_planner.core.arrays import Array, IntArray
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.rotations import quaternion, rotation
from rrr_traj_planner.nodes.output.mesh_files import meshes, Rgb
from rrr_traj_planner.nodes.parameters.configuration import PlannerConfig

BODIES = 4  # that move: the base, and what is behind each joint


class Part(NamedTuple):
    """A shape in its link's frame; a mesh has vertices and faces, others a size."""

    kind: str                            # as in `Visual`
    size: tuple[float, ...]
    placement: Placement
    colour: Rgb | None = None
    vertices: Array = np.zeros((0, 3))   # [m]
    faces: IntArray = np.zeros((0, 3), dtype=np.int64)


class ShownLink(NamedTuple):
    """A link, and where it is in its parent."""

    parent: int                          # index of the parent; -1: the base frame
    frame: Placement | MovingFrame
    parts: tuple[Part, ...]


class ArmShape(NamedTuple):
    """What is drawn of an arm."""

    links: tuple[ShownLink, ...]         # parents first
    notes: tuple[str, ...]               # what cannot be drawn, one for a link


def arm_shape(config: PlannerConfig, folder: Path) -> ArmShape:
    """
    Return what is drawn of an arm.

    Parameters
    ----------
    config : PlannerConfig
        The arm, and its URDF.
    folder : Path
        Of the URDF's file.

    Returns
    -------
    ArmShape
        Links with the URDF's shapes. What moves as one with a link that has a shape that cannot
        be read, or has none at all, has rods besides.

    """
    names, base = config.model.joint_names, FrameNames().base
    rods = _found(urdf(config.model, config.limits, FrameNames()), names, base, folder)
    if not config.urdf:
        return ArmShape(tuple(one.link for one in rods), ())
    found = _found(config.urdf, names, config.base_frame, folder)
    drawn = {one.body for one in found if one.link.parts}
    with_rods = (set(range(BODIES)) - drawn) | {one.body for one in found if one.note}
    links = [one.link for one in found]
    for link, body, _ in rods:
        links.append(link._replace(parent=-1 if link.parent < 0 else link.parent + len(found),
                                   parts=link.parts if body in with_rods else ()))
    return ArmShape(tuple(links), tuple(one.note for one in found if one.note))


class _Found(NamedTuple):
    """A link, the body that it is a part of, and what of it cannot be drawn."""

    link: ShownLink
    body: int  # number of the last joint of the arm before it; 0: none
    note: str


def _found(text: str, joint_names: Sequence[str], base: str, folder: Path) -> list[_Found]:
    """Return a URDF's links, parents first."""
    frames, visuals = urdf_frames(text, joint_names), urdf_visuals(text)
    children: dict[str, list[LinkFrame]] = {}
    for frame in (*frames.fixed, *frames.moving):
        children.setdefault(frame.parent, []).append(frame)
    root = next(iter(visuals.keys() - {f.child for f in (*frames.fixed, *frames.moving)}))
    found: list[_Found] = []
    waiting: list[tuple[str, int, Placement | MovingFrame, int]] = [
        (root, -1, _root(frames, root, base), 0)]
    while waiting:
        name, parent, place, body = waiting.pop(0)
        parts, why = _parts(visuals[name], folder)
        number, note = len(found), f'{name} is drawn as rods: {why}' if why else ''
        found.append(_Found(ShownLink(parent, place, parts), body, note))
        for frame in children.get(name, ()):
            if isinstance(frame, MovingFrame):
                waiting.append((frame.child, number, frame, frame.joint + 1))
            else:
                waiting.append((frame.child, number, frame.placement, body))
    return found


def _root(frames: UrdfFrames, root: str, base: str) -> Placement:
    """Return where the root is in the base frame, the frame of one of the fixed links."""
    above, pose = {frame.child: frame for frame in frames.fixed}, np.eye(4)
    while base != root and base in above:
        pose = _matrix(above[base].placement) @ pose
        base = above[base].parent
    return _placement(np.linalg.inv(pose))


def _parts(visuals: tuple[Visual | UnreadVisual, ...], folder: Path
           ) -> tuple[tuple[Part, ...], str]:
    """Return the shapes of a link that can be read, and why the first that cannot is not."""
    parts: list[Part] = []
    why = ''
    for visual in visuals:
        try:
            if isinstance(visual, UnreadVisual):
                raise InvalidInputError(visual.why)
            parts += _shapes(visual, folder)
        except InvalidInputError as error:
            why = why or str(error)
    return tuple(parts), why


def _shapes(visual: Visual, folder: Path) -> list[Part]:
    """Return a shape; a file of a mesh may have several."""
    place, colour = _placement(visual.pose), None
    if visual.colour is not None:
        red, green, blue = (round(255.0 * c) for c in visual.colour)
        colour = red, green, blue
    if visual.kind != 'mesh':
        return [Part(visual.kind, visual.size, place, colour)]
    return [Part('mesh', (), place, colour or mesh.colour, mesh.vertices, mesh.faces)
            for mesh in meshes(visual.file, visual.size, folder)]


def _placement(pose: Array) -> Placement:
    x, y, z = pose[:3, 3].tolist()
    return Placement((x, y, z), quaternion(pose[:3, :3]))


def _matrix(place: Placement) -> Array:
    """Return a placement as a transform, shape (4, 4)."""
    pose = np.eye(4)
    half = sqrt(sum(c * c for c in place.turn[:3]))
    if half > 0.0:
        pose[:3, :3] = rotation(np.array(place.turn[:3]) / half, 2.0 * atan2(half, place.turn[3]))
    pose[:3, 3] = place.origin
    return pose
