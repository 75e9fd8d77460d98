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

"""What the page does: plans what is dragged, shows it, and runs it on the arm."""

from __future__ import annotations

from pathlib import Path
from time import monotonic
from typing import Protocol

from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.kinematics.link_positions import link_positions, Point
from rrr_traj_planner.nodes.output.wireframe import Trail
from rrr_traj_planner.nodes.parameters.configuration import PlannerConfig
from rrr_traj_planner.nodes.studio.comparison import Comparison
from rrr_traj_planner.nodes.studio.editor import Editor
from rrr_traj_planner.nodes.studio.execution.commands import Commands
from rrr_traj_planner.nodes.studio.figures import plan_html, status_html
from rrr_traj_planner.nodes.studio.ghost import Ghost
from rrr_traj_planner.nodes.studio.planned import Planned
from rrr_traj_planner.nodes.studio.planning import Planning
from rrr_traj_planner.nodes.studio.ros_client import StudioClient
from rrr_traj_planner.nodes.studio.session import Refusal, Session
from rrr_traj_planner.nodes.studio.tasks import Tasks
from rrr_traj_planner.nodes.studio.wanted import Wanted
from rrr_traj_planner.planners.registry import planner_ids

TRAIL_STEP = 1.0 / 200  # distance of the driven path's points, as a fraction of the arm's size
TRAIL_POINTS = 1000     # of the driven path
NO_PLAN_TO_KEEP = 'these via points have no plan whose joint positions could be kept'


class Page(Protocol):
    """What shows the page; any thread may call it."""

    def show_points(self, points: Array, refusal: Refusal | None) -> None:
        """Show the via points, and which one is at fault."""

    def show_wanted(self, editor: Editor) -> None:
        """Show all that the user can change."""

    def show_plan(self, plan: Planned | None, is_current: bool, text: str) -> None:
        """Show a plan's path and figures."""

    def show_arm(self, joints: list[float], driven: list[Point]) -> None:
        """Show the arm at joint positions, and where its tip has been."""

    def show_ghost(self, joints: list[float] | None, time: float | None) -> None:
        """Show the arm as the plan has it at a time, or hide it."""

    def show_comparison(self, comparison: Comparison) -> None:
        """Show the plans of all planners so far."""

    def show_status(self, text: str, share: float) -> None:
        """Show a text about the motion, and the share of it that is done."""

    def show_tracking(self, times: Array, errors: Array) -> None:
        """Show the joints' tracking errors [rad], shape (n, 3), over time [s]."""


