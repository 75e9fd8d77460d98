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

"""The page's scene: arm and reach, the via points with their handles, planned and driven path."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from textwrap import fill
from typing import Any, Protocol

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.kinematics.link_positions import Point
from rrr_traj_planner.core.kinematics.reach import Surface
from rrr_traj_planner.nodes.output.arm_shape import ArmShape
from rrr_traj_planner.nodes.studio.figures import path_colours
from rrr_traj_planner.nodes.studio.planned import Planned
from rrr_traj_planner.nodes.studio.scene.arm_drawing import ArmDrawing, Look
from rrr_traj_planner.nodes.studio.scene.lines import grid, Path, spread
from rrr_traj_planner.nodes.studio.session import Refusal
import viser

ARM, GHOST = Look((70, 90, 120)), Look((150, 170, 200), has_own=False, opacity=0.4)
VIA, CHOSEN, AT_FAULT = (245, 140, 30), (250, 205, 60), (200, 30, 30)
DRIVEN, REACH, GRID = (0, 150, 130), (90, 150, 220), (150, 150, 150)
REACH_OPACITY = 0.15

# Light from all sides, beside viser's two lamps, in place of the surroundings that viser has
# reflected: these and shadows take two thirds of a picture's time where a processor draws it.
SKY, GROUND, BRIGHTNESS = (255, 255, 255), (170, 175, 190), 2.3

# Sizes, as fractions of the arm's.
BALL, HANDLE, AXES = 0.018, 0.16, 0.1
SEGMENT = 0.01       # least one of the planned path: short ones are drawn over each other
GRID_CELL, CELLS = 0.2, 8  # of the grid; from its middle to each side
CHOSEN_SCALE = 1.5  # of a ball
PLAN_LINE, DRIVEN_LINE, GRID_LINE = 6.0, 2.0, 0.6  # pixels
COLUMNS = 28  # characters of a refusal's line beside its via point


class PointEvents(Protocol):
    """What the user does with via points in the scene; any thread may call it."""

    def choose(self, index: int) -> None:
        """Take a click on a via point."""

    def drag(self, index: int, begins: bool, then: Callable[[], None] = lambda: None) -> None:
        """Take the begin or the end of a drag; call a function when it has been taken."""

    def move(self, index: int, position: Point) -> None:
        """Take the position [m] of a via point that is dragged."""


class Scene:
    """
    What is drawn in three dimensions, in the arm's base frame.

    Parameters
    ----------
    scene : viser.SceneApi
        Where to draw.
    size : float
        The arm's [m].
    events : PointEvents
        Gets what the user does with via points.
    shape : ArmShape
        What is drawn of the arm.

    """

    def __init__(self, scene: viser.SceneApi, size: float, events: PointEvents,
                 shape: ArmShape) -> None:
        self._scene, self._size, self._events = scene, size, events
        self._points: list[_Handle] = []
        self._arm = ArmDrawing(scene, '/arm', shape, ARM)
        self._ghost = ArmDrawing(scene, '/ghost', shape, GHOST)
        self._reach: viser.MeshHandle | None = None
        self._plan = Path(scene, '/plan', PLAN_LINE)
        self._driven = Path(scene, '/driven', DRIVEN_LINE)
        scene.configure_default_lights(cast_shadow=False)
        scene.configure_environment_map(None)
        scene.add_light_hemisphere(
            '/light', sky_color=SKY, ground_color=GROUND, intensity=BRIGHTNESS,
            position=(0.0, 0.0, 1.0))  # where the sky is
        scene.add_line_segments('/grid', GRID_CELL * size * grid(CELLS), GRID, thickness=GRID_LINE,
                                thickness_units='screen')
        scene.add_frame('/base', axes_length=AXES * size, axes_radius=0.05 * AXES * size)

    def show_points(self, points: Array, refusal: Refusal | None) -> None:
        """
        Show the via points; one that is dragged stays where the user has it.

        Parameters
        ----------
        points : ndarray, shape (n, 3)
            [m].
        refusal : Refusal, optional
            Tells which one is red, and why.

        """
        while len(self._points) > len(points):
            self._points.pop().remove()
        while len(self._points) < len(points):
            index = len(self._points)
            self._points.append(
                _Handle(self._scene, index, points[index], self._size, self._events))
        distances = np.linalg.norm(points[:, None] - points, axis=2)
        for index, handle in enumerate(self._points):
            handle.put(points[index])
            here = np.flatnonzero(distances[index] < BALL * self._size).tolist()
            handle.mark(refusal.text if refusal is not None and refusal.via_point == index
                        else '', here if here[0] == index else [])

    def show_chosen(self, chosen: int) -> None:
        """
        Show which via point is chosen.

        Parameters
        ----------
        chosen : int
            Its index.

        """
        for index, handle in enumerate(self._points):
            handle.choose(index == chosen)

    def show_plan(self, plan: Planned | None, is_current: bool, meaning: str) -> None:
        """
        Show the planned path.

        Parameters
        ----------
        plan : Planned, optional
            None: there is nothing to show yet.
        is_current : bool
            Whether it is coloured; else it is grey.
        meaning : str
            Of the colours, as in `path_colours`.

        """
        if plan is not None:
            kept = spread(plan.path, SEGMENT * self._size)
            colours = path_colours(plan, meaning, is_current)
            self._plan.show(plan.path[kept], np.stack(
                (colours[kept[:-1], 0], colours[kept[1:] - 1, 1]), axis=1))

    def show_arm(self, joints: Sequence[float], driven: list[Point]) -> None:
        """
        Show the arm, and where its tip has been.

        Parameters
        ----------
        joints : sequence of 3 floats
            Joint positions [rad].
        driven : list of points
            The driven path [m].

        """
        self._arm.show(joints)
        self._driven.show(np.array(driven).reshape(-1, 3), DRIVEN)

    def show_ghost(self, joints: Sequence[float] | None) -> None:
        """
        Show the arm at another moment, shining through.

        Parameters
        ----------
        joints : sequence of 3 floats, optional
            Joint positions [rad]; None: it is hidden.

        """
        self._ghost.show(joints)

    def add_reach(self, surface: Surface) -> None:
        """
        Draw the space that the tip reaches, shining through.

        Parameters
        ----------
        surface : Surface
            Around it.

        """
        self._reach = self._scene.add_mesh_simple(
            '/reach', surface.vertices, surface.faces, color=REACH, opacity=REACH_OPACITY,
            side='double', cast_shadow=False, receive_shadow=False)

    @property
    def reach(self) -> viser.MeshHandle | None:
        """Return what is drawn by `add_reach`."""
        return self._reach


class _Handle:
    """A via point: a ball with its number, to be chosen by a click, and arrows to drag it by."""

    def __init__(self, scene: viser.SceneApi, index: int, position: Array, size: float,
                 events: PointEvents) -> None:
        name = f'/via_point_{index}'
        self._text, self._numbers = '', [index]
        self._is_held = self._is_chosen = False
        self._controls = scene.add_transform_controls(
            name, HANDLE * size, disable_rotations=True, depth_test=False,
            position=tuple(position))
        self._ball = scene.add_icosphere(f'{name}/ball', BALL * size, VIA)
        self._label = scene.add_label(
            f'{name}/label', str(index), anchor='bottom-right')

        async def dragged(event: Any) -> None:  # not in a pool of threads, where the order is lost
            x, y, z = self._controls.position.tolist()
            if event.phase == 'start':
                self._is_held = True
                events.drag(index, True)
            events.move(index, (x, y, z))
            if event.phase == 'end':
                events.drag(index, False, self._release)

        async def clicked(_: Any) -> None:
            events.choose(index)

        self._controls.on_update(dragged)
        self._ball.on_click(clicked)

    def put(self, position: Array) -> None:
        """Have it at another place, unless the user holds it."""
        if not self._is_held and not np.array_equal(self._controls.position, position):
            self._controls.position = tuple(position)

    def mark(self, text: str, numbers: list[int]) -> None:
        """Make it red, with a text beside it, if there is one; else show numbers, if any."""
        if (text, numbers) != (self._text, self._numbers):
            self._text, self._numbers = text, numbers
            self._label.text = fill(text, COLUMNS) or ', '.join(map(str, numbers))
            self._label.visible = bool(self._label.text)
            self._colour()

    def choose(self, is_chosen: bool) -> None:
        """Show that it is chosen, or that it is not."""
        if is_chosen != self._is_chosen:
            self._is_chosen = is_chosen
            self._ball.scale = CHOSEN_SCALE if is_chosen else 1.0
            self._colour()

    def remove(self) -> None:
        """Remove it from the scene."""
        self._controls.remove()

    def _colour(self) -> None:
        self._ball.color = AT_FAULT if self._text else CHOSEN if self._is_chosen else VIA

    def _release(self) -> None:
        self._is_held = False
