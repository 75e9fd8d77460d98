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

"""The studio with another controller's arm: asked before it moves, without services of its own."""

from __future__ import annotations

from helpers.arm_in_ros import Arm, moving
from helpers.move_client import start_motion_server
from helpers.other_controller import OtherController
from helpers.plan_requests import TABLE_6_1
from helpers.planner_in_ros import start_planner
from helpers.studio_page import Page, studio_of
import numpy as np
import pytest
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.nodes.studio.execution.commands import CHANGED, NO_MOTION
from rrr_traj_planner.nodes.studio.execution.execution import STOPPED
from rrr_traj_planner.nodes.studio.ros_client import StudioClient

LEAD = 0.3  # s


def studio_for(ros, page, controller):
    """Return client and studio for the arm of a controller."""
    start_planner(ros)
    start_motion_server(ros, controller_name=controller, replanning_lead=LEAD)
    client = ros.add(StudioClient(controller, context=ros.context))
    return client, studio_of(ros, client, page)


@pytest.mark.parametrize('by_joint_states', [True, False])
def test_arm_of_another_controller_is_moved_after_a_question(ros, by_joint_states):
    controller, page = OtherController(ros, '/arm_controller', by_joint_states), Page()
    try:
        client, studio = studio_for(ros, page, '/arm_controller')
        question = studio.commands.question()
        assert question.text.startswith('/arm_controller moves the arm through 3 via points')
        assert 'cycloid' in question.text and 'goes there first' not in question.text
        ros.run(studio.commands.run)
        assert CHANGED in page.statuses[-1][0]
        ros.run(lambda: studio.commands.run(question.wanted))
        page.wait(lambda p: 'reached the last via point' in p.statuses[-1][0])
        tip = forward_kinematics(RobotModel(), controller.q)
        np.testing.assert_allclose(tip, TABLE_6_1[2], atol=1e-6)
        page.wait(lambda p: np.linalg.norm(np.subtract(p.places[-1], TABLE_6_1[2])) < 1e-6)
        assert 'goes there first' in studio.commands.question().text
    finally:
        ros.run(controller.destroy)
    assert client.replanning_lead == LEAD


def test_answer_to_an_old_question_moves_nothing_and_hold_stops(ros):
    arm, page = Arm(ros), Page()
    _, studio = studio_for(ros, page, '/simulated_arm')
    old = studio.commands.question()
    ros.run(lambda: studio.editor.change(  # slow: it is stopped in time on any machine
        studio.editor.wanted.moved(1, (0.5, 0.5, 1.3)).with_scalings(0.2, 0.2)))
    page.wait(lambda p: studio.session.is_current)
    ros.run(lambda: studio.commands.run(old.wanted))
    assert CHANGED in page.statuses[-1][0]
    ros.run(studio.commands.hold)
    assert NO_MOTION in page.statuses[-1][0]
    question = studio.commands.question()
    ros.run(lambda: studio.commands.run(question.wanted))
    page.wait(lambda p: ' s left' in p.statuses[-1][0])
    ros.run(studio.commands.hold)
    page.wait(lambda p: STOPPED in p.statuses[-1][0])
    arm.actual.wait_for_next(lambda m: not moving(m))
    assert np.linalg.norm(np.subtract(page.places[-1], TABLE_6_1[2])) > 0.1


def test_without_a_plan_nothing_is_asked(ros):
    Arm(ros)
    page = Page()
    _, studio = studio_for(ros, page, '/simulated_arm')
    ros.run(lambda: studio.move_point(1, (9.0, 9.0, 9.0)))
    page.wait(lambda p: p.refusal is not None)
    assert studio.commands.question() is None


def test_point_is_dragged_in_the_motion_of_a_controller_that_gives_no_feedback(ros):
    controller, page, place = OtherController(ros, '/arm_controller'), Page(), (0.5, 0.5, 1.3)
    try:
        _, studio = studio_for(ros, page, '/arm_controller')
        ros.run(lambda: studio.editor.change(studio.editor.wanted.with_scalings(0.3, 0.3)))
        page.wait(lambda p: studio.session.is_current)
        question = studio.commands.question()
        ros.run(lambda: studio.commands.run(question.wanted))
        page.wait(lambda p: ' s left' in p.statuses[-1][0])
        assert 'tracking' not in page.statuses[-1][0]  # of which nobody tells
        ros.run(lambda: studio.move_point(2, place))
        page.wait(lambda p: 'reached the last via point' in p.statuses[-1][0])
        np.testing.assert_allclose(
            forward_kinematics(RobotModel(), controller.q), place, atol=1e-6)
    finally:
        ros.run(controller.destroy)


def test_wrong_name_of_a_controller_is_refused(ros):
    with pytest.raises(InvalidInputError, match='--controller is .*, must be a name'):
        StudioClient('arm controller', context=ros.context)