class Studio:
    """
    The state of the page; every method is called in the executor's thread.

    Parameters
    ----------
    client : StudioClient
        Connected.
    config : PlannerConfig
        The planner's.
    wanted : Wanted
        What is planned at the beginning.
    page : Page
        What shows it.
    arm : Path, optional
        The arm's parameter file; None: it is described otherwise.

    Attributes
    ----------
    editor : Editor
        What is wanted, and how it changes.
    session : Session
        What is planned of it.
    tasks : Tasks
        Opens others.
    commands : Commands
        What moves the arm.

    """

    def __init__(self, client: StudioClient, config: PlannerConfig, wanted: Wanted,
                 page: Page, arm: Path | None = None) -> None:
        self._client, self._page = client, page
        self._planning = Planning(client, config)
        self._model = config.model  # how it moves; its payload may be another one
        self.editor, self._is_shown = Editor(wanted, config.model, self._changed), False
        self.tasks = Tasks(self.editor, config, arm, self._show_soon, not client.controller)
        self._trail = Trail(TRAIL_STEP * config.model.chain.size, TRAIL_POINTS)
        self._joints: list[float] = []  # of the arm [rad]
        self._shown: list[float] = []
        self._ghost = Ghost()
        self.session: Session[Planned] = Session(wanted, self._ask)
        self.commands = Commands(client, config.model, self.session, page, self._trail)
        self.comparison = Comparison(
            planner_ids(), self._planning.plan, lambda: not self.session.is_waiting,
            page.show_comparison)

    def start(self, error: str = '') -> None:
        """
        Show everything, and plan.

        Parameters
        ----------
        error : str
            What is said about the task at first, in red.

        """
        self.tasks.refuse(error)
        self._page.show_status(status_html('at rest'), 0.0)
        self._changed()
        self._client.moved = self._moved
        self._moved()
        self.tick()

    def tick(self) -> None:
        """Show where the arm is, if it has moved."""
        if self._joints != self._shown:
            self._shown = self._joints
            self._page.show_arm(self._joints, list(self._trail.places))
        plan = self.session.plan
        time = None if plan is None else self._ghost.time(monotonic(), plan.duration)
        self._page.show_ghost(
            None if plan is None or time is None else plan.joints_at(time), time)
        self.commands.check()
        if not self._is_shown:
            self._is_shown = True
            self._page.show_wanted(self.editor)

    def move_point(self, index: int, position: Point) -> None:
        """
        Plan with one via point elsewhere; so does the arm, if it is on the way there.

        Parameters
        ----------
        index : int
            Which one; nothing happens where it is no longer there.
        position : tuple of 3 floats
            Where it is now [m].

        """
        self.editor.move(index, position)

    def keep_joints(self, keeps: bool) -> None:
        """
        Plan through the joint positions of the plan, in place of positions of the tip, or not.

        Parameters
        ----------
        keeps : bool
            Whether to do so.

        """
        plan = self.session.plan if self.session.is_current else None
        if keeps and plan is None:
            self._show_error(NO_PLAN_TO_KEEP)
            self._show_soon()
        else:
            self.editor.keep_joints(plan.via_joints if keeps and plan is not None else None)

    def take(self, planner_id: str) -> None:
        """
        Want a plan of the comparison, if it is of the via points as they are.

        Parameters
        ----------
        planner_id : str
            Its planner.

        """
        plan = self.comparison.plan_of(planner_id)
        if plan is not None:
            before, wanted = self.session.wanted, self.editor.wanted.with_planner(planner_id)
            self.session.take(wanted, plan)
            self.commands.changed(before, wanted)
            self.editor.change(wanted)
            self._show_plan()

    def play(self, plays: bool) -> None:
        """
        Play the plan, again and again, or end that.

        Parameters
        ----------
        plays : bool
            Whether to play.

        """
        self._ghost.play(plays, monotonic())

    def go_to(self, share: float) -> None:
        """
        Show one moment of the plan, which is played no longer.

        Parameters
        ----------
        share : float
            Of its duration, 0 to 1.

        """
        self._ghost.go_to(share)

    def report(self) -> tuple[str, bytes]:
        """
        Return the report of what is planned; takes seconds, so that any other thread may call it.

        Returns
        -------
        name : str
            Of the file.
        content : bytes
            A self-contained page.

        Raises
        ------
        InvalidInputError
            If what is wanted is malformed.
        ImportError
            If matplotlib is missing.

        """
        from rrr_traj_planner.nodes.studio.report_page import report_name, report_page
        wanted, compared = self.session.wanted, self.comparison.planned
        return report_name(wanted), report_page(wanted, self._planning.config, compared)

    def _moved(self) -> None:
        self._joints = self._client.joints(self._model.joint_names).tolist()
        self._trail.add(link_positions(self._model, self._joints)[-1])

    def _show_error(self, text: str) -> None:
        self._page.show_status(status_html(text, is_error=True), 0.0)

    def _show_soon(self) -> None:
        self._is_shown = False

    def _changed(self) -> None:
        self._show_soon()
        before, wanted = self.session.wanted, self.editor.wanted
        if wanted is not before:
            self.tasks.say('')  # what was said was about the state before
        if wanted is not before or self.session.is_new:
            self.session.change(wanted)
            self.commands.changed(before, wanted)
        self._page.show_points(wanted.points, self.session.refusal)

    def _ask(self, wanted: Wanted) -> None:
        self.comparison.changed(wanted)
        self._planning.plan(wanted, self._planned)

    def _planned(self, answer: Planned | Refusal) -> None:
        self.session.answered(answer)
        self._show_plan()
        self.comparison.go_on()

    def _show_plan(self) -> None:
        session = self.session
        if session.is_current:
            self._planning.load(session.wanted.payload, self._show_error)
        self._page.show_points(session.wanted.points, session.refusal)
        self._page.show_plan(session.plan, session.refusal is None, plan_html(
            session.plan, session.refusal, self._model.joint_names))
