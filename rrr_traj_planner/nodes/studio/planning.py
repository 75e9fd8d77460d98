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

"""What has the planner plan what is wanted, with the payload that is wanted."""

from __future__ import annotations

from collections.abc import Callable

from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.nodes.parameters.configuration import PlannerConfig
from rrr_traj_planner.nodes.studio.planned import Planned, planned
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
    answered : callable
        Gets each answer.

    Attributes
    ----------
    config : PlannerConfig
        The planner's, with the payload that it has been told of.

    """

    def __init__(self, client: StudioClient, config: PlannerConfig,
                 answered: Callable[[Planned | Refusal], None]) -> None:
        self._client, self._answered = client, answered
        self._payload = client.payload
        self.config = config

    def ask(self, wanted: Wanted) -> None:
        """
        Have a motion planned, after the payload has been set where it is another one.

        Parameters
        ----------
        wanted : Wanted
            The motion.

        """
        if wanted.payload == self._payload:
            self.plan(wanted, self._answered)
            return
        try:
            config = PlannerConfig.from_values({
                **self._client.parameters, 'payload.mass': wanted.payload.mass})
        except InvalidInputError as error:
            self._answered(Refusal(str(error)))
            return

        def set_(refused: str) -> None:
            if refused:
                self._answered(Refusal(refused))
                return
            self.config, self._payload = config, wanted.payload
            self.plan(wanted, self._answered)

        self._client.set_payload(wanted.payload, set_)

    def plan(self, wanted: Wanted, answered: Callable[[Planned | Refusal], None]) -> None:
        """
        Have a motion planned with the payload of the last one.

        Parameters
        ----------
        wanted : Wanted
            The motion.
        answered : callable
            Gets the answer.

        """
        planner_id, config = wanted.task.planner_id, self.config
        self._client.plan(wanted, lambda response: answered(planned(
            response, planner_id, config.model, config.limits_for(planner_id))))
