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

"""The arm pursues a goal: how it ends, and what interrupts it at any instant."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.control.computed_torque import ControllerGains
from rrr_traj_planner.core.control.goal_end import HELD, OUT_OF_RANGE, RESET, ResultCode
from rrr_traj_planner.core.control.tolerances import Tolerances
from rrr_traj_planner.core.simulation.arm_settings import ArmSettings
from rrr_traj_planner.core.simulation.controlled_arm import ControlledArm
from rrr_traj_planner.core.trajectory.trajectory_points import TrajectoryPoints

# Motors that follow quick motions too [N m].
LIMITS = JointLimits(max_effort=np.full(3, 1000.0))
SETTINGS = ArmSettings(RobotModel(), LIMITS, ControllerGains())
STEP = SETTINGS.step
Q = np.array([0.5, 1.1, 0.2])
END = Q + (0.2, -0.2, 0.3)
PUSH = (-1500.0, 0.0, 0.0)  # more than the motor of joint 1 has
ZERO = np.zeros(3)


def to(*ends, duration=2.0, velocity=ZERO):
    """Return points that lead to rest at each of some ends, or pass the last with a velocity."""
    n = len(ends)
    velocities = np.zeros((n, 3))
    velocities[-1] = velocity
    return TrajectoryPoints(duration * np.arange(1, n + 1), ends, velocities, np.zeros((n, 3)),
                            np.ones(n, bool), np.ones(n, bool))


def pursuing(points=None, tolerances=None, **changes):
    """Return an arm that has just got a goal."""
    arm = ControlledArm(replace(SETTINGS, **changes), Q)
    arm.pursue(points or to(END), arm.now, tolerances or arm.settings.tolerances)
    return arm


def ended(arm, within=5.0):
    """Return how the goal of an arm ends, and when."""
    while arm.watch.goal_end is None:
        assert arm.time < within
        arm.advance(1)
    return arm.watch.goal_end, arm.time


@pytest.mark.parametrize('tolerances', [
    Tolerances(), Tolerances(trajectory=(0.1,) * 3, goal=(0.01,) * 3, goal_time=0.5)])
def test_goal_is_reached_at_the_end_of_its_trajectory(tolerances):
    end, time = ended(pursuing(tolerances=tolerances))
    assert end.code is ResultCode.SUCCESSFUL
    assert time == pytest.approx(2.0 + STEP)  # judged in the step that begins there


def test_goal_is_reached_once_the_arm_is_slow_enough():
    arm = pursuing(tolerances=Tolerances(stopped_velocity=(1e-7,) * 3))
    end, time = ended(arm)
    assert end.code is ResultCode.SUCCESSFUL
    assert 2.0 + STEP < time < 2.5
    assert np.abs(arm.state[3:]).max() <= 1e-7


def test_blocked_arm_violates_the_path_tolerance():
    arm = pursuing(tolerances=Tolerances(trajectory=(0.05,) * 3))
    arm.disturbance = PUSH
    end, time = ended(arm)
    assert end.code is ResultCode.PATH_TOLERANCE_VIOLATED and time < 2.0
    assert end.text.startswith(
        'Aborted due to path tolerance violation: joint_1 Position Error 0.05')
    assert arm.violation[0] == 'State tolerances failed for joint 0:' and len(arm.violation) == 2


def test_arm_that_is_held_off_violates_the_goal_tolerance_after_its_time():
    arm = pursuing(tolerances=Tolerances(goal=(1e-3,) * 3, goal_time=0.5))
    arm.disturbance = (60.0, 0.0, 0.0)
    end, time = ended(arm)
    assert end.code is ResultCode.GOAL_TOLERANCE_VIOLATED
    assert time == pytest.approx(2.5 + 2 * STEP)
    assert end.text.startswith(
        'Aborted due to goal_time_tolerance exceeding by 0.501000 seconds: joint_1 Position Error')


def test_goal_that_is_never_reached_times_out():
    arm = pursuing(tolerances=Tolerances(goal=(1e-3,) * 3, cmd_timeout=0.5))
    arm.disturbance = (60.0, 0.0, 0.0)
    end, time = ended(arm)
    assert (end.code, end.text) == (ResultCode.GOAL_TOLERANCE_VIOLATED,
                                    'Aborted due to command timeout')
    assert time == pytest.approx(2.5 + 2 * STEP)


def test_trajectory_meanwhile_replaces_the_motion_of_the_goal():
    arm = pursuing(tolerances=Tolerances(trajectory=(0.05,) * 3))
    arm.advance(500)
    arm.follow(to(Q), arm.now)
    assert arm.watch.goal_end is None
    end, time = ended(arm)
    assert end.code is ResultCode.SUCCESSFUL and time == pytest.approx(2.5 + STEP)
    np.testing.assert_allclose(arm.state[:3], Q, atol=1e-5)
    arm.follow(to(END), arm.now)  # it is no goal's any more, nor with its tolerances
    arm.disturbance = PUSH
    arm.advance(500)
    assert arm.violation == () and arm.watch.goal is None


def test_goal_with_a_velocity_at_its_end_is_reached_there():
    arm = pursuing(to(END, velocity=(0.1, 0.0, 0.0)))
    end, time = ended(arm)
    assert end.code is ResultCode.SUCCESSFUL and time == pytest.approx(2.0)
    assert arm.motion.final[0] > END[0]  # and brakes from there


def test_goal_outside_the_ranges_is_invalid():
    arm = pursuing(to((-1.0, 1.0, 0.0)))
    end = arm.watch.goal_end
    assert end.code is ResultCode.INVALID_GOAL
    assert end.text.startswith('Aborted: the trajectory would end with joint_1 at -1 rad, range')


def test_what_stops_the_arm_ends_its_goal():
    for stop, expected in ((lambda arm: arm.hold(), HELD), (lambda arm: arm.reset(Q), RESET)):
        arm = pursuing()
        arm.advance(300)
        stop(arm)
        assert arm.watch.goal_end is expected
    arm = pursuing()
    arm.advance(300)
    arm.configure(replace(SETTINGS, limits=replace(LIMITS, max_position=(0.6, 3.0, 6.0))))
    assert arm.watch.goal_end is OUT_OF_RANGE


def test_goals_are_canceled_and_replaced_at_any_instant_without_a_step():
    rng = np.random.default_rng(3)
    for instant in rng.integers(1, 2000, 12):
        ends = rng.uniform(Q - 0.2, Q + 0.2, (2, 3))
        arm = pursuing(to(ends[0]))
        arm.advance(int(instant))
        before = np.array(arm.desired)
        if instant % 2:
            arm.hold()
            assert arm.watch.goal_end is HELD
        else:
            arm.pursue(to(ends[1]), arm.now, SETTINGS.tolerances)
            assert arm.watch.goal_end is None
        np.testing.assert_allclose(arm.desired[:6], before[:6], atol=1e-9)
        arm.advance(4000)
        assert arm.watch.goal_end.code in (ResultCode.SUCCESSFUL, ResultCode.INVALID_GOAL)
        assert not np.any(arm.desired[3:])
        assert (arm.state[:3] > LIMITS.min_position).all()
        assert (arm.state[:3] < LIMITS.max_position).all()
        if not instant % 2:
            np.testing.assert_allclose(arm.state[:3], ends[1], atol=1e-6)
