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

"""Lines about a motion in progress."""

from __future__ import annotations

from rrr_traj_planner.nodes.motion.motion import Progress

PERIOD = 0.5  # s of the motion between two lines


class ProgressLines:
    """
    Prints a line now and then.

    Parameters
    ----------
    skipped : int
        How many of the file's via points the plan does not have, at its beginning.

    """

    def __init__(self, skipped: int) -> None:
        self._skipped = skipped
        self._shown = -1.0

    def show(self, progress: Progress) -> None:
        """
        Print where the motion is, if the last line is some time ago.

        Parameters
        ----------
        progress : Progress
            Of the motion.

        """
        if progress.time - self._shown < PERIOD:
            return
        self._shown = progress.time
        print(f'executing: {progress.time:5.2f} of {progress.duration:.2f} s, next via point '
              f'{progress.next_via_point + self._skipped}', flush=True)
