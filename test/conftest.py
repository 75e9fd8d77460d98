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

"""What every test needs before ROS is imported."""

import os

from rrr_traj_planner.nodes.node_claim import claim

# Stay on this machine, and refuse values that rclpy would otherwise garble without a word.
os.environ['ROS_AUTOMATIC_DISCOVERY_RANGE'] = 'LOCALHOST'
os.environ['ROS_PYTHON_CHECK_FIELDS'] = '1'

# A domain for each test process, among those that leave its ports free, and which no other test
# process of this machine has claimed: the claim lasts as long as the process.
DOMAINS = [1 + (os.getpid() + i) % 101 for i in range(101)]
DOMAIN, CLAIM = next((domain, held) for domain in DOMAINS if (held := claim(domain, ' tests')))
os.environ['ROS_DOMAIN_ID'] = str(DOMAIN)
