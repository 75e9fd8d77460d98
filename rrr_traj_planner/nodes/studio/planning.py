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

"""What has the planner plan what is wanted, and the arm carry what is planned with."""

from __future__ import annotations

from collections.abc import Callable

from rrr_traj_planner.core.arm.payload import Payload
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.nodes.parameters.configuration import PlannerConfig
from rrr_traj_planner.nodes.studio.planned import in_words_of_the_page, Planned, planned
from rrr_traj_planner.nodes.studio.ros_client import StudioClient
from rrr_traj_planner.nodes.studio.session import Refusal
from rrr_traj_planner.nodes.studio.wanted import Wanted


class Planning:
    """
    Has one motion planned after another.

    Parameters
    ----------
    client : StudioClient
        Connected.
    config : PlannerConfig
        The planner's.

    Attributes
    ----------
    config : PlannerConfig
        The planner's, with the payload that it has been told of.

    """

    def __init__(self, client: StudioClient, config: PlannerConfig) -> None:
        self._client = client
        self._mass = client.payload.mass  # that the planner has been told of [kg]
        self._carried = client.payload    # by the arm
        self.config = config

    def plan(self, wanted: Wanted, answered: Callable[[Planned | Refusal], None]) -> None:
        """
        Have a motion planned, after the planner has been told of its payload.

        Parameters
        ----------
        wanted : Wanted
            The motion.
        answered : callable
            Gets the answer.

        """
        mass, planner_id = wanted.payload.mass, wanted.task.planner_id
        if mass == self._mass:
            config = self.config
            self._client.plan(wanted, lambda response: answered(planned(
                response, planner_id, config.model, config.limits_for(planner_id))))
            return
        try:
            config = PlannerConfig.from_values({
                **self._client.parameters, 'payload.mass': mass})
        except InvalidInputError as error:
            answered(Refusal(in_words_of_the_page(str(error))))
            return

        def set_(refused: str) -> None:
            if refused:
                answered(Refusal(in_words_of_the_page(refused)))
                return
            self.config, self._mass = config, mass
            self.plan(wanted, answered)

        self._client.tell_planner(wanted.payload, set_)

    def load(self, payload: Payload, refused: Callable[[str], None]) -> None:
        """
        Have the simulated arm carry a payload, unless it does.

        Parameters
        ----------
        payload : Payload
            One with which there is a plan: under another, the arm might fall.
        refused : callable
            Gets why the arm refuses it, if it does.

        """
        before, self._carried = self._carried, payload

        def set_(reason: str) -> None:
            if reason:
                self._carried = before
                refused(reason)

        if payload != before:
            self._client.load_arm(payload, set_)
