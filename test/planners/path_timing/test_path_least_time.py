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

"""The fastest motion along a path: against a second method, and by the laws of time."""

from functools import cache

from helpers.measured_motions import Measured
from helpers.phase_plane import least_time
from helpers.random_paths import NONE, PathCase, random_case
import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.planners.path_timing.least_time import fastest_along
from rrr_traj_planner.planners.path_timing.task import PathTask
from rrr_traj_planner.planners.request import PlanningRequest

SEEDS = range(12)
# The second method has each interval's limits in its middle, and acceleration free to jump.
BELOW = 0.995
ABOVE = 1.08
CONVERGED = 2e-3   # relative, of two motions that each are within 1e-3 of the fastest


@cache
def free_time(seed):
    """Return a case and how long its path takes with velocity and acceleration limits only."""
    case = random_case(seed)
    return case, case.timed(max_effort=NONE, max_jerk=NONE).duration


@pytest.mark.parametrize('seed', SEEDS)
def test_time_is_within_8_percent_of_a_second_method_s_and_not_below(seed):
    case, T = free_time(seed)
    least = least_time(case.arm_path, case.limits)
    assert BELOW * least <= T <= ABOVE * least


def test_second_method_finds_the_time_of_a_bang_bang_motion():
    # One joint moves, with constant acceleration: a quarter turn about joint axis 1, in 40 legs
    # so short that the path is as good as its circle.
    angle = np.linspace(0.0, np.pi / 2, 41)
    tips = np.stack((np.cos(angle), np.sin(angle), np.full(41, 0.6)), axis=1)
    limits = JointLimits(min_position=[-1.0, -4.0, -4.0], max_position=[3.0, 4.0, 4.0],
                         max_velocity=[9.0] * 3, max_acceleration=[1.0, 50.0, 50.0])
    case = PathCase(RobotModel(), limits, PlanningRequest(
        tips, planner_id='line_arc', elbow='up', max_deviation=0.1))
    assert least_time(case.arm_path, limits) == pytest.approx(
        2.0 * np.sqrt(np.pi / 2), rel=5e-3)


@pytest.mark.parametrize('seed', SEEDS)
def test_slower_limits_are_never_faster(seed):
    case, T = free_time(seed)
    for name in ('max_velocity', 'max_acceleration'):
        slower = case.timed(max_effort=NONE, max_jerk=NONE,
                            **{name: 0.7 * getattr(case.limits, name)}).duration
        assert slower >= T * (1.0 - CONVERGED)
    assert case.timed(max_effort=NONE, max_jerk=np.full(3, 8.0)).duration >= T * (1.0 - CONVERGED)


@pytest.mark.parametrize('seed', SEEDS)
def test_limits_of_k_k_squared_and_k_cubed_take_a_kth_of_the_time(seed):
    case, k = random_case(seed), 1.6
    limits = {'max_effort': NONE, 'max_jerk': np.minimum(case.limits.max_jerk, 50.0)}
    T = case.timed(**limits).duration
    faster = case.timed(max_effort=NONE, max_jerk=k ** 3 * limits['max_jerk'],
                        max_velocity=k * case.limits.max_velocity,
                        max_acceleration=k ** 2 * case.limits.max_acceleration).duration
    assert k * faster == pytest.approx(T, rel=CONVERGED)


@pytest.mark.parametrize('seed', SEEDS)
def test_tip_speed_limit_holds_and_is_reached(seed):
    case, T = free_time(seed)
    speed = 0.5 * case.arm_path.path.length / T  # half of the average
    motion = case.timed(speed, max_effort=NONE, max_jerk=NONE)
    fastest = motion.progress(np.linspace(0.0, motion.duration, 20001))[1].max()
    assert 0.99 * speed <= fastest <= speed * (1.0 + 1e-6)
    assert motion.duration >= case.arm_path.path.length / speed


@pytest.mark.parametrize('seed', SEEDS)
def test_joins_are_passed_at_knots_exactly(seed):
    # To rounding, before a knot acceleration would have the value of the piece before it.
    case, _ = free_time(seed)
    motion = case.timed(max_effort=NONE, max_jerk=NONE).time_scaled(1.37)
    assert np.isin(motion.join_times, motion.knots).all()
    found = motion.arm_path(motion.arm_path.path.joins)
    _, sd, sdd, _ = (f[:, np.newaxis] for f in motion.progress(motion.join_times))
    assert motion(motion.join_times)[2] == pytest.approx(
        found.ddq * sd ** 2 + found.dq * sdd, abs=1e-9)


@pytest.mark.parametrize('seed', range(4))
@pytest.mark.parametrize('iterations', [0, 12, 24])
def test_planning_stopped_early_gives_a_motion_within_limits_that_never_stops(seed, iterations):
    case, left = random_case(seed), [iterations]

    def should_stop():
        left[0] -= 1
        return left[0] < 0

    found = fastest_along(PathTask(
        case.arm_path, case.limits, np.inf, False, should_stop))
    m = Measured(case, trajectory=found.trajectory)
    assert m.utilisation().max() <= 1.0 + 1e-6
    assert m.trajectory.progress(m.t)[1].min() >= -1e-12
    assert found.gap > 0.0
