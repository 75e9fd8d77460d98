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

"""The page: scene and panel."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from threading import Lock

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.kinematics.link_positions import Point
from rrr_traj_planner.core.kinematics.reach import reach
from rrr_traj_planner.nodes.output.arm_shape import arm_shape
from rrr_traj_planner.nodes.parameters.configuration import PlannerConfig
from rrr_traj_planner.nodes.studio.comparison import Comparison
from rrr_traj_planner.nodes.studio.editor import Editor
from rrr_traj_planner.nodes.studio.figures import status_html
from rrr_traj_planner.nodes.studio.panel.controls import Post
from rrr_traj_planner.nodes.studio.panel.panel import Panel
from rrr_traj_planner.nodes.studio.planned import Planned
from rrr_traj_planner.nodes.studio.scene.scene import Scene
from rrr_traj_planner.nodes.studio.session import Refusal
from rrr_traj_planner.nodes.studio.studio import Studio
from rrr_traj_planner.nodes.studio.tasks import STARTING
from rrr_traj_planner.nodes.studio.wanted import Wanted
from rrr_traj_planner.nodes.studio.web.server import Server

VIEW = np.array((0.7, -1.1, 0.5))  # from where it is looked at the arm, times the arm's size


class Page:
    """
    The page; implements `studio.Page`.

    Parameters
    ----------
    server : Server
        What brings it to the browser.
    config : PlannerConfig
        The planner's.
    folder : Path
        Of the arm's URDF.
    planner_ids : sequence of str
        To choose from.
    wanted : Wanted
        What is shown at the beginning.

    """

    def __init__(self, server: Server, config: PlannerConfig, folder: Path,
                 planner_ids: Sequence[str], wanted: Wanted) -> None:
        self._server, self._config, self._is_connected = server, config, False
        server.gui.reset()
        server.scene.reset()
        server.darken(server.is_dark)
        server.gui.main_panel.dock_right()  # a panel that floats hides the scene
        model, shape = config.model, arm_shape(config, folder)
        size = model.chain.size
        self._panel = Panel(server.gui, planner_ids, wanted, model, server.is_dark)
        self._panel.view.note(shape.notes)
        self._events = _PointEvents()
        self._scene = Scene(server.scene, size, self._events, shape)
        self._plan: tuple[Planned | None, bool] = None, False
        self._reach = Lock()
        self._ghost: list[float] | None = None
        centre = np.vstack((wanted.points, np.zeros(3))).mean(axis=0)
        for camera in (server.initial_camera, *(
                client.camera for client in server.get_clients().values())):
            camera.position = tuple(centre + size * VIEW)  # which takes look_at along
            camera.look_at = tuple(centre)

    def connect(self, studio: Studio, post: Post) -> None:
        """
        Have handles and controls act on the studio.

        Parameters
        ----------
        studio : Studio
            What they act on.
        post : callable
            Calls a function in the studio's thread.

        """
        def post_if_connected(act: Callable[[], None]) -> None:
            if self._is_connected:
                post(act)

        self._is_connected = True
        self._events.connect(studio.editor, post_if_connected)
        self._panel.connect(studio, post_if_connected)
        self._panel.view.connect(lambda: post_if_connected(self._draw_plan), self._show_reach,
                                 self._server.darken)

    def disconnect(self) -> None:
        """Have handles and controls do nothing any more."""
        self._is_connected = False

    def show_points(self, points: Array, refusal: Refusal | None) -> None:
        """Show the via points, and which one is at fault."""
        self._scene.show_points(points, refusal)
        self._panel.show_refusal(refusal)

    def show_wanted(self, editor: Editor) -> None:
        """Show all that the user can change."""
        with self._server.atomic():
            self._scene.show_chosen(editor.chosen)
            self._panel.show_wanted(editor)

    def show_plan(self, plan: Planned | None, is_current: bool, text: str) -> None:
        """Show a plan's path and figures."""
        self._plan = plan, is_current
        with self._server.atomic():
            self._draw_plan()
            self._panel.show_plan(plan, text)
            self._panel.view.explain(plan)
        self._server.flush()  # at once: viser waits 1/60 s for more

    def show_arm(self, joints: list[float], driven: list[Point]) -> None:
        """Show the arm at joint positions, and where its tip has been."""
        with self._server.atomic():
            self._scene.show_arm(joints, driven)

    def show_ghost(self, joints: list[float] | None, time: float | None) -> None:
        """Show the arm as the plan has it at a time, or hide it."""
        self._panel.show_time(time)
        if joints != self._ghost:
            self._ghost = joints
            with self._server.atomic():
                self._scene.show_ghost(joints)

    def show_comparison(self, comparison: Comparison) -> None:
        """Show the plans of all planners so far."""
        with self._server.atomic():
            self._panel.show_comparison(comparison)

    def show_status(self, text: str, share: float) -> None:
        """Show a text about the motion, and the share of it that is done."""
        self._panel.show_status(text, share)

    def show_tracking(self, times: Array, errors: Array) -> None:
        """Show the joints' tracking errors [rad], shape (n, 3), over time [s]."""
        self._panel.show_tracking(times, errors)

    def _draw_plan(self) -> None:
        self._scene.show_plan(*self._plan, self._panel.view.meaning)

    def _show_reach(self, shows: bool) -> None:
        """Show or hide the reach, which is computed when it is shown first."""
        with self._reach:
            if shows and self._scene.reach is None:
                self._scene.add_reach(reach(self._config.model, self._config.limits))
            if self._scene.reach is not None:
                self._scene.reach.visible = shows


class _PointEvents:
    """Tells the editor what the user does in the scene, in the studio's thread."""

    def __init__(self) -> None:
        self._editor: Editor | None = None
        self._post: Post = lambda _: None

    def connect(self, editor: Editor, post: Post) -> None:
        """Begin to do so."""
        self._editor, self._post = editor, post

    def choose(self, index: int) -> None:
        """Take a click on a via point."""
        self._act(lambda editor: editor.choose(index))

    def drag(self, index: int, begins: bool, then: Callable[[], None] = lambda: None) -> None:
        """Take the begin or the end of a drag; call a function when it has been taken."""
        def act(editor: Editor) -> None:
            then()
            editor.drag(index, begins)

        self._act(act)

    def move(self, index: int, position: Point) -> None:
        """Take the position [m] of a via point that is dragged."""
        self._act(lambda editor: editor.move(index, position))

    def _act(self, act: Callable[[Editor], None]) -> None:
        editor = self._editor
        if editor is not None:
            self._post(lambda: act(editor))


def show_wait(server: Server, name: str) -> None:
    """
    Show nothing but that nodes are started.

    Parameters
    ----------
    server : Server
        What brings it to the browser.
    name : str
        Of the task.

    """
    with server.atomic():
        server.scene.reset()
        server.gui.reset()
        server.gui.add_html(status_html(STARTING.format(name)))
