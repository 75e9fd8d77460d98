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

"""The example of teleoperation in docs/arm.md, run as it stands."""

from __future__ import annotations

import re
import subprocess
import sys

from helpers.arm_in_ros import Arm, SECOND, stamp, START
from helpers.places import DOCS
import numpy as np

DOCUMENT = DOCS / 'arm.md'
SWING, W, SECONDS = 0.03, np.pi, 2.0  # one swing, shorter than in the document
DEADLINE = 20.0

# A machine that does not keep up makes the arm brake now and then; most of the time it follows.
USUAL_ERROR = 1e-4  # rad


def test_arm_follows_a_stream_of_stamped_points(ros):
    code, = re.findall(r'^```python\n(.*?)^```', DOCUMENT.read_text(), re.DOTALL | re.MULTILINE)
    for there, here in (('0.1, 8.0  #', f'0.1, {SECONDS}  #'),
                        ('SWING, W = 0.1, tau / 4.0', f'SWING, W = {SWING}, {W}')):
        assert code.count(there) == 1
        code = code.replace(there, here)
    arm = Arm(ros, allow_nonzero_velocity_at_trajectory_end=True)
    output = subprocess.run([sys.executable, '-c', code], text=True, capture_output=True,
                            timeout=DEADLINE, check=True).stdout
    start = int(output)
    arm.actual.wait_for(lambda m: stamp(m) > start + 2.2 * SECOND)
    times, q = [], []
    for message in arm.actual.messages:
        if start + SECOND // 5 < stamp(message) < start + SECONDS * SECOND:
            times.append((stamp(message) - start) / SECOND)
            q.append(message.position)
    expected = START + SWING * (1.0 - np.cos(W * np.array(times)))[:, np.newaxis]
    errors = np.abs(np.array(q) - expected).max(axis=1)
    assert len(errors) > 100
    print(f'error: median {np.median(errors):.2e}, largest {errors.max():.2e} rad')
    assert np.median(errors) < USUAL_ERROR
    assert (np.ptp(q, axis=0) > 1.9 * SWING).all()
