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

"""`gauss` and `septic`: what the function changes, and what it does not."""

from dataclasses import replace

from helpers.planning_cases import ARM, LIMITS, STRONG, table
import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.errors import InvalidInputError, LimitViolationError, TimingError
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.motion_laws.cycloid_transitions import CYCLOID
from rrr_traj_planner.core.motion_laws.gauss import gauss
from rrr_traj_planner.core.motion_laws.septic import SEPTIC
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.request import PlanningRequest
from rrr_traj_planner.planners.tasks import JointTask
from rrr_traj_planner.planners.transitions.planner import planner_with
from rrr_traj_planner.planners.transitions.via_problem import via_problem_of

FREE = replace(LIMITS, max_effort=np.full(3, np.inf), max_jerk=np.full(3, np.inf),
               max_velocity=np.full(3, np.inf))
PLANNERS = ['gauss', 'septic']

# Peaks of the acceleration over its mean; by quadrature of exp(-u^2/2) - exp(-2) within 2 sigma
# (1.8683), and 15/8. The cycloid's is 2.
PEAK = {'cycloid': 2.0, 'gauss': 1.8683, 'septic': 15.0 / 8.0}
TABLES = {'6.1': 2.850, '6.3': 3.490}  # s, known of the cycloid


@pytest.mark.parametrize('planner_id', PLANNERS)
@pytest.mark.parametrize('name', TABLES)
def test_least_time_is_the_cycloid_s_by_the_root_of_the_peaks(planner_id, name):
    # With acceleration limits alone the same motion is run through at another rate: transitions
    # last as long as their peak is high, and all that counts of them is how long they last.
    found = plan(ARM, FREE, table(name, planner_id=planner_id)).trajectory.duration
    assert found == pytest.approx(
        TABLES[name] * np.sqrt(PEAK[planner_id] / PEAK['cycloid']), rel=5e-4)


@pytest.mark.parametrize('planner_id', PLANNERS)
def test_one_joint_alone_takes_the_time_of_two_transitions(planner_id):
    # 0.5 rad at 1 rad/s^2: u t = 0.5 with t = peak u: 2 t = 2 sqrt(0.5 peak).
    q = np.array([[0.3, 1.5, 0.0], [0.8, 1.5, 0.0]])
    task = JointTask(ARM, FREE, q, None, 0.01)
    motion = planner_with({'gauss': gauss(), 'septic': SEPTIC}[planner_id])(task)
    assert motion.duration == pytest.approx(2.0 * np.sqrt(0.5 * PEAK[planner_id]), rel=1e-4)
    assert motion.peaks().acceleration[0] == pytest.approx(1.0, rel=1e-5)


@pytest.mark.parametrize('planner_id', PLANNERS)
def test_jerk_limits_hold_and_are_reached(planner_id):
    tight = replace(FREE, max_jerk=[2.0, 2.0, 2.0])
    peaks = plan(ARM, tight, table('6.1', planner_id=planner_id)).peaks
    assert (peaks.jerk <= 2.0 * (1.0 + 1e-6)).all()
    assert peaks.jerk.max() == pytest.approx(2.0, rel=1e-4)


@pytest.mark.parametrize('planner_id', PLANNERS)
def test_table_6_3_is_slowed_to_the_torque_that_there_is(planner_id):
    with pytest.raises(LimitViolationError, match=r'joint_2 needs 218\.9 N m to hold'):
        plan(ARM, LIMITS, table('6.3', planner_id=planner_id))
    weak = replace(STRONG, max_effort=[150.0, 222.0, 200.0])
    free, slowed = (plan(ARM, limits, table('6.3', planner_id=planner_id))
                    for limits in (STRONG, weak))
    assert slowed.effort[1] == pytest.approx(222.0, rel=1e-5)
    assert slowed.trajectory.duration > free.trajectory.duration


@pytest.mark.parametrize('planner_id', PLANNERS)
@pytest.mark.parametrize('durations', [[4.0, 4.0], [10.0, 3.5], [3.0, 30.0]])
def test_prescribed_durations_are_kept(planner_id, durations):
    answer = plan(ARM, LIMITS, table('6.1', planner_id=planner_id, segment_durations=durations))
    assert answer.via_times == pytest.approx([0.0, durations[0], sum(durations)], abs=1e-9)
    assert (answer.effort <= LIMITS.max_effort * (1.0 + 1e-6)).all()


