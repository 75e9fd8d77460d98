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

"""Residual vibration of plans, against integrated modes and identities."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.trajectory.quintic_spline import spline_through
from rrr_traj_planner.core.trajectory.residual_vibration import residual_vibration
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.request import PlanningRequest
from scipy.integrate import solve_ivp

ROUNDING = 1e-8      # of the largest acceleration: the quadrature of smooth pieces
INTEGRATED = 2e-4    # relative: of solve_ivp, and of the samples of its free vibration
STEPS_INSIDE = 1e-6  # of the largest acceleration, where jerk bends between knots
MODES = (8.0, 16.0, 32.0, 64.0)


def planned(planner_id, seed):
    """Return a plan through 2 to 5 random points of the thesis arm."""
    rng = np.random.default_rng(seed)
    q = rng.uniform((0.1, 0.5, -0.3), (1.4, 1.2, 0.4), (2 + seed % 4, 3))
    points = forward_kinematics(RobotModel(), q)
    return plan(RobotModel(), JointLimits(), PlanningRequest(points, planner_id=planner_id))


def integrated(motion, knots, frequencies, damping):
    """Return the residual vibration by integrating the modes' equations, a slow second method."""
    w = 2.0 * pi * np.array(frequencies)[:, np.newaxis]  # (modes, 1), joints beside

    def slope(acceleration):
        def f(t, state):
            y, v = state.reshape(2, len(frequencies), 3)
            return np.stack((v, -2.0 * damping * w * v - w * w * y - acceleration(t))).ravel()
        return f

    state = np.zeros(6 * len(frequencies))
    for begin, end in zip(knots[:-1], knots[1:]):
        state = solve_ivp(slope(lambda t: motion(np.array([t]))[2][0]), (begin, end), state,
                          method='DOP853', rtol=1e-9, atol=1e-12).y[:, -1]
    period = 1.0 / min(frequencies)
    free = solve_ivp(slope(lambda t: np.zeros(3)), (0.0, period), state, method='DOP853',
                     rtol=1e-9, atol=1e-12, t_eval=np.linspace(0.0, period, 4001)).y
    y = free.reshape(2, len(frequencies), 3, -1)[0]
    return np.abs(y).max(axis=-1) * w * w


@pytest.mark.parametrize(('planner_id', 'seed', 'damping'), [
    ('time_optimal', 2, 0.01), ('poly_434', 3, 0.05), ('line_arc', 4, 0.0)])
def test_plans_leave_what_the_integrated_mode_keeps(planner_id, seed, damping):
    found = planned(planner_id, seed)
    expected = integrated(found.trajectory, found.trajectory.knots, MODES, damping)
    residual = residual_vibration(found.trajectory, found.trajectory.knots, MODES, damping)
    peak = found.peaks.acceleration.max()
    assert residual == pytest.approx(expected, rel=INTEGRATED, abs=peak * STEPS_INSIDE)


def test_a_controller_s_quintics_leave_what_the_integrated_mode_keeps():
    spline = spline_through(planned('cycloid', 0).points)
    residual = residual_vibration(spline.at, spline.knots, MODES)
    assert residual == pytest.approx(integrated(spline.at, spline.knots, MODES, 0.01),
                                     rel=INTEGRATED, abs=STEPS_INSIDE)


@pytest.mark.parametrize('seed', range(4))
def test_a_slower_motion_leaves_less_of_a_slower_mode(seed):
    """A motion and a mode slowed down alike do the same, with accelerations less by a square."""
    factor = np.random.default_rng(seed).uniform(0.3, 5.0)
    one = planned('cycloid', seed).trajectory
    other = one.time_scaled(factor)
    assert factor ** 2 * residual_vibration(
        other, other.knots, np.array(MODES) / factor) == pytest.approx(
            residual_vibration(one, one.knots, MODES), abs=ROUNDING)


def test_finer_knots_change_nothing():
    for planner_id in ('cycloid', 'time_optimal', 'line_polynomial'):
        found = planned(planner_id, 1)
        t = found.trajectory
        finer = np.union1d(t.knots, np.linspace(0.0, t.duration, 3001))
        assert residual_vibration(t, finer, MODES) == pytest.approx(
            residual_vibration(t, t.knots, MODES),
            abs=found.peaks.acceleration.max() * STEPS_INSIDE), planner_id
