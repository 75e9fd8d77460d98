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

"""The script `planner` as a process: bugs, signals, clients that leave, parameter files."""

from __future__ import annotations

import signal

from helpers.places import CONFIG
from helpers.plan_answers import assert_good
from helpers.plan_requests import assert_refused, plan_request, TABLE_6_3
from helpers.scripts import python, Script, script
import pytest
from rcl_interfaces.srv import GetParameters
from rrr_traj_planner_interfaces.srv import PlanTrajectory

CODES = PlanTrajectory.Response

# A planner that fails, and one that never ends and says that it has begun.
BUGS = """
import sys, threading
from rrr_traj_planner.planners.registration import register
@register('broken')
def broken(task): raise RuntimeError('no idea')
@register('endless')
def endless(task): print('begun', flush=True); threading.Event().wait()
from rrr_traj_planner.nodes.scripts.planner import main
sys.exit(main())
"""


def test_bug_in_a_planner_is_reported_and_survived(module_ros):
    with Script(python(BUGS), '--ros-args', '-r', '__ns:=/bugs') as planner:
        def ask(request):
            return module_ros.call(PlanTrajectory, 'bugs/plan_trajectory', request)

        assert_refused(ask, plan_request(planner_id='broken'), CODES.FAILURE,
                       'internal error, RuntimeError: no idea')
        planner.process.send_signal(signal.SIGINT)
        code, _, errors = planner.ended()
    assert code == 0
    assert 'in broken\n' in errors  # the trace
    assert 'RuntimeError: no idea' in errors


def test_signal_ends_a_node_that_plans(module_ros):
    with Script(python(BUGS), '--ros-args', '-r', '__ns:=/endless',
                '--log-level', 'warn') as planner:
        client = module_ros.node.create_client(PlanTrajectory, 'endless/plan_trajectory')
        assert client.wait_for_service(20.0)
        client.call_async(plan_request(planner_id='endless'))
        planner.read_until('begun')
        planner.process.send_signal(signal.SIGTERM)
        assert planner.ended() == (0, '', '')


def test_client_that_leaves_does_no_harm(module_ros, ask):
    client = module_ros.node.create_client(PlanTrajectory, 'plan_trajectory')
    assert client.wait_for_service(20.0)
    client.call_async(plan_request())
    module_ros.node.destroy_client(client)
    assert_good(ask(plan_request()))


@pytest.mark.parametrize(('yaml', 'texts'), [
    ('default_planner_id: magic',
     ('default_planner_id', "'magic'", 'cycloid, cycloid_approach_a')),
    ('max_deviation: 1', ('parameter max_deviation is 1, must be in [1e-06, 100] m (written',))])
def test_wrong_file_stops_the_planner_with_one_line(tmp_path, yaml, texts):
    file = tmp_path / 'arm.yaml'
    file.write_text(f'/**:\n  ros__parameters: {{{yaml}}}\n')
    with Script(script('planner'), '--ros-args', '--params-file', file) as planner:
        code, _, errors = planner.ended()
    assert code == 1
    assert errors.startswith('planner: ')
    assert errors.count('\n') == 1
    for text in texts:
        assert text in errors


def test_stronger_arm_s_file_lets_table_6_3_be_planned(module_ros):
    file = CONFIG / 'thesis_arm_joint_2_250.yaml'
    with Script(script('planner'), '--ros-args', '-r', '__ns:=/strong', '--params-file', file):
        response = module_ros.call(
            PlanTrajectory, 'strong/plan_trajectory', plan_request(TABLE_6_3))
        values = module_ros.call(
            GetParameters, 'strong/trajectory_planner/get_parameters',
            GetParameters.Request(names=['joint_limits.joint_2.max_effort'])).values
    assert response.error_code == CODES.SUCCESS, response.message
    assert response.via_times[-1] == pytest.approx(3.490, abs=5e-3)  # the reference solution's
    assert 218.9 < response.peak_effort[1] <= 250.0
    assert values[0].double_value == 250.0


def test_help_needs_no_ros():
    with Script(script('planner'), '--help') as planner:
        code, output, errors = planner.ended()
    assert (code, errors) == (0, '')
    for text in ('plan_trajectory', 'planned_path', '--ros-args'):
        assert text in output
