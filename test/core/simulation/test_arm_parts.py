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

"""Friction, bumpers, event search, pace and step: what each promises by itself."""

from __future__ import annotations

from math import inf, nan, sin

import numpy as np
import pytest
from rrr_traj_planner.core.arm.friction import Friction
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.nanoseconds import SECOND
from rrr_traj_planner.core.simulation.root_finding import EVENT_TOLERANCE, locate_event
from rrr_traj_planner.core.simulation.schedule import Schedule
from rrr_traj_planner.core.simulation.simulated_clock import SimulatedClock
from rrr_traj_planner.core.simulation.soft_stops import SoftStops
from rrr_traj_planner.core.simulation.step_stability import check_step

LOW, HIGH = (0.0, 0.0, -1.0), (1.0, 2.0, 1.0)


# Friction


@pytest.mark.parametrize(('fields', 'text'), [
    ({'viscous': [1.0, -2.0, 0.0]}, r'^viscous is \[1.0, -2.0, 0.0\] N m s/rad'),
    ({'coulomb': [1.0, nan, 0.0]}, r'^coulomb\[1\] is nan'),
    ({'coulomb': [1.0]}, r'^coulomb has shape \(1,\)')])
def test_friction_that_would_push_is_refused(fields, text):
    with pytest.raises(InvalidInputError, match=text):
        Friction(**fields)


def test_friction_knows_whether_there_is_any():
    assert Friction().is_none
    assert not Friction(coulomb=[0.0, 0.0, 1.0]).is_none


# Bumpers


def test_bumper_pushes_with_spring_and_damper_and_never_pulls():
    soft = SoftStops(0.1, 100.0, 0.5)
    assert soft.push(0.02, 0.0) == (2.0, 0.0)
    torque, heat = soft.push(0.02, 1.0)
    assert (torque, heat) == (pytest.approx(3.0), pytest.approx(1.0))
    assert soft.push(0.02, -10.0) == (0.0, pytest.approx(20.0))  # it lags behind
    rng = np.random.default_rng(2)
    for depth, rate in rng.uniform((0.0, -50.0), (0.1, 50.0), (200, 2)):
        torque, heat = soft.push(depth, rate)
        assert torque >= 0.0
        assert heat >= -1e-12


def test_bumpers_are_pressed_beyond_the_range_alone():
    soft = SoftStops(0.1, 100.0, 0.5)
    state = (-0.05, 2.02, 0.5, 0.0, 0.0, 0.0)
    assert soft.sides(state, LOW, HIGH) == (1, -1, 0)
    assert soft.energy(state, LOW, HIGH) == pytest.approx(50.0 * (0.05 ** 2 + 0.02 ** 2))
    assert SoftStops().sides(state, LOW, HIGH) == (0, 0, 0)
    assert SoftStops().energy(state, LOW, HIGH) == 0.0


@pytest.mark.parametrize('name', ['width', 'stiffness', 'damping'])
def test_bumpers_that_would_pull_are_refused(name):
    for value in (-1.0, nan, inf):
        with pytest.raises(InvalidInputError, match=f'^{name} is .* must (not be|be finite)'):
            SoftStops(**{name: value})


# Events


@pytest.mark.parametrize(('margin', 'first', 'when'), [
    (lambda x: 0.3 - x, 0.3, 0.3), (lambda x: sin(3.0 * x), 0.0, np.pi / 3.0),
    (lambda x: 1e-3 - x ** 5, 1e-3, 1e-3 ** 0.2), (lambda x: x * (0.9 - x), 0.0, 0.9),
    (lambda x: 1.0 if x < 0.123 else 0.123 - x, 1.0, 0.123)])
def test_event_is_found_just_past(margin, first, when):
    h = 1.3
    time, outcome = locate_event(lambda x: x, margin, first, h, margin(h))
    assert time == outcome == pytest.approx(when, abs=1e-9)
    assert -EVENT_TOLERANCE <= margin(time) < 0.0


# SimulatedClock


def test_time_runs_at_its_factor_from_where_it_was_changed():
    pace = SimulatedClock(2.0, 5 * SECOND)
    assert pace.due(6 * SECOND, 0, SECOND) == 2 * SECOND
    pace.restart(6 * SECOND, 2 * SECOND, factor=10.0)
    assert pace.due(7 * SECOND, 2 * SECOND, SECOND) == 12 * SECOND


def test_as_fast_as_can_be_there_is_always_more_due():
    assert SimulatedClock(0.0, 0).due(0, 7 * SECOND, SECOND) == 8 * SECOND


def test_pause_is_not_made_up_for():
    pace = SimulatedClock(1.0, 0)
    pace.restart(3 * SECOND, 3 * SECOND, paused=True)
    assert pace.due(50 * SECOND, 3 * SECOND, SECOND) == 3 * SECOND
    pace.restart(60 * SECOND, 3 * SECOND, paused=False)
    assert pace.due(61 * SECOND, 3 * SECOND, SECOND) == 4 * SECOND


# Schedule


@pytest.mark.parametrize('rate', [1.0, 5.0, 29.97, 200.0, 333.3, 1000.0])
def test_instants_come_at_the_requested_rate(rate):
    schedule, came = Schedule(rate, 7 * SECOND), []
    for now in range(7 * SECOND, 17 * SECOND, SECOND // 1000):  # steps of 1 ms
        if schedule.passed(now):
            came.append(now - 7 * SECOND)
    assert came[0] == 0
    assert abs(len(came) - 10.0 * rate) <= 1.0
    late = np.array(came) - np.arange(len(came)) * SECOND / rate
    assert ((late > -1.0) & (late <= SECOND // 1000)).all()


def test_instants_between_two_calls_come_as_one():
    schedule = Schedule(100.0, 0)
    assert schedule.passed(SECOND) and schedule.next == SECOND + SECOND // 100
    assert not schedule.passed(SECOND)


# Step


def test_friction_that_a_step_can_follow_passes():
    check_step(RobotModel(friction=Friction([50.0] * 3)), SoftStops(0.1, 1e4, 0.2), 1e-3)
    check_step(RobotModel(), SoftStops(0.0, 1e9), 1e-3)  # no width, no bumper


@pytest.mark.parametrize(('friction', 'soft', 'text'), [
    (Friction([0.0, 0.0, 1e5]), SoftStops(), r'friction.viscous is .*, too much'),
    (Friction(), SoftStops(0.1, 1e12),
     r'soft_stops.stiffness is 1e\+12 N m/rad, must be at most')])
def test_friction_and_bumpers_that_are_too_hard_for_the_step_are_refused(friction, soft, text):
    with pytest.raises(InvalidInputError, match=text):
        check_step(RobotModel(friction=friction), soft, 1e-3)
