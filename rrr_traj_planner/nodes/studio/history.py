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

"""Undo and redo: the states that there were, a whole drag as one step."""

from __future__ import annotations

from typing import Generic, TypeVar

State = TypeVar('State')

PAUSE = 1.0   # s, after which a change by the same control is a step of its own
LONGEST = 200  # steps that can be undone


class History(Generic[State]):
    """
    The states that there were.

    Parameters
    ----------
    first : State
        The present one.

    """

    def __init__(self, first: State) -> None:
        self._states = [first]
        self._at = 0
        self._source, self._time = '', 0.0

    @property
    def present(self) -> State:
        """Return the present state."""
        return self._states[self._at]

    @property
    def can_undo(self) -> bool:
        """Return whether there is a state before."""
        return self._at > 0

    @property
    def can_redo(self) -> bool:
        """Return whether an undone state can be had back."""
        return self._at < len(self._states) - 1

    def add(self, state: State, source: str, now: float, is_drag: bool = False) -> None:
        """
        Go on to a new state; what was undone cannot be had back.

        Parameters
        ----------
        state : State
            The new one.
        source : str
            What has made it: the same source again within `PAUSE` goes on with the same step.
            Empty: a step of its own.
        now : float
            Any steady time [s].
        is_drag : bool
            Whether the source goes on with its step after any pause.

        """
        goes_on = source != '' and source == self._source and (
            is_drag or now - self._time <= PAUSE)
        del self._states[self._at + 1:]
        if goes_on:
            self._states[-1] = state
        else:
            self._states.append(state)
            del self._states[:-LONGEST - 1]
        self._at = len(self._states) - 1
        self._source, self._time = source, now

    def end_step(self) -> None:
        """Have the next change be a step of its own."""
        self._source = ''

    def undo(self) -> State:
        """
        Go back to the state before.

        Returns
        -------
        State
            The present one where there is none before.

        """
        self._at = max(self._at - 1, 0)
        self.end_step()
        return self.present

    def redo(self) -> State:
        """
        Go to the state that was undone last.

        Returns
        -------
        State
            The present one where there is none.

        """
        self._at = min(self._at + 1, len(self._states) - 1)
        self.end_step()
        return self.present
