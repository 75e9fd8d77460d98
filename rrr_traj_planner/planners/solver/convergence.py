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

"""How near the optimum counts as there, and what is said of a motion that is not."""

from __future__ import annotations

CONVERGED = 5e-3  # relative gap
INFORMATIVE = 0.5  # a larger part of the time says nothing that a reader could use


def unconverged_note(gap: float, duration: float) -> str:
    """
    Return what there is to be said where the method ended before it converged.

    Parameters
    ----------
    gap : float
        What a better motion could save at most [s]; infinite where nothing is known.
    duration : float
        The motion's [s].

    Returns
    -------
    str
        Empty where it converged; with a bound on what could be saved where it is a useful one.

    """
    if gap < CONVERGED * duration:
        return ''
    if not gap < INFORMATIVE * duration:
        return 'planning ended before it converged: faster motions may be possible'
    return (f'planning ended before it converged: at most {100.0 * gap / duration:.3g} % of the '
            'time could be saved')
