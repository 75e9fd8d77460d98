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


def test_every_plan_converges_to_within_1_percent():
    assert exceeding(planned_motions('time_optimal'), lambda m: time_to_save(m.plan) - 1.0) == {}


def test_jerk_is_zero_at_rest_and_linear_in_every_interval_and_continuous():
    def off(m):
        jerk, scale = [np.abs(m.qddd[[0, -1]]).max()], m.plan.peaks.jerk.max()
        if m.plan.via_times[-1] > 0.0:
            knots = m.trajectory.knots
            begin, end = knots[:-1], knots[1:]
            parts = np.linspace(0.0, 1.0, 5)[:, np.newaxis]
            within = m.trajectory((begin + parts * (end - begin)).ravel())[3]
            within = within.reshape(len(parts), len(begin), 3)
            within[-1] = m.trajectory(end - 1e-9 * (end - begin))[3]
            jerk.append(np.abs(np.diff(within, 2, axis=0)).max())
            jerk.append(np.abs(within[0, 1:] - within[-1, :-1]).max())
        return max(jerk) - 1e-6 * scale

    assert exceeding(planned_motions('time_optimal'), off) == {}


def test_no_interval_is_much_shorter_than_the_least_rise_of_jerk_or_its_segment_s_mean():
    def too_short(m):
        knots, via, worst = m.trajectory.knots, m.plan.via_times, 0.0
        for begin, end in zip(via[:-1], via[1:]):
            lengths = np.diff(knots[(knots >= begin) & (knots <= end)])
            if len(lengths):
                least = min(m.task.request.least_jerk_rise, lengths.mean())
                if np.isinf(m.task.limits.max_jerk).any():
                    least = min(least, m.task.request.sample_period)
                worst = max(worst, 0.45 - lengths.min() / least)  # half where solved again, finer
        return worst

    assert exceeding(planned_motions('time_optimal'), too_short) == {}


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
