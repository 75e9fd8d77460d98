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

"""Seeded random paths that an arm can follow, with limits that suit them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

from helpers.arm_paths import arm_path_in
from helpers.random_cases import random_model
from helpers.thesis_arm import ThesisArm
import numpy as np
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.cancellation import never
from rrr_traj_planner.core.dynamics.rigid_body import gravity_torque
from rrr_traj_planner.core.kinematics.inverse import inverse_kinematics
from rrr_traj_planner.core.kinematics.postures import ELBOWS
from rrr_traj_planner.core.path import design as path_design
from rrr_traj_planner.core.path.largest_radii import largest_radii
from rrr_traj_planner.planners.path_timing.least_time import fastest_along
from rrr_traj_planner.planners.path_timing.task import PathTask
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.request import PlanningRequest
from rrr_traj_planner.planners.sampling_jerk_limit import acceleration_scale, limits_for_sampling
from rrr_traj_planner.planners.solver.splines import Mesh

PLANNERS = ('line_arc', 'line_polynomial')
NONE = np.full(3, np.inf)
FREE = JointLimits(min_position=-NONE, max_position=NONE)


@dataclass(frozen=True, eq=False)
class PathCase:
    """A request for a path, with an arm and limits for which it is feasible."""

    model: RobotModel
    limits: JointLimits
    request: PlanningRequest

    @cached_property
    def arm_path(self):
        """Return the path that the planner is expected to design."""
        r = self.request
        path = largest_radii(getattr(path_design, r.planner_id), r.via_points, r.max_deviation)
        return arm_path_in(self.model, self.limits, path, r.elbow)

    @cached_property
    def q(self):
        """Return the joint positions at the via points, whole turns aside."""
        return np.array([inverse_kinematics(self.model, p, self.request.elbow)
                         for p in self.request.via_points])

    @property
    def sampled_limits(self):
        """Return the limits with the jerk limit due to sampling, which the planner keeps too."""
        q = self.arm_path(self.arm_path.path.via_s).q
        scale = acceleration_scale(self.model, self.limits, q)
        return limits_for_sampling(self.limits, scale, self.request.sample_period)

    def timed(self, max_tip_speed=np.inf, **limits):
        """Return the fastest motion along the path, with limits changed."""
        return fastest_along(PathTask(
            self.arm_path, replace(self.limits, **limits), max_tip_speed, False, never)).trajectory

    def planned(self, **changes):
        """Return the plan of the request, changed."""
        return plan(self.model, self.limits, replace(self.request, **changes))


def random_case(seed, points=None):
    """Return a path of 2 to 6 points; the seed determines planner and elbow."""
    rng = np.random.default_rng(90_000 + seed)
    model = ThesisArm() if rng.random() < 0.5 else random_model(rng)
    request = PlanningRequest(
        _tips(rng, model, points or int(rng.integers(2, 7))), planner_id=PLANNERS[seed % 2],
        elbow=ELBOWS[seed // 2 % 2],
        max_deviation=float(np.exp(rng.uniform(np.log(5e-3), np.log(0.1)))),
        sample_period=float(rng.choice([0.005, 0.01, 0.02])))
    q = _positions(PathCase(model, FREE, request))
    holding = np.abs(gravity_torque(model, q)).max(axis=0)

    def drawn(least, most):
        return np.exp(rng.uniform(np.log(least), np.log(most), 3))

    limits = JointLimits(
        min_position=q.min(axis=0) - drawn(0.01, 0.5),
        max_position=q.max(axis=0) + drawn(0.01, 0.5),
        max_velocity=drawn(0.4, 3.0), max_acceleration=drawn(0.5, 6.0),
        max_jerk=drawn(5.0, 200.0) if rng.random() < 0.7 else NONE,
        max_effort=drawn(1.1, 4.0) * np.maximum(holding, 5.0) if rng.random() < 0.8 else NONE)
    return PathCase(model, limits, request)


def random_mesh(seed, pieces, n):
    """Return a mesh of n intervals in each piece, equal ones for even seeds."""
    parts = 1.0 + seed % 2 * np.random.default_rng(95_000 + seed).uniform(-0.5, 1.0, (pieces, n))
    return Mesh(parts / parts.sum(axis=1, keepdims=True))


def _tips(rng, model, n):
    """Return points in front of an arm, well inside its workspace."""
    least, most = model.reach
    tips = []
    while len(tips) < n:
        d = rng.normal(size=3)
        d[0] = abs(d[0]) + 1.5
        away = rng.uniform(0.6 * most + 0.4 * least, 0.9 * most)
        tips.append(d / np.linalg.norm(d) * away + (0.0, 0.0, model.d1))
    return np.array(tips)


def _positions(case):
    return case.arm_path(np.linspace(0.0, case.arm_path.path.length, 400)).q
