"""Seeded chains of ramps for the tests of what they are made of and how they are optimised."""

from dataclasses import replace

import numpy as np
from rrr_traj_planner.core.limits import JointLimits
from rrr_traj_planner.core.model import RobotModel
from rrr_traj_planner.planners.ramp_chain import Grid, Motion
from rrr_traj_planner.planners.ramp_constraints import Constraints
from rrr_traj_planner.planners.ramp_newton import Freedom
from rrr_traj_planner.planners.ramp_start import rest_to_rest
from rrr_traj_planner.planners.request import JointTask

NONE = np.full(3, np.inf)
ARM = RobotModel()
LIMITS = JointLimits(min_position=[-2.9] * 3, max_position=[3.1] * 3)  # not symmetric
FREE = replace(LIMITS, max_effort=NONE)


def random_motion(seed, n=None, segments=None):
    """Return a grid, via points and a motion through them."""
    rng = np.random.default_rng(7000 + seed)
    grid = Grid(n or int(rng.integers(4, 13)))
    N = segments or int(rng.integers(1, 5))
    points = rng.uniform([-1.0, 0.8, -0.8], [1.0, 1.8, 0.8], (N + 1, 3))
    m = Motion(rng.normal(0.0, 1.0, (N, grid.n - 1, 3)), rng.normal(0.0, 0.3, (N - 1, 3)),
               rng.normal(0.0, 0.5, (N - 1, 3)), rng.uniform(0.7, 2.5, N))
    return grid, points, grid.restored(points, m)


def random_step(seed, m):
    """Return a change of every unknown."""
    rng = np.random.default_rng(8000 + seed)
    return Motion(*(rng.normal(0.0, 1.0, f.shape) for f in m))


def shifted(m, step, size):
    """Return the motion after a plain step, which need not meet the via points."""
    return Motion(*(f + size * s for f, s in zip(m, step)))


def bounds(limits, grid, points, floor=None, margin=0.0):
    """Return constraints without room for repairs, or with some for positions."""
    N, p = len(points) - 1, 2 * grid.n + 1
    return Constraints(ARM, limits, grid, points, np.full((2, N, p, 3), margin),
                       np.zeros((N, p, 3)), floor)


def all_free(N):
    """Return the freedom of a problem of N segments of free durations."""
    return Freedom(np.ones(N, bool), np.zeros(N), np.ones(N), np.zeros((N - 1, 3), bool))


def slow_start(limits, grid, points, floor=None):
    """Return constraints, and the motion with a stop at every point."""
    constraints = bounds(limits, grid, points, floor)
    task = JointTask(ARM, limits, points, None, 0.01)
    return constraints, rest_to_rest(task, constraints)


def own_unknowns(grid, m):
    """Return the unknowns y of every segment, (N, n + 2, 3)."""
    nodes, v0, _ = grid.nodes(m)
    return np.concatenate((v0[:, np.newaxis], nodes), axis=1)
