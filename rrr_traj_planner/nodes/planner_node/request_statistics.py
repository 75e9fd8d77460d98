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

"""Diagnostics of the planner node: requests, errors by code, planning times, last error."""

from __future__ import annotations

from collections import Counter, deque
from typing import NamedTuple

from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
import numpy as np
from rrr_traj_planner.core.errors import counted
from rrr_traj_planner.nodes.output.diagnostics import diagnostics
from rrr_traj_planner_interfaces.srv import PlanTrajectory

WINDOW = 1000  # number of latest requests that the percentiles of planning times include
PERCENTILES = (50, 90, 99)

_RESPONSE = PlanTrajectory.Response
CODES = {getattr(_RESPONSE, name): name for name in (
    'SUCCESS', 'PLANNING_FAILED', 'GOAL_CONSTRAINTS_VIOLATED', 'INVALID_GOAL_CONSTRAINTS',
    'FRAME_TRANSFORM_FAILURE', 'START_STATE_INVALID', 'NO_IK_SOLUTION', 'FAILURE')}


class LastError(NamedTuple):
    """The code and message of an answer without a plan, and its time."""

    stamp: Time
    code: int
    message: str


class RequestStatistics:
    """
    Counts answers by error code and keeps the latest planning times.

    Attributes
    ----------
    answers : Counter
        Number of answers by error code.
    last_error : LastError or None
        The last answer that was not a success.

    """

    def __init__(self) -> None:
        self.answers: Counter[int] = Counter()
        self.last_error: LastError | None = None
        self._seconds: deque[float] = deque(maxlen=WINDOW)

    def add(self, response: PlanTrajectory.Response, stamp: Time) -> None:
        """
        Count an answer.

        Parameters
        ----------
        response : PlanTrajectory.Response
            The answer.
        stamp : Time
            Time of the answer.

        """
        self.answers[response.error_code] += 1
        self._seconds.append(response.planning_time)
        if response.error_code != _RESPONSE.SUCCESS:
            self.last_error = LastError(stamp, response.error_code, response.message)

    def message(self, name: str, stamp: Time, busy: float) -> DiagnosticArray:
        """
        Return the statistics as a diagnostics message.

        Parameters
        ----------
        name : str
            The node's name.
        stamp : Time
            Present time.
        busy : float
            Time since the oldest request in progress was received [s]; 0: there is none.

        Returns
        -------
        DiagnosticArray
            One status: ERROR after a bug, else OK; a refused request is not an error of the node.

        """
        requests, bugs = self.answers.total(), self.answers[_RESPONSE.FAILURE]
        refused = requests - self.answers[_RESPONSE.SUCCESS] - bugs
        text = f'{counted(requests, "request")} answered, {refused} of them refused'
        if bugs:
            text += f'; {bugs} failed because of a bug, see the log'
        return diagnostics(
            f'{name}: plan_trajectory', DiagnosticStatus.ERROR if bugs else DiagnosticStatus.OK,
            text, self._values(requests, busy), stamp)

    def _values(self, requests: int, busy: float) -> list[tuple[str, str]]:
        """Return keys and values."""
        values = [('requests', str(requests)), ('busy for [s]', f'{busy:.3f}')]
        values += [(name, str(self.answers[code])) for code, name in CODES.items()]
        times = np.percentile(self._seconds, PERCENTILES) if self._seconds else [
            float('nan')] * len(PERCENTILES)
        values += [(f'planning time, percentile {p} [s]', f'{seconds:.6f}')
                   for p, seconds in zip(PERCENTILES, times)]
        last = self.last_error
        return [*values,
                ('last error', f'{CODES[last.code]}: {last.message}' if last else ''),
                ('last error at [s]',
                 f'{last.stamp.sec}.{last.stamp.nanosec:09d}' if last else '')]
