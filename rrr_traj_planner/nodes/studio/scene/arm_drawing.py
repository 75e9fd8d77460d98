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

"""The arm in the page's scene: the shapes of its links, which move with its joints."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

from rrr_traj_planner.core.arm.urdf_frames import MovingFrame, Placement
from rrr_traj_planner.nodes.output.arm_shape import ArmShape, Part
from rrr_traj_planner.nodes.output.mesh_files import Rgb
import viser


class Look(NamedTuple):
    """How an arm is drawn."""

    colour: Rgb                    # of shapes that have none
    has_own: bool = True           # whether shapes have their own colours
    opacity: float | None = None   # None: opaque


class ArmDrawing:
    """
    An arm.

    Parameters
    ----------
    scene : viser.SceneApi
        Where to draw.
    name : str
        In the scene.
    shape : ArmShape
        What is drawn.
    look : Look
        How.

    """

    def __init__(self, scene: viser.SceneApi, name: str, shape: ArmShape, look: Look) -> None:
        self._moving: list[tuple[Any, MovingFrame]] = []
        self._root = scene.add_frame(name, show_axes=False, visible=False)
        names: list[str] = []
        for number, link in enumerate(shape.links):
            names.append(f'{names[link.parent] if link.parent >= 0 else name}/{number}')
            place = link.frame.placement if isinstance(link.frame, MovingFrame) else link.frame
            node = scene.add_frame(names[-1], show_axes=False, **_placed(place))
            if isinstance(link.frame, MovingFrame):
                self._moving.append((node, link.frame))
            for i, part in enumerate(link.parts):
                _add(scene, f'{names[-1]}/shape_{i}', part, look)

    def show(self, joints: Sequence[float] | None) -> None:
        """
        Show the arm, or hide it.

        Parameters
        ----------
        joints : sequence of 3 floats, optional
            Joint positions [rad]; None: it is hidden.

        """
        self._root.visible = joints is not None
        for node, frame in self._moving if joints is not None else ():
            placed = _placed(frame.at(joints))
            node.position, node.wxyz = placed['position'], placed['wxyz']


def _placed(place: Placement) -> dict[str, Any]:
    """Return a placement as viser has it."""
    x, y, z, w = place.turn
    return {'position': place.origin, 'wxyz': (w, x, y, z)}


def _add(scene: viser.SceneApi, name: str, part: Part, look: Look) -> None:
    """Add a shape below its link."""
    own = part.colour if look.has_own else None
    how = {'color': look.colour if own is None else own, 'opacity': look.opacity,
           **_placed(part.placement)}
    if part.kind == 'mesh':
        scene.add_mesh_simple(name, part.vertices, part.faces, flat_shading=True, **how)
    elif part.kind == 'box':
        scene.add_box(name, dimensions=part.size, **how)
    elif part.kind == 'cylinder':
        scene.add_cylinder(name, *part.size, **how)
    else:
        scene.add_icosphere(name, *part.size, **how)
