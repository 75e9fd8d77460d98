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

"""The panel's options with real nodes: posture, deviation, joint positions, times, payload."""

from __future__ import annotations

from dataclasses import replace
from time import monotonic

from helpers.arm_in_ros import Arm
from helpers.move_client import start_motion_server
from helpers.plan_requests import TABLE_6_1
from helpers.planner_in_ros import parameter_value, plan, start_planner
from helpers.studio_page import Page, studio_of
import numpy as np
import pytest
from rcl_interfaces.srv import GetParameters
from rrr_traj_planner.core.arm.payload import Payload
from rrr_traj_planner.nodes.studio.edits import with_duration, with_dwell
from rrr_traj_planner.nodes.studio.ros_client import StudioClient
from rrr_traj_planner.nodes.studio.studio import NO_PLAN_TO_KEEP

SOON = 5.0           # s, after which the arm has been told
MASS = 2.0           # kg, at the tip
TOO_HEAVY = 2.0e4    # kg, above the parameter's range
NOT_HELD = 40.0      # kg, that joint 2 cannot hold at arm's length
FAR_AWAY = (9.0, 9.0, 9.0)
BOTH_ELBOWS = ((0.6, 0.6, 1.4), (0.4, 0.7, 1.3), (0.45, 0.38, 1.45))  # m
DIGITS = 1e-9        # s, of a duration in whole nanoseconds


@pytest.fixture
def page():
    return Page()


@pytest.fixture
def studio(ros, page):
    """Give a test the studio with all nodes, and its first plan."""
    start_planner(ros)
    start_motion_server(ros)
    Arm(ros)
    client = ros.add(StudioClient(context=ros.context))
    return studio_of(ros, client, page)


def changed(ros, page, studio, change):
    """Change what is wanted, and return its plan."""
    ros.run(lambda: studio.editor.change(change(studio.editor.wanted)))
    page.wait(lambda _: studio.session.is_current)
    return studio.session.plan


def elsewhere(wanted):
    """Return via points that the arm reaches with its elbow up and down."""
    for index, place in enumerate(BOTH_ELBOWS):
        wanted = wanted.moved(index, place)
    return wanted


def carries(ros, *payload):
    """Return whether the arm comes to carry a payload: mass [kg], whether it is known."""
    names, deadline = ['payload.mass', 'payload.known_to_controller'], monotonic() + SOON
    while monotonic() < deadline:
        mass, known = ros.call(GetParameters, 'simulated_arm/get_parameters',
                               GetParameters.Request(names=names)).values
        if (mass.double_value, known.bool_value) == payload:
            return True
    return False


def test_posture_deviation_rest_and_times_are_the_planner_s(ros, page, studio):
    first = studio.session.plan.duration
    down = changed(ros, page, studio, lambda w: replace(elsewhere(w), elbow='down'))
    response = plan(ros, BOTH_ELBOWS, elbow='down')
    assert down.duration == pytest.approx(response.via_times[-1], abs=DIGITS)
    up = changed(ros, page, studio, lambda w: replace(w, elbow='up'))
    assert (np.cos(down.via_joints[:, 2]) < 0.0).all()  # thesis (5.8): the elbow's factor
    assert (np.cos(up.via_joints[:, 2]) > 0.0).all()
    for _ in range(2):
        ros.run(studio.editor.undo)

    def line(wanted):
        return replace(wanted, elbow='', shoulder='', max_deviation=0.01).with_planner('line_arc')

    near = changed(ros, page, studio, line)
    response = plan(ros, TABLE_6_1, planner_id='line_arc', max_deviation=0.01)
    assert near.duration == pytest.approx(response.via_times[-1], abs=DIGITS)
    ros.run(lambda: studio.editor.change(with_duration(
        studio.editor.wanted.with_planner('cycloid'), 1, 4.0)))
    page.wait(lambda _: page.refusal is not None)
    assert page.refusal.text == (
        'time of via point 2 is not given: planner cycloid takes every duration or none')
    ros.run(studio.editor.undo)
    rests = changed(ros, page, studio, lambda w: with_dwell(w.with_planner('cycloid'), 1, 0.75))
    assert rests.duration > first + 0.75
    timed = changed(ros, page, studio, lambda w: with_duration(
        with_duration(with_dwell(w, 1, 0.0), 1, 4.0), 2, 3.0))
    assert timed.duration == pytest.approx(7.0, abs=DIGITS)


