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

"""The README's client, run unchanged."""

from __future__ import annotations

import re

from helpers.places import ROOT
from helpers.scripts import python, Script, script
from sensor_msgs.msg import JointState

README = ROOT / 'README.md'


def test_client_s_trajectory_reaches_an_arm_that_is_found_late(ros):
    blocks = re.findall(r'^```python\n(.*?)^```', README.read_text(), re.DOTALL | re.MULTILINE)
    code, = (block for block in blocks if 'create_client' in block)
    states = ros.listen(JointState, 'joint_states')
    with Script(script('planner')) as planner, Script(python(code)) as client:
        planner.read_errors_until('cycloid planned 3 via points in ')
        with Script(script('simulated_arm')) as arm:
            arm.read_errors_until('following ')
            states.wait_for_next(lambda m: max(map(abs, m.velocity)) > 0.1)
            assert client.ended() == (0, '', '')
