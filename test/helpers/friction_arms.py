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

"""Arms with friction: motions' torques by Pinocchio, and friction added by its definition."""

from __future__ import annotations

from dataclasses import replace

from helpers.random_chains import PinocchioChain
import numpy as np
from rrr_traj_planner.core.arm.friction import Friction


def with_friction(arm, seed, viscous=4.0, coulomb=6.0):
    """Return an arm with random friction of every joint, up to the given values."""
    rng = np.random.default_rng(seed)
    return replace(arm, friction=Friction(rng.uniform(0.2, 1.0, 3) * viscous,
                                          rng.uniform(0.2, 1.0, 3) * coulomb))


def torques(arm, q, qd, qdd):
    """Return torques by Pinocchio, (n, 3), and friction opposed to each joint's motion."""
    chain = PinocchioChain(arm)
    rigid = np.array([chain.inverse_dynamics(*state) for state in zip(q, qd, qdd)])
    friction = arm.friction
    moves = np.abs(qd) > 1e-12 * np.abs(qd).max()
    return rigid + friction.viscous * qd + friction.coulomb * np.sign(qd) * moves
