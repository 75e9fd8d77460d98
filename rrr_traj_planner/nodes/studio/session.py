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

"""Planning while the user drags: one request in flight, the newest waits, the last plan stays."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Generic, TypeVar

from rrr_traj_planner.nodes.studio.wanted import Wanted

Plan = TypeVar('Plan')


@dataclass(frozen=True)
class Refusal:
    """
    Why there is no plan.

    Attributes
    ----------
    text : str
        The planner's message.
    via_point : int
        Index of the via point at fault; -1: none.

    """

    text: str
    via_point: int = -1


class Session(Generic[Plan]):
    """
    What is wanted, and what is planned of it.

    Parameters
    ----------
    wanted : Wanted
        At the beginning; `change` asks for its plan.
    ask : callable
        Gets what is to be planned; `answered` is to be called with the answer, later.

    Attributes
    ----------
    wanted : Wanted
        What is wanted now.
    plan : Plan, optional
        The last plan that was found.
    refusal : Refusal, optional
        Why the last request has none; None if it has one.

    """

    def __init__(self, wanted: Wanted, ask: Callable[[Wanted], None]) -> None:
        self.wanted = wanted
        self.plan: Plan | None = None
        self.refusal: Refusal | None = None
        self._ask = ask
        self._in_flight: Wanted | None = None
        self._planned: Wanted | None = None  # what `plan` is of

    @property
    def is_new(self) -> bool:
        """Return whether nothing has been asked for yet."""
        return self._in_flight is None and self.plan is None and self.refusal is None

    @property
    def is_current(self) -> bool:
        """Return whether the plan is of what is wanted now."""
        return self.plan is not None and self._planned is self.wanted

    @property
    def is_waiting(self) -> bool:
        """Return whether an answer is waited for."""
        return self._in_flight is not None

    def take(self, wanted: Wanted, plan: Plan) -> None:
        """
        Want something whose plan is known.

        Parameters
        ----------
        wanted : Wanted
            What is wanted.
        plan : Plan
            Its plan.

        """
        self.wanted = self._planned = wanted
        self.plan, self.refusal = plan, None

    def change(self, wanted: Wanted) -> None:
        """
        Want something else, and have it planned: at once, or after the request in flight.

        Parameters
        ----------
        wanted : Wanted
            What is wanted; of several that come while a request is in flight, the last is asked
            for.

        """
        self.wanted = wanted
        if self._in_flight is None:
            self._send()

    def answered(self, answer: Plan | Refusal) -> None:
        """
        Take the answer to the request in flight, and ask for what is wanted by now.

        Parameters
        ----------
        answer : Plan or Refusal
            After a refusal, the last plan stays.

        """
        asked, self._in_flight = self._in_flight, None
        if isinstance(answer, Refusal):
            self.refusal = answer
        else:
            self.plan, self._planned, self.refusal = answer, asked, None
        if asked is not self.wanted:
            self._send()

    def _send(self) -> None:
        self._in_flight = self.wanted
        self._ask(self.wanted)
