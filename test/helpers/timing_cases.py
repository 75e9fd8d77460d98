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

"""Timing problems at an iterate, and the Newton step of one by a dense solve in NumPy."""

from dataclasses import replace

from helpers.random_cases import central_difference
from helpers.random_paths import random_case
from helpers.spline_cases import bounds, FREE, LIMITS, random_motion, slow_start
import numpy as np
from rrr_traj_planner.core.arm.friction import Friction
from rrr_traj_planner.planners.path_timing.constraints import PathConstraints, QUANTITIES
from rrr_traj_planner.planners.path_timing.start import motion_with_speeds
from rrr_traj_planner.planners.path_timing.table import PathTable
from rrr_traj_planner.planners.solver.library import KERNELS
from rrr_traj_planner.planners.solver.limits import DurationConstraints
from rrr_traj_planner.planners.solver.splines import time_scaled, uniform_mesh

BARRIER = 1e-3
STEP = 1e-6       # of differences by a motion's own unknowns


class Case:
    """A problem at an iterate with multipliers and weights of its own."""

    def __init__(self, kind, seed, segments=None, durations=None, least_T=False):
        rng = np.random.default_rng(seed)
        self.problem, self.motion = (
            path_problem(seed, rubbing='friction' in kind) if kind.startswith('path')
            else joint_problem(FREE if kind == 'bounds' else LIMITS, seed, segments, least_T))
        N, J = len(self.motion.T), self.motion.inner.shape[-1]
        self.durations = (durations or DurationConstraints.all_free(N, J))._replace(
            weights=rng.uniform(0.5, 2.0, N))
        self.arrays, self.address = self.problem.arrays, self.problem.address
        self.problem.begin(self.motion, self.durations)
        self.x = self.arrays['variables'].copy()
        self.arrays['slack'][:] = self.problem.slacks(self.motion)
        self.arrays['dual'][:] = BARRIER / self.arrays['slack'] * rng.uniform(
            0.5, 2.0, self.arrays['slack'].size)
        KERNELS.timing_linearise(self.address, BARRIER)

    def states(self, x):
        """Return position, velocity, acceleration and jerk at the points, (N, P, 4, J)."""
        at = self.problem.mesh.states(self.problem.points, self.problem.motion(x))
        return np.stack(at, axis=2)

    def ends(self, x):
        """Return what must stay 0: states at segments' ends less those of the via points."""
        n, m = self.problem.mesh.n, self.problem.motion(x)
        at = self.states(x)[:, n]
        return np.concatenate([(at[:, k] - own).ravel() for k, own in enumerate(
            (self.problem.points[1:], m.v[1:], m.a[1:]))])

    def by_unknowns(self, function):
        """Return a function's derivatives by every unknown, as columns."""
        return np.stack([central_difference(
            lambda z, unit=unit: function(self.x + z * unit), 0.0, STEP).ravel()
            for unit in np.eye(len(self.x))], axis=1)

    def newton(self, exact):
        """Return the step, its slacks' rates and its gain, by the kernel."""
        step = self.problem.steps[0]
        assert KERNELS.timing_newton(self.address, exact, step.address)
        return (self.arrays['direction 0'].copy(), self.arrays['rate 0'].copy(),
                step.structure.predicted_decrease)

    def dense(self, exact, g=None, g_T=None):
        """Return the step and its gain by solving all conditions of optimality at once."""
        N, P, _, J = self.states(self.x).shape
        D, E = self.by_unknowns(self.states), self.by_unknowns(self.ends)
        Q, Z = self.arrays['exact' if exact else 'hessian'], 4 * J
        blocks = Q.reshape(N * P, Z, Z) if Q.ndim == 4 else [np.diag(q) for q in
                                                             Q.reshape(N * P, Z)]
        rows = D.reshape(N * P, Z, -1)
        H = sum(d.T @ q @ d for d, q in zip(rows, blocks))
        T = slice(len(self.x) - N, None)
        H[T, T] += np.diag(self.arrays['hessian_T'])
        if g is None:
            g, g_T = self.arrays['gradient'], self.arrays['gradient_T'] + self.durations.weights
        slope = D.T @ g.ravel()
        slope[T] += g_T
        basis = self.allowed()
        h, e = basis.T @ H @ basis, E @ basis
        K = np.block([[h, e.T], [e, np.zeros((len(e), len(e)))]])
        scale = 1.0 / np.sqrt(np.abs(np.diag(K)) + np.abs(K).max(axis=1))
        x = scale * np.linalg.lstsq(scale[:, np.newaxis] * K * scale, scale * np.concatenate((
            -basis.T @ slope, np.zeros(len(e)))), rcond=None)[0]
        step = basis @ x[:basis.shape[1]]
        return step, -float(slope @ step)

    def allowed(self):
        """Return a basis of the changes that the durations' constraints allow."""
        N, d = len(self.motion.T), self.durations
        start = len(self.x) - N
        fixed = [start + k for k in range(N) if not d.free[k]]
        fixed += [self.motion.inner.size + i for i in np.flatnonzero(
            np.swapaxes(d.fixed, 0, 1).ravel())]
        basis = np.delete(np.eye(len(self.x)), fixed, axis=1)
        tie = np.concatenate((np.zeros(start), d.proportions))
        return np.column_stack((basis, tie)) if d.proportions.any() else basis


def joint_problem(limits, seed, segments=None, least_T=False):
    mesh, points, _ = random_motion(seed, n=5 + seed % 3, segments=segments or 1 + seed % 3)
    constraints, m = slow_start(limits, mesh, points)
    if least_T:
        constraints = bounds(limits, mesh, points, 0.8 * m.T)
    return constraints.problem, m


def path_problem(seed, rubbing=False):
    case = random_case(seed, points=3)
    arm_path = case.arm_path
    if rubbing:
        arm_path = replace(arm_path, model=replace(
            arm_path.model, friction=Friction([60.0, 90.0, 40.0])))
    table = PathTable(arm_path)
    N = len(table.ends) - 1
    mesh = uniform_mesh(N, 6)
    constraints = PathConstraints(
        table, replace(case.limits, max_jerk=[30.0] * 3), 0.7, mesh,
        np.zeros((N, 2 * mesh.n + 1, QUANTITIES)), np.zeros(N, bool))
    m = motion_with_speeds(mesh, table.ends, np.concatenate(([0.0], np.full(N - 1, 0.3), [0.0])))
    while not constraints.problem.is_within(m):
        m = time_scaled(m, 1.3)
    return constraints.problem, m
