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

"""Paths of the tip as an arm follows them: in a named posture, and of any chain."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from rrr_traj_planner.core.arm.chain import Chain
from rrr_traj_planner.core.kinematics.forward import forward_kinematics, jacobian
from rrr_traj_planner.core.kinematics.inverse import inverse_kinematics
from rrr_traj_planner.core.path.design import line_arc, line_polynomial
from rrr_traj_planner.core.path.workspace_check import check_workspace

REGULAR = 0.02  # of the arm's size: least singular value along a path that is far from singular
REACHED = 1e-13  # of the arm's size: Newton's steps go no nearer than rounding


def arm_path_in(model, limits, path, elbow='up', shoulder='front', start=None):
    """Return a path as an arm follows it, checked against workspace and ranges."""
    first = inverse_kinematics(model, path.points[0], elbow, start, shoulder)
    return check_workspace(model, limits, path, first, start)


def continued(model, path, first, steps=1000):
    """Return path coordinates and joint positions by Newton's method in small equal steps."""
    s = np.linspace(0.0, path.length, steps)
    q, found = np.array(first, dtype=float), []
    for p in path(s)[0]:
        for _ in range(4):
            miss = p - forward_kinematics(model, q)
            if np.abs(miss).max() <= REACHED * model.chain.size:
                break
            q = q + np.linalg.solve(jacobian(model, q), miss)
        found.append(q)
    return s, np.array(found)


def least_singular_values(model, q):
    """Return the least singular values of the Jacobian [m/rad]."""
    return np.linalg.svd(jacobian(model, q), compute_uv=False)[..., -1]


def regular_path(model, rng, points=4):
    """Return a path far from singular positions, and the joint positions to begin in."""
    size = model.chain.size
    while True:
        first = rng.uniform(-np.pi, np.pi, 3)
        sigma = least_singular_values(model, first)
        if sigma < 2.0 * REGULAR * size:
            continue
        steps = rng.normal(size=(points - 1, 3)) * 0.3 * sigma
        tips = np.vstack((np.zeros(3), np.cumsum(steps, axis=0))) + forward_kinematics(
            model, first)
        path = line_arc(tips, 0.1 * sigma) if rng.random() < 0.5 else line_polynomial(
            tips, 0.1 * sigma)
        q = continued(model, path, first, 200)[1]
        regular = np.isfinite(q).all() and np.abs(np.diff(q, axis=0)).max() < 0.3
        if regular and least_singular_values(model, q).min() > REGULAR * size:
            return path, first


def rotated(model, R):
    """Return an arm with a base that is rotated, gravity with it."""
    c = model.chain
    return replace(model, chain=Chain(
        c.axis @ R.T, c.point @ R.T, R @ c.tip, c.mass, c.centre @ R.T, R @ c.inertia @ R.T),
        gravity=R @ model.gravity)
