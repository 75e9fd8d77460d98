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

"""Seeded random motions of piecewise linear jerk, and constraints, for tests of the solver."""

from dataclasses import replace

from helpers.random_cases import random_model
import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.dynamics.rigid_body import gravity_torque
from rrr_traj_planner.planners.joint_timing.constraints import JointConstraints
from rrr_traj_planner.planners.joint_timing.start import rest_to_rest
from rrr_traj_planner.planners.solver.library import KERNELS
from rrr_traj_planner.planners.solver.limits import DurationConstraints
from rrr_traj_planner.planners.solver.splines import Mesh, Variables
from rrr_traj_planner.planners.tasks import JointTask
from scipy import ndimage

NONE = np.full(3, np.inf)
ARM = RobotModel()
LIMITS = JointLimits(min_position=[-2.9] * 3, max_position=[3.1] * 3)  # not symmetric
FREE = replace(LIMITS, max_effort=NONE)
COARSE, FINE = 61, 601  # cells of joints 2 and 3 of the mesh in which a path is searched


def random_motion(seed, n=None, segments=None):
    """Return a mesh, half of them with unequal intervals, via points and a motion through them."""
    rng = np.random.default_rng(7000 + seed)
    n, N = n or int(rng.integers(5, 13)), segments or int(rng.integers(1, 5))
    parts = 1.0 + seed % 2 * rng.uniform(-0.5, 1.0, (N, n))
    mesh = Mesh(parts / parts.sum(axis=1, keepdims=True))
    points = rng.uniform([-1.0, 0.8, -0.8], [1.0, 1.8, 0.8], (N + 1, 3))
    m = Variables(rng.normal(0.0, 3.0, (N, n - 1, 3)), *(
        at_rest_at_the_ends(rng.normal(0.0, scale, (N + 1, 3))) for scale in (0.3, 0.5, 1.0)),
        rng.uniform(0.7, 2.5, N))
    return mesh, points, mesh.restored(points, m)


def at_rest_at_the_ends(values):
    values[[0, -1]] = 0.0
    return values


def random_step(seed, m):
    """Return a change of every unknown, not of the motion's ends."""
    rng = np.random.default_rng(8000 + seed)
    step = Variables(*(rng.normal(0.0, 1.0, f.shape) for f in m))
    return step._replace(**{name: at_rest_at_the_ends(getattr(step, name)) for name in 'vaj'})


def shifted(m, step, size):
    """Return the motion after a plain step, which need not meet the via points."""
    return Variables(*(f + size * s for f, s in zip(m, step)))


def bounds(limits, mesh, points, least_T=None, margin=0.0):
    """Return constraints without margins, or with margins of positions."""
    N, p = len(points) - 1, 2 * mesh.n + 1
    return JointConstraints(ARM, limits, mesh, points, np.full((2, N, p, 3), margin),
                            np.zeros((N, p, 3)), np.zeros((N, p, 3)), np.zeros((N, p, 3)), least_T)


def closer(limits, part):
    """Return limits scaled by a factor, except for the ranges."""
    return replace(limits, **{name: part * getattr(limits, name) for name in (
        'max_velocity', 'max_acceleration', 'max_jerk', 'max_effort')})


def all_free(N):
    """Return N free durations of three joints."""
    return DurationConstraints.all_free(N, 3)


def slow_start(limits, mesh, points, least_T=None):
    """Return constraints, and the motion with a stop at every point."""
    constraints = bounds(limits, mesh, points, least_T)
    task = JointTask(ARM, limits, points, None, 0.01)
    return constraints, rest_to_rest(task, constraints)


def flat(m):
    """Return the decision variables of a motion as one array."""
    return np.concatenate([f.ravel() for f in m])


def stepped(problem, m, step, size):
    """Return the motion after a fraction of a step, and its slacks; None if it is infeasible."""
    problem.begin(m, DurationConstraints.all_free(len(m.T), m.inner.shape[-1]))
    arrays = problem.arrays
    arrays['slack'][:], arrays['direction 0'][:] = -np.inf, flat(step)
    if not KERNELS.timing_trial(problem.address, problem.steps[0].address, size, 1.0, 0.0):
        return None
    return problem.motion(arrays['variables 0'].copy()), arrays['slack 0'].copy()


def share_of(task, q):
    """Return the largest ratio of gravity torque to effort limit."""
    return (np.abs(gravity_torque(task.model, q)) / task.limits.max_effort).max(axis=-1)


def blocked_task(seed):
    """Return two poses that a random arm can hold, but not on the straight line between them."""
    rng = np.random.default_rng(60_000 + seed)
    while True:
        model = random_model(rng)
        middle = rng.uniform([-0.4, 0.3, -0.5], [0.4, 2.0, 0.5])
        half = rng.uniform([0.5, 1.0, 1.0], [2.0, 3.0, 3.0])
        q = rng.uniform(middle - half, middle + half, (4000, 3))
        torque = np.abs(gravity_torque(model, q))
        effort = np.append(50.0, np.quantile(torque[:, 1:], rng.uniform(0.2, 0.95), axis=0))
        held = q[(torque < 0.999 * effort).all(axis=1)]
        if len(held) < 2:
            continue
        task = JointTask(model, JointLimits(middle - half, middle + half, max_effort=effort),
                         held[:2], None, 0.01)
        pairs = held[rng.integers(len(held), size=(40, 2))]
        good = share_of(task, np.linspace(pairs[:, 0], pairs[:, 1], 100)).max(axis=0) > 1.02
        if seed % 4:  # most of them with another path
            start, end = (_parts_of(task, COARSE, 1.0, pairs[:, k]) for k in (0, 1))
            good &= np.array([bool(a & b) for a, b in zip(start, end)])
        if good.any():
            return replace(task, points=pairs[good.argmax()])


def is_connected(task, margin):
    """
    Return whether holdable poses connect a task's two poses, on a mesh of joints 2 and 3.

    The margin is subtracted from the torque limits, in multiples of the largest change of gravity
    torque between neighbouring cells.
    """
    share = _shares(task, FINE)
    change = max(np.abs(np.diff(share, axis=k)).max() for k in (0, 1))
    start, end = _parts_of(task, FINE, 1.0 - margin * change, task.points)
    return bool(start & end)


def _shares(task, cells):
    low, high = task.limits.min_position, task.limits.max_position
    q = np.zeros((cells, cells, 3))
    q[..., 1], q[..., 2] = np.meshgrid(*(np.linspace(low[j], high[j], cells) for j in (1, 2)),
                                       indexing='ij')
    return share_of(task, q)


def _parts_of(task, cells, most, poses):
    """Return the numbers of the connected components around two poses."""
    low, high = task.limits.min_position[1:], task.limits.max_position[1:]
    parts = ndimage.label(_shares(task, cells) <= most)[0]
    corner = ((poses[:, 1:] - low) / (high - low) * (cells - 1)).astype(int)
    return [set(parts[i:i + 2, j:j + 2].ravel().tolist()) - {0} for i, j in corner]


def nodes_of(m):
    """Return the jerks of all nodes, (N, n + 1, J)."""
    return np.concatenate((m.j[:-1, np.newaxis], m.inner, m.j[1:, np.newaxis]), axis=1)
