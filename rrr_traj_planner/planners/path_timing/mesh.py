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

"""
The intervals into which the pieces of a path are divided: short where pieces meet.

Joins of the path are ends of pieces: the path's curvature changes there, and so does the jerk that
the fastest motion needs. Long paths have more pieces, and fewer intervals in each.
"""

from __future__ import annotations

import numpy as np
from rrr_traj_planner.planners.solver.splines import Mesh

# Chosen values, without unit. On 48 random paths half of MOST_INTERVALS makes motions 0.78 %
# slower in the mean in 0.7 times the planning time, twice as many 0.61 % faster in 1.9 times. Half
# of LONGEST: 0.43 % slower; twice: 0.20 % faster, but then intervals at joins last a fifth of a
# sample on the thesis's tables. More intervals for long paths (twice FEWEST_INTERVALS or PIECES,
# half of EXPONENT) make the 27 of more than 11 pieces 0.4 to 0.7 % faster, fewer of them 0.1 to
# 0.4 % slower.
MOST_INTERVALS, FEWEST_INTERVALS = 20, 10  # in a piece
PIECES = 11      # of a path, up to which each has the most intervals; beyond it the number falls
EXPONENT = 2.0   # with this power of the number of pieces
LONGEST = 3.0    # interval, in the middle of a piece, over the shortest


def path_mesh(pieces: int) -> Mesh:
    """
    Return the intervals of a path's pieces.

    Parameters
    ----------
    pieces : int
        Of the path.

    Returns
    -------
    Mesh
        The same in every piece.

    """
    n = max(int(MOST_INTERVALS * min(PIECES / pieces, 1.0) ** EXPONENT), FEWEST_INTERVALS)
    middles = (np.arange(n) + 0.5) / n
    lengths = 1.0 + (LONGEST - 1.0) * np.sin(np.pi * middles)
    return Mesh(np.tile(lengths / lengths.sum(), (pieces, 1)))
