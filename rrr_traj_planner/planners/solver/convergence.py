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

"""The optimisation methods' convergence criterion, and the note of a motion that misses it."""

from __future__ import annotations

# Gaps to the optimum, as parts of the time; chosen:
CONVERGED = 5e-3    # up to which a motion counts as converged: five times the solver's own gap
INFORMATIVE = 0.25  # up to which a note gives the bound: above, it tells a reader nothing


def unconverged_note(gap: float, duration: float) -> str:
    """
    Return the note of a motion whose optimisation ended before it converged.

    Parameters
    ----------
    gap : float
        Upper bound on the time that the optimum saves [s]; infinite where none is known.
    duration : float
        The motion's [s].

    Returns
    -------
    str
        Empty where it converged; with the bound where it is INFORMATIVE.

    """
    if gap < CONVERGED * duration:
        return ''
    if not gap < INFORMATIVE * duration:
        return 'planning ended before it converged: faster motions may be possible'
    return (f'planning ended before it converged: at most {100.0 * gap / duration:.3g} % of the '
            'time could be saved')
