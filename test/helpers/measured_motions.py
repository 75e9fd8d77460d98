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

"""Motions on a fine grid of times, and those of every planner on random tasks."""

from dataclasses import replace
from functools import cache, cached_property

from helpers.random_paths import PLANNERS as CARTESIAN
from helpers.random_paths import random_case
from helpers.random_tasks import KINDS, random_task
import numpy as np
from rrr_traj_planner.core.dynamics.rigid_body import inverse_dynamics
from rrr_traj_planner.core.errors import LimitViolationError
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.registry import planner_ids

PER_SAMPLE = 20  # times of the grid between two samples
BESIDE = 1e-9    # s before a knot, for left-hand limits
HIT = 1e-9       # rad
LIMIT_MARGIN = 1e-6  # relative
LIMITED = (('qd', 'max_velocity'), ('qdd', 'max_acceleration'), ('qddd', 'max_jerk'),
           ('torque', 'max_effort'))

JOINT_SPACE = [name for name in planner_ids() if name not in CARTESIAN]
SEEDS = range(32)  # four of every kind of task
CARTESIAN_SEEDS = range(16)
# 'time_optimal' has each kind with each of three sets of limits, twice.
TIME_OPTIMAL_SEEDS = range(48)


class Measured:
    """A motion at given times, or on a fine grid with every knot and the time just before it."""

    def __init__(self, task, plan=None, trajectory=None, t=None):
        self.task, self.plan, self.trajectory = task, plan, trajectory or plan.trajectory
        if t is None:
            T, knots = self.trajectory.duration, self.trajectory.knots
            n = int(np.ceil(T * PER_SAMPLE / task.request.sample_period))
            t = np.unique(np.concatenate((
                np.linspace(0.0, T, n + 1), knots, knots[1:-1] - BESIDE)))
        self.t = t
        self.q, self.qd, self.qdd, self.qddd = self.trajectory(t)

    @cached_property
    def torque(self):
        """Torques [N m]."""
        return inverse_dynamics(self.task.model, self.q, self.qd, self.qdd)

    @cached_property
    def tip(self):
        """Tip positions [m]."""
        return forward_kinematics(self.task.model, self.q)

    def largest(self, name):
        """Return the largest magnitude of each joint."""
        return np.abs(getattr(self, name)).max(axis=0)

    def utilisation(self):
        """Return the largest ratio of a quantity to its limit at each time, over all joints."""
        return np.max([np.abs(getattr(self, values)) / getattr(self.task.limits, limit)
                       for values, limit in LIMITED], axis=(0, 2))

    def via_point_errors(self):
        """Return by how much the joints miss each via point, whole turns aside [rad]."""
        wanted = self.task.q[len(self.task.q) - len(self.plan.via_times):]
        error = self.trajectory(self.plan.via_times)[0] - wanted
        return np.abs(error - 2.0 * np.pi * np.round(error / (2.0 * np.pi)))

    def outside_ranges(self):
        """Return by how much the joints leave their ranges; negative inside [rad]."""
        return np.maximum(self.task.limits.min_position - self.q,
                          self.q - self.task.limits.max_position)

    def violations(self):
        """Return what the motion violates: limits, position ranges, via points."""
        found = [limit for values, limit in LIMITED if not (self.largest(values) <= getattr(
            self.task.limits, limit) * (1.0 + LIMIT_MARGIN)).all()]
        found += ['ranges'] * bool(self.outside_ranges().max() > HIT)
        return found + ['via points'] * bool(self.via_point_errors().max() > HIT)


def task_for(planner_id, seed):
    """Return a random task for a planner: of via points, or of a path."""
    if planner_id in CARTESIAN:
        return random_case(seed)
    task = random_task(seed)
    limits = task.limits
    if planner_id == 'time_optimal' and seed // len(KINDS) % 3 == 1:
        limits = replace(limits, max_jerk=np.full(3, np.inf))
    elif planner_id == 'time_optimal' and seed // len(KINDS) % 3 == 2:
        limits = replace(limits, max_acceleration=np.where(
            np.isfinite(limits.max_effort), np.inf, limits.max_acceleration))
    return replace(task, limits=limits, request=task.request_to(planner_id))


def seeds_for(planner_id):
    """Return the seeds of a planner's random tasks."""
    if planner_id in CARTESIAN:
        return [s for s in CARTESIAN_SEEDS if CARTESIAN[s % 2] == planner_id]
    if planner_id == 'cycloid_approach_a':
        # It passes via points at cruise velocity, so it cannot turn back at the end of a range.
        return [s for s in SEEDS if KINDS[s % len(KINDS)] != 'at a limit']
    return TIME_OPTIMAL_SEEDS if planner_id == 'time_optimal' else SEEDS


@cache
def outcomes(planner_id):
    """Return the measured plans by seed, and the refusals with their tasks."""
    planned, refused = {}, {}
    for seed in seeds_for(planner_id):
        task = task_for(planner_id, seed)
        try:
            planned[seed] = Measured(task, plan(task.model, task.limits, task.request))
        except LimitViolationError as error:
            refused[seed] = (task, error)
    return planned, refused


def planned_motions(planner_id):
    """Return the measured plans of a planner's random tasks, by seed."""
    return outcomes(planner_id)[0]


def exceeding(motions, excess):
    """Return the seeds of motions for which an excess is positive, with its largest value."""
    found = {seed: float(np.max(excess(m))) for seed, m in motions.items()}
    return {seed: value for seed, value in found.items() if not value <= 0.0}