@pytest.mark.parametrize('planner_id', PLANNERS)
def test_durations_too_short_are_refused_with_feasible_ones_that_are_then_accepted(planner_id):
    request = table('6.1', planner_id=planner_id, segment_durations=[1.0, 1.0])
    with pytest.raises(TimingError, match='^segment_durations .* s are too short') as no:
        plan(ARM, LIMITS, request)
    least = no.value.least_durations
    answer = plan(ARM, LIMITS, replace(request, segment_durations=least))
    assert np.diff(answer.via_times) == pytest.approx(least, abs=1e-9)


@pytest.mark.parametrize('planner_id', PLANNERS)
def test_missing_acceleration_limit_is_refused_by_function_and_joint(planner_id):
    limits = replace(LIMITS, max_acceleration=[1.0, np.inf, 1.0])
    with pytest.raises(InvalidInputError, match=(
            f'^a planner of {planner_id} transitions needs acceleration limits, joint_2 has ')):
        plan(ARM, limits, table('6.1', planner_id=planner_id))


def test_law_is_the_function_s_peaks_over_the_limits():
    # Peak acceleration 15/8 D / t, peak jerk 10 / sqrt(3) D / t^2.
    limits = JointLimits(max_acceleration=[3.75] * 3, max_jerk=[40.0 / np.sqrt(3.0)] * 3)
    q = np.array([[0.3, 1.4, 0.0], [1.0, 1.8, 0.3]])
    law = via_problem_of(JointTask(ARM, limits, q, None, 0.01), SEPTIC).law
    assert law.slope == pytest.approx([0.5] * 3)
    assert law.root == pytest.approx([0.5] * 3)


def test_transitions_at_full_acceleration_last_five_samples_whatever_the_function():
    q = np.array([[0.3, 1.4, 0.0], [1.0, 1.8, 0.3]])
    for function in (CYCLOID, SEPTIC, gauss(), gauss(3.0)):
        law = via_problem_of(JointTask(ARM, FREE, q, None, 0.1), function).law
        # the change of velocity at which both rules ask for the same duration
        change = (law.root / law.slope) ** 2
        assert law.least_time(change) == pytest.approx([0.5] * 3)


def test_series_of_order_9_takes_the_time_of_the_closed_form_to_a_thousandth():
    q = plan(ARM, FREE, table('6.1')).trajectory
    task = JointTask(ARM, FREE, q(q.via_times)[0], None, 0.01)
    closed, series = (planner_with(gauss(order=order))(task).duration for order in (None, 9))
    assert series == pytest.approx(closed, rel=1e-3)
    assert series != closed


@pytest.mark.parametrize('planner_id', ['cycloid', *PLANNERS])
def test_a_joint_that_is_to_stay_at_the_end_of_its_range_stays_there_however_slow_the_arm(
        planner_id):
    # Joint 1 is at 0, where its range ends, twice in a row, and segments last for minutes: a via
    # velocity of 1e-9 rad/s, which a search might leave, would take it beyond in the meantime.
    q = np.array([[0.9, 0.8, 0.3], [0.0, 1.5, 0.1], [0.0, 0.7, 0.5], [0.0, 1.6, -0.1],
                  [1.2, 0.9, 0.2]])
    slow = replace(LIMITS, max_acceleration=np.full(3, 1e-5), max_jerk=np.full(3, 1e-5))
    answer = plan(ARM, slow, PlanningRequest(
        forward_kinematics(ARM, q), planner_id=planner_id, sample_period=5.0))
    assert answer.peaks.min_position[0] >= -1e-9
    assert answer.trajectory(answer.via_times)[0] == pytest.approx(q, abs=1e-9)


def test_durations_too_short_beside_a_stay_are_refused_without_arithmetic_on_zeros():
    q = [[0.3, 1.4, 0.0], [1.0, 1.8, 0.3], [1.0, 1.8, 0.3], [0.2, 1.3, -0.5]]
    with np.errstate(all='raise'), pytest.raises(TimingError, match='for segments 0, 2: ') as no:
        plan(ARM, LIMITS, PlanningRequest(
            forward_kinematics(ARM, np.array(q)), segment_durations=[0.5, 2.0, 0.5]))
    assert no.value.least_durations[1] == pytest.approx(2.0, abs=1e-5)
