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

"""Comparison of printed equations with correct ones, and exact numerical derivatives."""

import numpy as np

# Least relative difference of a wrong printed equation: far above any rounding error.
VISIBLE = 1e-3
# Tolerance of sums and products of values of the order of 1 to 10.
ROUNDING = 1e-12
# Tolerance of fourth-order differences of such functions.
DIFFERENCES = 1e-8

COMPLEX_STEP = 1e-30


def differ(printed, truth):
    """Return whether two results differ by far more than rounding in at least one case."""
    return float(np.max(np.abs(np.asarray(printed) - np.asarray(truth)))) > VISIBLE


def rate(function, x, direction=1.0):
    """Return the derivative of an analytic function along a direction, exact to rounding."""
    x, direction = np.asarray(x, dtype=float), np.asarray(direction, dtype=float)
    return np.imag(function(x + 1j * COMPLEX_STEP * direction)) / COMPLEX_STEP


def length(v):
    """Return the Euclidean length over the last axis, analytic in its components."""
    return np.sqrt((v * v).sum(axis=-1))