def test_plan_through_kept_joints_is_the_same_in_another_posture_too(ros, page, studio):
    down = changed(ros, page, studio, lambda w: replace(elsewhere(w), elbow='down'))
    ros.run(lambda: studio.keep_joints(True))
    page.wait(lambda _: studio.session.is_current)
    kept = studio.session.plan
    assert kept.duration == pytest.approx(down.duration, abs=1e-6)
    np.testing.assert_allclose(kept.via_joints, down.via_joints, atol=1e-6)
    ros.run(lambda: studio.editor.move(1, FAR_AWAY))
    page.wait(lambda _: page.refusal is not None)
    assert page.refusal.via_point == 1
    ros.run(lambda: studio.keep_joints(False))
    ros.run(lambda: studio.keep_joints(True))
    assert NO_PLAN_TO_KEEP in page.statuses[-1][0] and studio.editor.wanted.joints is None


def test_payload_is_planned_with_and_carried(ros, page, studio):
    """At rest with a mass more at the tip, joint 2 needs its weight times its distance more."""
    def holding(found):
        return found.curves['torque'][-1, 1] * 200.0  # N m, joint 2's limit

    without = holding(studio.session.plan)
    loaded = changed(ros, page, studio, lambda w: replace(w, payload=Payload(MASS, True)))
    x, y, _ = TABLE_6_1[2]
    assert holding(loaded) - without == pytest.approx(MASS * 9.81 * np.hypot(x, y), rel=1e-6)
    assert parameter_value(ros, 'payload.mass').double_value == MASS
    assert carries(ros, MASS, True)
    ros.run(lambda: studio.editor.change(
        replace(studio.editor.wanted, payload=Payload(TOO_HEAVY, True))))
    page.wait(lambda _: page.refusal is not None)
    assert page.refusal.text == 'payload is 20000.0 kg, must be in [0.0, 10000.0] kg'
    ros.run(studio.editor.undo)
    page.wait(lambda _: studio.session.is_current)
    assert carries(ros, MASS, True)
    ros.run(studio.editor.undo)
    page.wait(lambda _: studio.session.is_current)
    assert carries(ros, 0.0, False)
    assert holding(studio.session.plan) == pytest.approx(without)


def test_payload_without_a_plan_is_compared_with_and_never_carried(ros, page, studio):
    ros.run(lambda: studio.editor.change(
        replace(studio.editor.wanted, payload=Payload(NOT_HELD, True))))
    page.wait(lambda _: page.refusal is not None)
    assert 'torque' in page.refusal.text or 'N m' in page.refusal.text
    ros.run(lambda: studio.comparison.start(studio.session.wanted))
    page.wait(lambda _: not studio.comparison.waits_for)
    assert studio.comparison.rows and not studio.comparison.planned
    assert parameter_value(ros, 'payload.mass').double_value == NOT_HELD
    assert carries(ros, 0.0, False)
    ros.run(studio.editor.undo)
    page.wait(lambda _: studio.session.is_current)
    assert parameter_value(ros, 'payload.mass').double_value == 0.0


def test_payload_of_a_plan_that_is_taken_from_the_comparison_is_carried(ros, page, studio):
    """Until there is a plan, the arm carries what it did."""
    ros.run(lambda: studio.editor.change(replace(
        studio.editor.wanted, payload=Payload(MASS, False), max_deviation=1e-9).with_planner(
            'line_arc')))
    page.wait(lambda _: page.refusal is not None)
    assert page.refusal.text.startswith('deviation is 1e-09 m, must be 0 or in ')
    assert carries(ros, 0.0, False)
    ros.run(lambda: studio.comparison.start(studio.session.wanted))
    page.wait(lambda _: 'cycloid' in studio.comparison.planned)
    ros.run(lambda: studio.take('cycloid'))
    assert carries(ros, MASS, False)
