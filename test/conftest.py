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

"""What every test needs before the package and ROS are imported."""

import gc
import os
from pathlib import Path
import signal
import sys

import pytest

# Stay on this machine, and refuse values that rclpy would otherwise garble without a word.
os.environ['ROS_AUTOMATIC_DISCOVERY_RANGE'] = 'LOCALHOST'
os.environ['ROS_PYTHON_CHECK_FIELDS'] = '1'

# As in every script: threads for matrices as small as these only wait for one another. For NumPy,
# which nothing may have imported before.
os.environ.setdefault('OPENBLAS_NUM_THREADS', '1')

# A shell ignores SIGINT for what it runs in the background, and so would the scripts under test.
signal.signal(signal.SIGINT, signal.default_int_handler)

# What is installed is what is tested, not the source tree, which Python's start puts on the path
# and which may lack what is built.
ROOT = Path(__file__).resolve().parents[1]
sys.path[:] = [entry for entry in sys.path if Path(entry or '.').resolve() != ROOT]

NOT_BUILT = (
    '{error}. Tests run on what is built: `make test` builds first; in a colcon workspace call '
    '`colcon build` and `source install/setup.bash`')


def pytest_configure(config):
    """Claim a ROS domain; end where what is to be tested is not there."""
    gc.disable()  # until all tests are collected: nothing of that is garbage, and it takes half
    try:
        from rrr_traj_planner.nodes.process.node_claim import claim
        from rrr_traj_planner.planners.registry import planner_ids
        planner_ids()  # loads them all, compiled code included
    except ImportError as error:
        raise pytest.UsageError(NOT_BUILT.format(error=error)) from None

    # A domain for each test process, among those that leave its ports free, and which no other
    # test process of this machine has claimed: the claim lasts as long as the process.
    domains = (1 + (os.getpid() + i) % 101 for i in range(101))
    os.environ['ROS_DOMAIN_ID'], config.claim = next(
        (str(domain), held) for domain in domains if (held := claim(domain, ' tests')))


def pytest_collection_finish():
    """Collect garbage from here on, of what the tests make."""
    gc.freeze()
    gc.enable()


def pytest_report_header():
    """Say what is tested."""
    import rrr_traj_planner
    return f'rrr_traj_planner: {Path(rrr_traj_planner.__file__).parent}'
