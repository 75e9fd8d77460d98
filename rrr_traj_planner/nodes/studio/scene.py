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

"""The page's scene: the arm, the via points with their handles, planned and driven path."""

from __future__ import annotations

from collections.abc import Callable
from textwrap import fill
from typing import Any, Protocol

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.kinematics.link_positions import Point
from rrr_traj_planner.nodes.output.wireframe import rod
from rrr_traj_planner.nodes.studio.figures import speed_colours
from rrr_traj_planner.nodes.studio.planned import Planned
from rrr_traj_planner.nodes.studio.session import Refusal
import viser

ARM, GHOST, DRIVEN = (70, 90, 120), (150, 170, 200), (0, 150, 130)
VIA, CHOSEN, AT_FAULT = (245, 140, 30), (250, 205, 60), (200, 30, 30)
GHOST_OPACITY = 0.4

# Sizes, as fractions of the arm's.
THICK, BALL, HANDLE, CELL = 0.018, 0.018, 0.16, 0.1
CHOSEN_SCALE = 1.5  # of a ball
PLAN_LINE, DRIVEN_LINE = 6.0, 2.0  # pixels
COLUMNS = 28  # characters of a refusal's line beside its via point

Colour = tuple[int, int, int]


class Hands(Protocol):
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
    hands : Hands
        Gets what the user does with via points.

    """

    def __init__(self, scene: viser.SceneApi, size: float, hands: Hands) -> None:
        self._scene, self._size, self._hands = scene, size, hands
        self._points: list[_Handle] = []
        self._arm = _Rods(scene, '/arm', THICK * size, ARM)
        self._ghost = _Rods(scene, '/ghost', THICK * size, GHOST, GHOST_OPACITY)
        scene.add_grid('/grid', width=4.0 * size, height=4.0 * size, cell_size=CELL * size,
                       section_size=10.0 * CELL * size)
        scene.add_frame('/base', axes_length=CELL * size, axes_radius=0.05 * CELL * size)

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
                _Handle(self._scene, index, points[index], self._size, self._hands))
        for index, handle in enumerate(self._points):
            handle.put(points[index])
            handle.mark(refusal.text if refusal is not None and refusal.via_point == index
                        else '')

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

    def show_plan(self, plan: Planned | None, is_current: bool) -> None:
        """
        Show the planned path.

        Parameters
        ----------
        plan : Planned, optional
            None: there is nothing to show yet.
        is_current : bool
            Whether it is coloured; else it is grey.

        """
        if plan is not None:
            self._draw('/plan', plan.path, speed_colours(plan.speed, is_current), PLAN_LINE)

    def show_arm(self, places: tuple[Point, ...], driven: list[Point]) -> None:
        """
        Show the arm, and where its tip has been.

        Parameters
        ----------
        places : tuple of points
            Base, joints and tip [m].
        driven : list of points
            The driven path [m].

        """
        self._arm.show(places)
        self._draw('/driven', np.array(driven).reshape(-1, 3), DRIVEN, DRIVEN_LINE)

    def show_ghost(self, places: tuple[Point, ...]) -> None:
        """
        Show the arm at another moment, shining through.

        Parameters
        ----------
        places : tuple of points
            Base, joints and tip [m]; empty: it is hidden.

        """
        self._ghost.show(places)

    def _draw(self, name: str, path: Array, colours: Any, width: float) -> None:
        """Draw a path in place of the one of the same name, which may be a single point."""
        ends = np.stack((path[:-1], path[1:]), axis=1)
        if not len(ends):
            ends, colours = np.zeros((1, 2, 3)), (0, 0, 0)  # a line without length: not to be seen
        self._scene.add_line_segments(
            name, ends.astype(np.float32), np.asarray(colours, dtype=np.uint8),
            thickness=width, thickness_units='screen')


class _Rods:
    """An arm, drawn as rods with balls at their ends."""

    def __init__(self, scene: viser.SceneApi, name: str, radius: float, colour: Colour,
                 opacity: float | None = None) -> None:
        self._scene, self._name, self._radius = scene, name, radius
        self._colour, self._opacity = colour, opacity
        self._links: list[tuple[Any, Any]] = []

    def show(self, places: tuple[Point, ...]) -> None:
        """Show the arm between base, joints and tip; hide it where there are none."""
        rods = [rod(a, b) for a, b in zip(places, places[1:])]
        while len(self._links) < len(rods):
            self._add(len(self._links), rods[len(self._links)].length)
        for link in self._links:
            for part in link:
                part.visible = bool(places)
        for (bar, ball), shape, end in zip(self._links, rods, places[1:]):
            x, y, z, w = shape.quaternion
            bar.position, bar.wxyz, ball.position = shape.centre, (w, x, y, z), end

    def _add(self, index: int, length: float) -> None:
        name, radius, look = f'{self._name}/{index}', self._radius, {'opacity': self._opacity}
        self._links.append((
            self._scene.add_cylinder(
                f'{name}/rod', radius, max(length, radius), self._colour, **look),
            self._scene.add_icosphere(f'{name}/end', 1.4 * radius, self._colour, **look)))


class _Handle:
    """A via point: a ball with its number, to be chosen by a click, and arrows to drag it by."""

    def __init__(self, scene: viser.SceneApi, index: int, position: Array, size: float,
                 hands: Hands) -> None:
        name = f'/via_point_{index}'
        self._index, self._text = index, ''
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
                hands.drag(index, True)
            hands.move(index, (x, y, z))
            if event.phase == 'end':
                hands.drag(index, False, self._release)

        async def clicked(_: Any) -> None:
            hands.choose(index)

        self._controls.on_update(dragged)
        self._ball.on_click(clicked)

    def put(self, position: Array) -> None:
        """Have it at another place, unless the user holds it."""
        if not self._is_held and not np.array_equal(self._controls.position, position):
            self._controls.position = tuple(position)

    def mark(self, text: str) -> None:
        """Make the via point red, with a text beside it; empty: neither."""
        if text != self._text:
            self._text = text
            self._label.text = fill(text, COLUMNS) or str(self._index)
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
