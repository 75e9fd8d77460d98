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

"""The terms of a path's table by scipy, and what a motion demands by them, written plainly."""

from __future__ import annotations

import numpy as np
from rrr_traj_planner.planners.path_timing.table import INTERVALS, PathTerms
from scipy.interpolate import PPoly


def terms_at(table, s):
    """Return the terms at path lengths, (N, p, 3) each; row k of s is on piece k."""
    u = (s - table.ends[:-1, np.newaxis]) / np.diff(table.ends)[:, np.newaxis]
    breaks = np.linspace(0.0, 1.0, INTERVALS + 1)
    values = np.stack([PPoly(c, breaks)(row) for c, row in zip(table.coefficients, u)])
    return PathTerms(*np.split(values, 6, axis=-1))


def demands(terms, at):
    """Return all limited quantities at states along the path, (N, p, 4), in their order."""
    v, a, j = (at[..., k, np.newaxis] for k in (1, 2, 3))
    return np.concatenate((
        terms.dq * v, terms.ddq * v ** 2 + terms.dq * a,
        terms.dddq * v ** 3 + 3.0 * terms.ddq * v * a + terms.dq * j,
        terms.m * a + terms.c * v ** 2 + terms.g, v, a), axis=-1)
