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

"""`time_optimal` on random tasks: it converges, and no slower motion is known."""

from helpers.measured_motions import exceeding, planned_motions
from helpers.time_optimal_cases import time_to_save
import numpy as np
from rrr_traj_planner.core.dynamics.rigid_body import (
    gravity_torque,
    inertia_matrix,
    inverse_dynamics,
)
from rrr_traj_planner.core.errors import InvalidInputError, LimitViolationError
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.sampling_jerk_limit import CONSTANT_JERK_FRACTION


def test_every_plan_converges_to_within_1_percent():
    assert exceeding(planned_motions('time_optimal'), lambda m: time_to_save(m.plan) - 1.0) == {}


def steepest_jerk(ramps):
    """Return the largest rate of jerk, which rises as a sine in the first part of a ramp."""
    rising = (1.0 - ramps.shape.constant_jerk_fraction) * ramps.duration
    return (ramps.peaks()[1] * np.pi / rising).max()


def test_jerk_is_zero_at_every_knot_and_continuous():
    def jump(m):
        steepest = [0.0 if m.plan.via_times[-1] == 0.0 else steepest_jerk(p.pieces)
                    for p in m.plan.trajectory.profiles]
        at_knots = max(np.abs(np.concatenate((p.pieces.at(0.0)[3], p.pieces.at(1.0)[3]))).max()
                       for p in m.plan.trajectory.profiles)
        scale = m.plan.peaks.jerk.max()
        slope = np.abs(np.diff(m.qddd, axis=0)) - steepest * np.diff(m.t)[:, np.newaxis]
        return max(at_knots, slope.max()) - 1e-9 * scale

    assert exceeding(planned_motions('time_optimal'), jump) == {}


def test_jerk_is_held_at_its_peak_only_where_every_joint_has_a_jerk_limit():
    held = {True: set(), False: set()}
    for m in planned_motions('time_optimal').values():
        if m.plan.via_times[-1] > 0.0:
            held[bool(np.isfinite(m.task.limits.max_jerk).all())] |= {
                p.pieces.shape.constant_jerk_fraction for p in m.plan.trajectory.profiles}
    assert held[False] == {0.0}
    assert CONSTANT_JERK_FRACTION in held[True]


def stops_everywhere(task):
    """Return how long full-period cycloids take from stop to stop, with the jerk of ramps."""
    limits, s = task.limits, np.linspace(0.0, 1.0, 801)[:, np.newaxis]
    inertia = np.diagonal(inertia_matrix(task.model, task.q), axis1=1, axis2=2)
    torque = limits.max_effort + np.abs(gravity_torque(task.model, task.q))
    level = np.minimum(limits.max_acceleration, (torque / inertia).max(axis=0))
    samples = np.where(np.isfinite(limits.max_acceleration), 4.0, 2.0)
    jerk = np.minimum(limits.max_jerk, np.pi * level / (samples * task.request.sample_period))
    total = 0.0
    for start, end in zip(task.q[:-1], task.q[1:]):
        D = end - start
        q = start + D * (s - np.sin(2.0 * np.pi * s) / (2.0 * np.pi))
        qd, qdd = D * (1.0 - np.cos(2.0 * np.pi * s)), D * 2.0 * np.pi * np.sin(2.0 * np.pi * s)
        gravity = gravity_torque(task.model, q)
        moving = inverse_dynamics(task.model, q, qd, qdd) - gravity
        left = np.maximum(limits.max_effort - np.sign(moving) * gravity, 0.0)
        with np.errstate(divide='ignore', invalid='ignore'):
            torque = np.sqrt(np.nanmax(np.abs(moving) / left))
        # Ramps between samples of a sine have pi / 2 times the sine's jerk.
        total += max((2.0 * np.abs(D) / limits.max_velocity).max(),
                     np.sqrt((2.0 * np.pi * np.abs(D) / limits.max_acceleration).max()),
                     np.cbrt((2.0 * np.pi ** 3 * np.abs(D) / jerk).max()), torque)
    return total


def test_motion_is_never_slower_than_with_a_stop_at_every_via_point():
    def slower(m):
        least = 2.5 * m.task.request.sample_period  # no faster with so few samples
        return m.plan.trajectory.duration - max(stops_everywhere(m.task), least)

    assert exceeding(planned_motions('time_optimal'), slower) == {}


def test_motion_is_much_faster_than_cycloid_on_most_tasks_and_slower_on_none():
    ratios = {}
    for seed, m in list(planned_motions('time_optimal').items())[::3]:
        try:
            cycloid = plan(m.task.model, m.task.limits, m.task.request_to('cycloid'))
        except (LimitViolationError, InvalidInputError):
            continue
        if m.plan.via_times[-1] > 20.0 * m.task.request.sample_period:
            ratios[seed] = float(m.plan.via_times[-1] / cycloid.via_times[-1])
    assert {seed: ratio for seed, ratio in ratios.items() if ratio > 1.0} == {}
    assert np.median(list(ratios.values())) <= 0.75
