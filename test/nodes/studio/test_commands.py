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

"""Run, Hold and Reset: what the newest of them has come to is what the page says."""

from __future__ import annotations

import numpy as np
import pytest
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.nodes.output.wireframe import Trail
from rrr_traj_planner.nodes.point_files.reading import read_task
from rrr_traj_planner.nodes.studio.execution.commands import Commands, NO_PLAN
from rrr_traj_planner.nodes.studio.planned import Planned
from rrr_traj_planner.nodes.studio.sent_goal import SentGoal
from rrr_traj_planner.nodes.studio.session import Session
from rrr_traj_planner.nodes.studio.wanted import wanted_of
from rrr_traj_planner_interfaces.action import MoveThrough
from std_srvs.srv import Trigger

MODEL = RobotModel()
WANTED = wanted_of(read_task('table_6_1.yaml'), MODEL, 'base_link', 'cycloid')
START = np.array([0.5, 1.0, 0.2])
PLAN = Planned('cycloid', 1.0, 0.0, '', np.zeros((2, 3)), np.zeros(1), np.arange(2.0),
               np.zeros((2, 3)), np.tile(START, (3, 1)), ())


class Arm:
    """An arm whose answers come when the test wants; keeps what is shown."""

    controller, replanning_lead, gone = '', 0.25, ''

    def __init__(self):
        self.text, self.answers, self.ends, self.session = '', {}, [], Session(WANTED, id)
        self.session.take(WANTED, PLAN)
        self.commands = Commands(self, MODEL, self.session, self, Trail(0.01, 10))

    def joints(self, names, field='position'):
        return START if field == 'position' else np.zeros(3)

    def move(self, goal, progress, ended):
        self.ends.append(ended)
        return SentGoal()

    def trigger(self, name, answered):
        self.answers[name] = answered

    def show_status(self, text, share):
        self.text = text

    def answer(self, name):
        self.answers[name](Trigger.Response(success=True, message=f'{name} is done'))

    def end(self, code):
        self.ends[-1](MoveThrough.Result(error_code=code, message='canceled'))


@pytest.fixture
def arm():
    """Give a test an arm that moves."""
    arm = Arm()
    arm.commands.run()
    return arm


@pytest.mark.parametrize('name', ['hold', 'reset'])
@pytest.mark.parametrize('code', [
    MoveThrough.Result.PREEMPTED, MoveThrough.Result.CONTROL_FAILED, MoveThrough.Result.SUCCESS])
def test_answer_is_told_whichever_way_the_motion_ends_before_it_or_after(arm, name, code):
    getattr(arm.commands, name)()
    arm.answer(name)
    arm.end(code)
    assert f'{name} is done' in arm.text
    arm.commands.run()
    getattr(arm.commands, name)()
    arm.end(code)
    arm.answer(name)
    assert f'{name} is done' in arm.text


@pytest.mark.parametrize(('name', 'other'), [('hold', 'reset'), ('reset', 'hold')])
def test_late_answer_is_not_told_after_another_command(arm, name, other):
    getattr(arm.commands, name)()
    getattr(arm.commands, other)()
    arm.answer(other)
    arm.answer(name)
    assert f'{other} is done' in arm.text
    arm.commands.run()
    before = arm.text
    arm.answer(other)
    assert arm.text == before


def test_run_without_a_plan_is_told_after_hold_too(arm):
    arm.commands.hold()
    arm.session.change(WANTED.moved(0, (0.1, 0.1, 0.1)))
    arm.commands.run()
    arm.answer('hold')
    assert NO_PLAN in arm.text


def test_run_without_a_controller_is_refused_at_once(arm):
    arm.end(MoveThrough.Result.SUCCESS)
    arm.gone = 'the controller'
    arm.commands.run()
    assert 'nothing is sent: the controller is not there' in arm.text and len(arm.ends) == 1
    arm.gone = ''
    arm.commands.run()
    assert len(arm.ends) == 2


def test_run_after_hold_is_sent_though_the_goal_before_has_no_answer_yet(arm):
    arm.commands.hold()
    arm.commands.run()
    before = arm.text
    assert len(arm.ends) == 2
    arm.answer('hold')
    arm.ends[0](MoveThrough.Result(error_code=MoveThrough.Result.PREEMPTED, message='canceled'))
    assert arm.text == before
    arm.end(MoveThrough.Result.SUCCESS)
    assert 'reached' in arm.text
