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

"""What Run, Hold and Reset do."""

from __future__ import annotations

from typing import Any

import numpy as np
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.nodes.output.wireframe import Trail
from rrr_traj_planner.nodes.studio.execution.execution import Display, Execution
from rrr_traj_planner.nodes.studio.figures import status_html
from rrr_traj_planner.nodes.studio.goals import goal_of, Question, question
from rrr_traj_planner.nodes.studio.planned import Planned
from rrr_traj_planner.nodes.studio.ros_client import StudioClient
from rrr_traj_planner.nodes.studio.session import Session
from rrr_traj_planner.nodes.studio.wanted import Wanted
from rrr_traj_planner_interfaces.action import MoveThrough

MOVES = 0.01  # rad/s, of a joint above which the arm moves
NO_PLAN = 'these via points have no plan to run'
CHANGED = 'the motion has changed since the question: nothing is sent'
NO_MOTION = 'no motion of this page to stop'
GONE = 'nothing is sent: {} is not there'


class Commands:
    """
    Run, Hold and Reset; every method is called in the executor's thread, unless it says otherwise.

    Parameters
    ----------
    client : StudioClient
        Connected.
    model : RobotModel
        The arm.
    session : Session
        What is wanted and planned.
    display : Display
        What shows the motion.
    trail : Trail
        The driven path, which a new motion begins afresh.

    """

    def __init__(self, client: StudioClient, model: RobotModel, session: Session[Planned],
                 display: Display, trail: Trail) -> None:
        self._client, self._model, self._session = client, model, session
        self._display, self._trail = display, trail
        self._execution = Execution(client, model.joint_names, display)
        self.changed, self.check = self._execution.changed, self._execution.check
        self._last = ''  # of Run, Hold and Reset: what the others answer later is no news

    @property
    def is_real(self) -> bool:
        """Return whether the arm is a real one, by another controller."""
        return bool(self._client.controller)

    def question(self) -> Question | None:
        """
        Return what to ask before `run`; any thread may call it.

        Returns
        -------
        Question or None
            None: nothing is to be asked, since the arm is simulated or there is no plan.

        """
        plan, wanted = self._session.plan, self._session.wanted
        if not self.is_real or plan is None or not self._session.is_current:
            return None
        return question(self._client.controller, wanted, plan, self._goal(wanted, plan))

    def run(self, asked: Wanted | None = None) -> None:
        """
        Have the arm do what is planned.

        Parameters
        ----------
        asked : Wanted, optional
            What the user was asked about, and has said yes to.

        """
        plan, wanted, self._last = self._session.plan, self._session.wanted, 'run'
        if plan is None or not self._session.is_current:
            self._show_error(NO_PLAN)
        elif self.is_real and asked is not wanted:
            self._show_error(CHANGED)
        elif self._client.gone:
            self._show_error(GONE.format(self._client.gone))
        else:
            if not self._moves:
                self._trail.clear()
            self._execution.start(self._goal(wanted, plan), wanted, self._moves)

    def hold(self) -> None:
        """Stop the arm; the simulated one also where somebody else moves it."""
        found = self._execution.stop(is_told=self.is_real)
        if not self.is_real:
            self._trigger('hold')
        elif not found:
            self._display.show_status(status_html(NO_MOTION), 0.0)

    def reset(self) -> None:
        """Put the simulated arm back to where it was at first."""
        self._execution.stop(is_told=False)
        self._trigger('reset')

    @property
    def _moves(self) -> bool:
        """Return whether the arm moves."""
        speeds = self._client.joints(self._model.joint_names, 'velocity')
        return self._execution.is_moving or bool(np.abs(speeds).max() > MOVES)

    def _goal(self, wanted: Wanted, plan: Planned) -> MoveThrough.Goal:
        q = self._client.joints(self._model.joint_names)
        return goal_of(wanted, plan, self._model, q, self._moves)

    def _trigger(self, name: str) -> None:
        def answered(response: Any) -> None:
            if name == 'reset':
                self._trail.clear()
            if name == self._last:
                self._display.show_status(
                    status_html(response.message or name, not response.success), 0.0)

        self._last = name
        self._client.trigger(name, answered)

    def _show_error(self, text: str) -> None:
        self._display.show_status(status_html(text, is_error=True), 0.0)
