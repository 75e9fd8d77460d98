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

"""Positions of the links' ends, against the kinematics of links."""

from __future__ import annotations

from helpers.random_cases import ARMS, random_states
import numpy as np
import pytest
from rrr_traj_planner.core.kinematics.link_motion import link_motion
from rrr_traj_planner.core.kinematics.link_positions import link_positions

ROUNDING = 1e-12  # m


@pytest.mark.parametrize('arm', ARMS)
def test_link_positions_are_the_origins_of_the_frames(arm):
    q, qd, qdd = random_states(np.random.default_rng(1), 50)
    frames = link_motion(arm, q, qd, qdd).frame.position
    for one, origins in zip(q.tolist(), frames):
        base, *joints = link_positions(arm, one)
        assert base == (0.0, 0.0, 0.0)
        np.testing.assert_allclose(joints, origins, rtol=0.0, atol=ROUNDING)
